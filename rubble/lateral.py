"""Lateral motion of blocks, along y: they clear sideways around the structure.

The structure presses a block laterally with ``N n_y`` and resists with friction against the direction of slip, see
`friction`; ice around it resists likewise with its own normal forces, and water drags on the side face.

A section's cut of the structure does not recede when a block moves along y, as the true face would. Seen in the plane
the face recedes by ``v_y n_y / n_p``, and the block stays in touch only as long as the ice behind feeds it that fast.
So the push ends at ``v_y = V n_p / n_y`` with V the speed of the feed: beyond, the block has left the structure.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, Records, record
from rubble.block import Block
from rubble.bodies import Outlines
from rubble.compiled import compiled
from rubble.domain import Domain
from rubble.geometry import area_moments, place, submerged
from rubble.physics import RATE_DEPENDENT, RubblePhysics

#: energy since the start [J]: done by the structure's lateral push, which a section takes from nowhere; lost to
#: friction on the structure and on ice; lost to drag
LATERAL_WORK = record("pushed", "rubbed_structure", "rubbed_ice", "dragged")
#: Coefficient of rate-dependent friction along y. The sums of a window hold the normal impulses on other ice, not the
#: slip of each contact; blocks that clear move at centimetres per second and more, the upper end of the law, where it
#: says 0.1 (`friction.rate_dependent`).
MU_SLIDING = 0.1


class Resistance(NamedTuple):
    """What holds lateral motion back, in a window."""

    dt: float  #: length of the window [s]
    mu_ice: float  #: on other ice
    half_rho_cd: float  #: rho_w C_d / 2 [kg/m^3]
    feed: float  #: V above [m/s]
    current: float = 0.0  #: velocity of the water along y [m/s]


def resistance_of(physics: RubblePhysics, window: float) -> Resistance:
    """Of a scenario in a window [s]."""
    mu = MU_SLIDING if physics.mu_ice_ice == RATE_DEPENDENT else float(physics.mu_ice_ice)
    return Resistance(
        window, mu, physics.rho_w / 2 * physics.form_drag, float(physics.feed_speed), float(physics.current[1])
    )


@compiled(nogil=True)
def move_laterally(
    by: Resistance,
    outlines: Outlines,
    mass: Array,
    state: Records,
    impulses: Records,
    lateral: Records,
    load: Records,
    work: Records,
) -> None:
    """Move the blocks of a section along y by one window; ``load`` (n,) becomes the mean force on the structure [N].

    ``impulses`` (n,) are those of the window, ON_BLOCK; ``lateral`` (n,) is changed; ``mass`` (n,) with added mass;
    ``work`` (1,) LATERAL_WORK. Backward Euler for friction and drag, so neither turns the motion around.
    """
    dt, corners, offset, sums = by.dt, outlines.corners, outlines.offset, work[0]
    for i in range(mass.shape[0]):
        j, row, own, force, m = impulses[i], state[i], lateral[i], load[i], mass[i]
        force.x, force.y, force.z = j.structure_x / dt, -j.lateral / dt, j.structure_z / dt
        free = own.v_y + j.lateral / m
        if free == 0.0 and by.current == 0.0:
            continue
        on_face = free * j.grip_slip / j.grip if j.grip > 0.0 else free  # slip v_y / p on the structure
        slip = np.hypot(row.v_x, row.v_z)
        grip, rub = 0.0, 0.0
        if free != 0.0:
            grip, rub = j.grip / np.hypot(on_face, slip), by.mu_ice * j.ice / np.hypot(free, slip)
        v = free * max(0.0, 1.0 - (grip + rub) / m)
        sums.pushed += 0.5 * m * (free * free - own.v_y**2)
        if grip + rub > 0.0:
            sums.rubbed_structure += 0.5 * m * (free * free - v * v) * grip / (grip + rub)
            sums.rubbed_ice += 0.5 * m * (free * free - v * v) * rub / (grip + rub)
            force.y += m * (free - v) / dt * grip / (grip + rub)
        most = by.feed * np.hypot(j.structure_x, j.structure_z) / abs(j.lateral) if j.lateral != 0.0 else np.inf
        if v * j.lateral > 0.0 and abs(v) > max(most, abs(own.v_y)):
            slower = np.sign(v) * max(most, own.v_y * np.sign(v))
            sums.pushed -= 0.5 * m * (v * v - slower * slower)
            force.y += m * (v - slower) / dt
            v = slower
        outline = place(corners[offset[i] : offset[i + 1]], row.x, row.z, row.angle, 0, 0)
        wet = area_moments(submerged(outline)).area
        through = v - by.current
        own.v_y = by.current + through / (1.0 + dt * by.half_rho_cd * wet * abs(through) / m)
        own.y += dt * own.v_y
        sums.dragged += 0.5 * m * (v * v - own.v_y**2)


@compiled(nogil=True)
def all_inside(state: Records, lateral: Records, y: float, half: float, domain: Domain) -> bool:
    """Whether all blocks are within the section's half width about y and within the domain."""
    for i in range(state.shape[0]):
        x, z, at = state[i].x, state[i].z, lateral[i].y
        held = domain.x_min <= x <= domain.x_max and abs(at) <= domain.y_max and z >= -domain.depth
        if not (held and abs(at - y) <= half):
            return False
    return True


def collide(block: Block, neighbour: Block | None) -> float:
    """Plastic impact along y: both blocks go on with their common speed; without a neighbour the block stops.

    Lateral momentum is kept between blocks; sheet and structure take it up. Returns the energy that is lost [J].
    """
    m = float(block.body.mass)
    if neighbour is None:
        lost, block.v_y = 0.5 * m * block.v_y**2, 0.0
        return lost
    n, apart = float(neighbour.body.mass), block.v_y - neighbour.v_y
    if (block.y - neighbour.y) * apart >= 0.0:  # they do not approach each other
        return 0.0
    block.v_y = neighbour.v_y = (m * block.v_y + n * neighbour.v_y) / (m + n)
    return 0.5 * m * n / (m + n) * apart**2
