"""Sides: plates in neighbouring sections meet across them.

A section sees what its plane cuts. Two plates of which one is cut by this plane and the other by the next meet between
the planes, if they overlap along y and as seen along y. They meet where the overlap is least: with their sides, the
normal that of the side, or with their fronts, the normal in the plane. The place of a side follows from the plate as
it is turned; the contact acts in the middle of the common part of the two slices. Within a window its two points move
with their plates.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Record
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.geometry import AreaMoments, area_moments, intersection
from rubble.outlines import apart, box_of, boxes_apart, put_outline
from rubble.plates import times, turn_back
from rubble.rows import ICE, Rows, go_on, set_way
from rubble.slices import CORNERS, Pieces, end_along_y

SIDE = -1  #: marks a row of two sides
NEAR = 0.1  #: gap that may close in a window, over the pitch


class Sides(NamedTuple):
    """Pairs of slices in neighbouring sections that may meet in this window."""

    pair: IntArray  #: (k, 2) slices, the first in the section with the smaller number; ascending
    normal: Array  #: (k, 3) from the first to the second
    arm: Array  #: (k, 2, 3) the point, on the first and on the second, in the axes of the plates [m]
    area: Array  #: (k,) of the contact [m2]


def side_room(count: int) -> Sides:
    """Room for so many pairs."""
    return Sides(np.zeros((count, 2), np.int64), np.zeros((count, 3)), np.zeros((count, 2, 3)), np.zeros(count))


@compiled(nogil=True, borrows=True)
def side_rows(scene: Scene, sides: Sides, rows: Rows, old: Rows, found: int, before: int, cut: bool) -> int:
    """Adds a row for each pair of sides that overlap; returns the number of rows, -1 if there is no room.

    ``old`` has ``before`` rows; those of sides stand behind those of the sections, in the order of the pairs.
    ``cut``: slices are new.
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
        point.depth, point.most = depth, scene.strength * sides.area[k]
        directions(rows, c, n)
        while last < before and _earlier(old.point[last], a, b):
            last += 1
        same = last < before and old.point[last].feature == SIDE
        same = same and old.point[last].slot_a == a and old.point[last].slot_b == b
        go_on(rows, c, old, last if same else -1, 0.0, cut)
        c += 1
    return c


@compiled(nogil=True, borrows=True)
def _earlier(p: Record, a: int, b: int) -> bool:
    earlier: bool = p.feature == SIDE and (p.slot_a < a or (p.slot_a == a and p.slot_b < b))
    return earlier


@compiled(nogil=True, borrows=True)
def directions(rows: Rows, c: int, n: Array) -> None:
    """n, and two directions across it: the first lies flat where n leads out of the plane, else in the plane."""
    tx, ty, tz = (n[1], -n[0], 0.0) if abs(n[1]) > 0.5 else (-n[2], 0.0, n[0])
    length = np.sqrt(tx * tx + ty * ty + tz * tz)
    tx, ty, tz = tx / length, ty / length, tz / length
    set_way(rows.way[c, 0], n[0], n[1], n[2])
    set_way(rows.way[c, 1], tx, ty, tz)
    set_way(rows.way[c, 2], n[1] * tz - n[2] * ty, n[2] * tx - n[0] * tz, n[0] * ty - n[1] * tx)


@compiled(nogil=True)
def find_sides(scene: Scene, pieces: Pieces, first: IntArray, order: IntArray, sides: Sides) -> int:
    """Pairs of slices that may meet between two sections; returns how many, more than there is room for if so.

    ``order`` lists the slices section by section, ascending, from ``first[i]`` to ``first[i + 1]`` for section i.
    """
    n = scene.slices.piece.shape[0]
    return int(_pairs(scene, pieces, (first, order), (np.empty((n, CORNERS, 2)), np.empty((n, 4))), sides))


