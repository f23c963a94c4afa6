"""Crushing: no contact carries more than the ice's strength times its area.

The solver's contacts are rigid and have two points at most. A pair whose mean normal force over a window needs more
area than it has loses ice from its sharper block: the block is cut back square to the force until the section is wide
enough for it, ``chord(depth) w = F / strength``. It recedes no faster than the excess force (over strength times the
area that is there) moves the block in a window: a gap opened at once would let it run up. Contacts that lack less
than the solver's own tolerance (slop) are left. What is cut off has left the block with its momentum; nothing of the
force is capped.
"""

from __future__ import annotations

import numpy as np

from rubble.arrays import Array
from rubble.block import Block, cut_block, energy_of
from rubble.compiled import compiled
from rubble.lost import Lost
from rubble.section import Section

FROM_REST = 0.5  #: distance over speed times time, of a body that is moved from rest by a constant force


def crush(section: Section, window: float) -> Lost:
    """Cut the overloaded blocks of a section after a window [s]; returns what they have lost."""
    physics, lost = section.physics, Lost()
    for row in section.overloads:
        push = float(row["push"])
        needed = push / window / physics.contact_strength  # contact area [m2]
        direction = np.array([row["push_x"], row["push_z"]])
        along = float(np.hypot(*direction))
        if along == 0.0:
            continue  # pressed from opposite sides alike: no side to cut back
        slots = ((int(row["a"]), 1.0), (int(row["b"]), -1.0))
        ends = [(section.blocks[slot], sign * direction / along) for slot, sign in slots if slot >= 0]
        lacking, depth, block, normal = max(
            ((*depth_for(b, n, needed, push, window), b, n) for b, n in ends), key=lambda found: found[0]
        )
        if lacking > physics.slop:
            velocity, had = block.velocity, sum(energy_of(block, physics))
            mass = _cut(block, normal, depth)
            lost.take(mass, mass * velocity, had - sum(energy_of(block, physics)))
    if lost.mass > 0.0:
        section.changed()
    return lost


@compiled("float64(float64[:, ::1], float64, float64, float64)", nogil=True)
def _chord(polygon: Array, nx: float, nz: float, at: float) -> float:
    """Length of a convex polygon's cut by the line ``n . x = at``; along an edge its length."""
    low, high, k = np.inf, -np.inf, polygon.shape[0]
    eps = 1e-9 * (abs(at) + 1.0)
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        di = polygon[i, 0] * nx + polygon[i, 1] * nz - at
        dj = polygon[j, 0] * nx + polygon[j, 1] * nz - at
        ti, tj = polygon[i, 1] * nx - polygon[i, 0] * nz, polygon[j, 1] * nx - polygon[j, 0] * nz
        if abs(di) <= eps:
            low, high = min(low, ti), max(high, ti)
        elif abs(dj) > eps and di * dj < 0.0:
            t = ti + di / (di - dj) * (tj - ti)
            low, high = min(low, t), max(high, t)
    return max(high - low, 0.0)


def depth_for(block: Block, normal: Array, needed: float, impulse: float, window: float) -> tuple[float, float]:
    """How far a block must be cut back, and how far it recedes in this window [m].

    Cut along the outward ``normal`` (2,) for a contact of ``needed`` area [m2] under an ``impulse`` [N s]. The first is
    infinite if no section of the block is wide enough.
    """
    c, s = np.cos(block.body.angle), np.sin(block.body.angle)
    nx, nz = float(c * normal[0] + s * normal[1]), float(-s * normal[0] + c * normal[1])
    chord = needed / block.prism.width
    lacking, there = _cut_depth(block.prism.polygon, nx, nz, chord)
    pace = FROM_REST * impulse * (1.0 - min(there / chord, 1.0)) / block.body.mass * window
    return lacking, min(lacking, float(pace))


@compiled("UniTuple(float64, 2)(float64[:, ::1], float64, float64, float64)", nogil=True)
def _cut_depth(polygon: Array, nx: float, nz: float, chord: float) -> tuple[float, float]:
    """Depth below the farthest corner along n at which a convex polygon is ``chord`` wide, and its width there.

    That is: at the corner. The depth is infinite if the polygon is nowhere so wide.
    """
    reach = np.sort(polygon[:, 0] * nx + polygon[:, 1] * nz)[::-1]
    there = _chord(polygon, nx, nz, reach[0])
    near, narrow = reach[0], there
    for far in reach[1:]:
        if narrow >= chord:
            break
        wide = _chord(polygon, nx, nz, far)
        if wide < narrow:
            return np.inf, there  # past the widest place
        if wide >= chord:  # the chord is linear between corners
            return reach[0] - near + (chord - narrow) / (wide - narrow) * (near - far), there
        near, narrow = far, wide
    return (reach[0] - near if narrow >= chord else np.inf), there


def _cut(block: Block, normal: Array, depth: float) -> float:
    c, s = np.cos(block.body.angle), np.sin(block.body.angle)
    nx, nz = c * normal[0] + s * normal[1], -s * normal[0] + c * normal[1]
    reach = float((block.prism.polygon @ np.array([nx, nz])).max())
    return cut_block(block, float(nx), float(nz), reach - depth)
