"""Motion of blocks across the sections: they clear sideways around the structure.

The structure presses a block across with ``N n_y`` and resists with friction against the direction of slip, see
`friction`; ice around it resists likewise with its own normal forces, and water drags on the side face.

A section's cut of the structure does not recede when a block moves across, as the true face would. Seen in the plane
the face recedes by ``v_y n_y / n_p``, and the block stays in touch only as long as the ice behind feeds it that fast.
So the push ends at ``v_y = V n_p / n_y`` with V the speed of the feed: beyond, the block has left the structure.
"""

from __future__ import annotations

import numpy as np

from rubble.block import Block
from rubble.compiled import compiled
from rubble.geometry import Array, IntArray, moments, place, submerged

#: sums of `side_steps` [J]: done by the structure's side push, which a section takes from nowhere; lost to friction on
#: the structure and on ice; lost to drag
PUSHED, RUBBED, DRAGGED, ACROSS = 0, 1, 3, 4


@compiled(
    "void(float64, float64, float64, float64, float64[:, ::1], int64[::1], float64[::1], float64[:, ::1], "
    "float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[::1])",
    nogil=True,
)
def side_steps(
    dt: float,
    mu_ice: float,
    half_rho_cd: float,
    feed: float,
    polygons: Array,
    offset: IntArray,
    mass: Array,
    state: Array,
    sums: Array,
    side: Array,
    load: Array,
    work: Array,
) -> None:
    """Move the blocks of a section across by one window; ``load`` (n, 3) becomes the mean force on the structure [N].

    ``sums`` as in `contacts`; ``side`` (2, n): y and v_y, changed here; ``mass`` with added mass; ``half_rho_cd`` =
    rho_w C_d / 2; ``feed`` V above [m/s]; ``work`` see ACROSS. Backward Euler for friction and drag, so neither turns
    the motion around.
    """
    for i in range(mass.shape[0]):
        load[i, 0], load[i, 1], load[i, 2] = sums[i, 0] / dt, -sums[i, 2] / dt, sums[i, 1] / dt
        free = side[1, i] + sums[i, 2] / mass[i]
        if free == 0.0:
            continue
        across = free * sums[i, 4] / sums[i, 3] if sums[i, 3] > 0.0 else free  # slip v_y / p on the structure
        slip = np.hypot(state[i, 3], state[i, 4])
        grip, rub = sums[i, 3] / np.hypot(across, slip), mu_ice * sums[i, 5] / np.hypot(free, slip)
        v = free * max(0.0, 1.0 - (grip + rub) / mass[i])
        work[PUSHED] += 0.5 * mass[i] * (free * free - side[1, i] ** 2)
        if grip + rub > 0.0:
            work[RUBBED] += 0.5 * mass[i] * (free * free - v * v) * grip / (grip + rub)
            work[RUBBED + 1] += 0.5 * mass[i] * (free * free - v * v) * rub / (grip + rub)
            load[i, 1] += mass[i] * (free - v) / dt * grip / (grip + rub)
        most = feed * np.hypot(sums[i, 0], sums[i, 1]) / abs(sums[i, 2]) if sums[i, 2] != 0.0 else np.inf
        if v * sums[i, 2] > 0.0 and abs(v) > max(most, abs(side[1, i])):
            slower = np.sign(v) * max(most, side[1, i] * np.sign(v))
            work[PUSHED] -= 0.5 * mass[i] * (v * v - slower * slower)
            load[i, 1] += mass[i] * (v - slower) / dt
            v = slower
        wet = moments(
            submerged(place(polygons[offset[i] : offset[i + 1]], state[i, 0], state[i, 1], state[i, 2], 0, 0))
        )
        side[1, i] = v / (1.0 + dt * half_rho_cd * wet[0] * abs(v) / mass[i])
        side[0, i] += dt * side[1, i]
        work[DRAGGED] += 0.5 * mass[i] * (v * v - side[1, i] ** 2)


@compiled(
    "bool_(float64[:, ::1], float64[:, ::1], float64, float64, float64, float64, float64, float64)",
    nogil=True,
)
def all_inside(
    state: Array, side: Array, y: float, half: float, x_min: float, x_max: float, y_max: float, depth: float
) -> bool:
    """Whether all blocks are within the section's half width about y and within the domain (`layer.Domain`)."""
    inside = True
    for i in range(state.shape[0]):
        x, z, at = state[i, 0], state[i, 1], side[0, i]
        inside = inside and x_min <= x <= x_max and abs(at) <= y_max and z >= -depth and abs(at - y) <= half
    return inside


def push(block: Block, neighbour: Block | None) -> float:
    """Plastic impact across: both blocks go on with their common speed; without a neighbour the block stops.

    Momentum across is kept between blocks; sheet and structure take it up. Returns the energy that is lost [J].
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
