"""Sides: plates in neighbouring sections meet across them.

A section sees what its plane cuts. Two plates that stand side by side, one cut by this plane and the other by the next,
meet with their sides: where their slices overlap, seen along y, the one must end before the other begins. The place of
a side follows from the plate as it is turned; the contact acts in the middle of the common part of the two slices.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Record
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.plates import times
from rubble.rows import ICE, Rows, set_arms, set_way

SIDE = -1  #: marks a row of two sides
LEAST = 1e-3  #: common part of two slices below which they pass each other, over the pitch squared


class Sides(NamedTuple):
    """Pairs of slices in neighbouring sections that may meet in this window."""

    pair: IntArray  #: (k, 2) slices, the first in the section with the smaller number
    at: Array  #: (k, 3) middle of their common part, x, z [m], and its area [m2]
    gap: Array  #: (k,) from the side of the first to that of the second along y at the start [m]
    normal: Array  #: (k, 3) from the first to the second
    arm: Array  #: (k, 2, 3) the point in the axes of the plates, from their centres [m]


def no_sides() -> Sides:
    """None."""
    return Sides(np.zeros((0, 2), np.int64), np.zeros((0, 3)), np.zeros(0), np.zeros((0, 3)), np.zeros((0, 2, 3)))


@compiled(nogil=True)
def side_rows(scene: Scene, sides: Sides, rows: Rows, old: Rows, found: int, before: int) -> int:
    """Adds a row for each pair of sides that overlap; returns the number of rows, -1 if there is no room.

    ``old`` has ``before`` rows; those of sides stand behind those of the sections, in the order of the pairs.
    """
    plates, last = scene.plates, 0
    while last < before and old.point[last].feature != SIDE:
        last += 1
    c = found
    for k in range(sides.pair.shape[0]):
        a, b = sides.pair[k, 0], sides.pair[k, 1]
        i, j = scene.slices.plate[a], scene.slices.plate[b]
        ax, ay, az = times(plates.rotation[i], sides.arm[k, 0, 0], sides.arm[k, 0, 1], sides.arm[k, 0, 2])
        bx, by, bz = times(plates.rotation[j], sides.arm[k, 1, 0], sides.arm[k, 1, 1], sides.arm[k, 1, 2])
        x, y, z = plates.position[i, 0] + ax, plates.position[i, 1] + ay, plates.position[i, 2] + az
        u, v, w = plates.position[j, 0] + bx, plates.position[j, 1] + by, plates.position[j, 2] + bz
        n = sides.normal[k]
        depth = (x - u) * n[0] + (y - v) * n[1] + (z - w) * n[2]
        if depth <= 0.0:
            continue
        if c >= rows.point.shape[0]:
            return -1
        point = rows.point[c]
        point.a, point.b, point.edge, point.kind = i, j, -1, ICE
        point.slot_a, point.slot_b, point.feature = a, b, SIDE
        point.x, point.y, point.z = 0.5 * (x + u), 0.5 * (y + v), 0.5 * (z + w)
        point.depth, point.most = depth, scene.strength * sides.at[k, 2]
        _directions(rows, c, n)
        set_arms(rows, c, plates, scene.edges)
        while last < before and _earlier(old.point[last], a, b):
            last += 1
        same = last < before and old.point[last].feature == SIDE
        same = same and old.point[last].slot_a == a and old.point[last].slot_b == b
        for d in range(3):
            rows.way[c, d].impulse = old.way[last, d].impulse if same else 0.0
        c += 1
    return c


@compiled(nogil=True)
def _earlier(p: Record, a: int, b: int) -> bool:
    earlier: bool = p.feature == SIDE and (p.slot_a < a or (p.slot_a == a and p.slot_b < b))
    return earlier


@compiled(nogil=True)
def _directions(rows: Rows, c: int, n: Array) -> None:
    """n, and two directions across it: the first lies flat."""
    length = np.sqrt(n[1] * n[1] + n[0] * n[0])
    tx, ty = n[1] / length, -n[0] / length
    set_way(rows.way[c, 0], n[0], n[1], n[2])
    set_way(rows.way[c, 1], tx, ty, 0.0)
    set_way(rows.way[c, 2], -n[2] * ty, n[2] * tx, n[0] * ty - n[1] * tx)