@compiled(nogil=True, borrows=True)
def _pairs(
    scene: Scene, pieces: Pieces, listed: tuple[IntArray, IntArray], room: tuple[Array, Array], sides: Sides
) -> int:
    """The same, with room for the outlines of the slices and the boxes round them."""
    (first, order), (outlines, boxes) = listed, room
    slices, near, found = scene.slices, NEAR * scene.pitch, 0
    for s in range(slices.piece.shape[0]):
        put_outline(scene, s, outlines[s])
        box_of(outlines[s], slices.sides[s], boxes[s])
    for a in range(slices.piece.shape[0]):
        i = slices.section[a] + 1
        if i + 1 >= first.shape[0] or scene.sections.y[i] - scene.sections.y[i - 1] > 1.5 * scene.pitch:
            continue
        for o in range(first[i], first[i + 1]):
            b = order[o]
            if slices.plate[a] == slices.plate[b] or boxes_apart(boxes[a], boxes[b], 1.5 * near):
                continue
            both = outlines[a, : slices.sides[a]], outlines[b, : slices.sides[b]]
            gap, nx, nz = apart(both[0], both[1])
            if gap > near or _both_cut(pieces, slices.piece[a], slices.piece[b]):
                continue
            full = found >= sides.area.shape[0]
            if full or _meet(scene, pieces, (a, b), both, (gap, nx, nz), sides, found):
                found += 1
    return found


@compiled(nogil=True)
def _common(own: Array, other: Array, dx: float, dz: float) -> AreaMoments:
    """Area, and its middle, of an outline with another one that is moved."""
    moved = other.copy()
    moved[:, 0] -= dx
    moved[:, 1] -= dz
    found: AreaMoments = area_moments(intersection(own.copy(), moved))
    return found


@compiled(nogil=True, borrows=True)
def _both_cut(pieces: Pieces, a: int, b: int) -> bool:
    """Whether one plane cuts both: their contact is found in it."""
    cut: bool = pieces.range[a, 1] >= pieces.range[b, 0]
    return cut


@compiled(nogil=True, borrows=True)
def _meet(
    scene: Scene,
    pieces: Pieces,
    pair: tuple[int, int],
    outlines: tuple[Array, Array],
    apart: tuple[float, float, float],
    sides: Sides,
    k: int,
) -> bool:
    """The contact of two slices between their planes as pair k; says whether there may be one."""
    (a, b), (gap, nx, nz), near = pair, apart, NEAR * scene.pitch
    shift = max(gap, 0.0) + 0.5 * near if gap > -near else 0.0
    common = _common(outlines[0], outlines[1], shift * nx, shift * nz)
    if common.area <= 0.0:
        return False
    x, z = common.x, common.z
    end, ax, ay, az = end_along_y(scene.plates, scene.slices, pieces, a, x, z, 1.0)
    start, bx, by, bz = end_along_y(scene.plates, scene.slices, pieces, b, x, z, -1.0)
    beside = start - end
    if beside > near or (beside > 0.0 and gap > 0.0):
        return False
    n = sides.normal[k]
    sides.pair[k, 0], sides.pair[k, 1] = a, b
    if beside >= gap:
        n[0], n[1], n[2] = ax - bx, ay - by, az - bz
        length = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        n[0], n[1], n[2] = n[0] / length, n[1] / length, n[2] / length
        sides.area[k] = common.area
        _arm(scene, a, sides.arm[k, 0], x, end, z)
        _arm(scene, b, sides.arm[k, 1], x, start, z)
    else:
        n[0], n[1], n[2] = nx, 0.0, nz
        sides.area[k] = -beside * np.sqrt(common.area)
        y = 0.5 * (start + end)
        _arm(scene, a, sides.arm[k, 0], x - 0.5 * gap * nx, y, z - 0.5 * gap * nz)
        _arm(scene, b, sides.arm[k, 1], x + 0.5 * gap * nx, y, z + 0.5 * gap * nz)
    return True


@compiled(nogil=True, borrows=True)
def _arm(scene: Scene, s: int, out: Array, x: float, y: float, z: float) -> None:
    """A point in the axes of the plate of a slice."""
    k = scene.slices.plate[s]
    p = scene.plates.position
    out[0], out[1], out[2] = turn_back(scene.plates.rotation[k], x - p[k, 0], y - p[k, 1], z - p[k, 2])
