"""Banks: plates meet the sides of the sheet, where it stands beside the section that they are in.

The sheet of a section fills it from side to side. A plate that the plane of the section does not cut, but that of the
next one does, meets it there with its end along y, in the middle of what both have in common as seen along y. The
contact lies on the bank, its normal along y; within a window its point moves with the plate.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Record
from rubble.compiled import compiled
from rubble.edges import locate
from rubble.gather import Scene
from rubble.geometry import area_moments, intersection
from rubble.outlines import apart, box_of, boxes_apart, put_outline
from rubble.plates import times, turn_back
from rubble.rows import SHEET, Rows, go_on
from rubble.sides import NEAR, directions
from rubble.slices import CORNERS, Pieces, end_along_y
from rubble.slots import SHEET_SLOT

BANK = -2  #: marks a row of a plate and a side of the sheet
#: overlap as seen along y, in thicknesses, up to which a plate lies over, under or before the sheet, and not beside it
ABOVE = 0.05
Room = tuple[Array, Array, Array]  #: two outlines, (CORNERS, 2) and (4, 2), and the boxes round them (2, 4)


class Banks(NamedTuple):
    """Slices that may meet a side of the sheet in this window."""

    slice: IntArray  #: (k,) ascending
    edge: IntArray  #: (k,) place of the section with the sheet
    normal: Array  #: (k, 3) from the sheet to the plate
    arm: Array  #: (k, 3) the point of the plate, in its axes [m]
    area: Array  #: (k,) of the contact [m2]


def bank_room(count: int) -> Banks:
    """Room for so many."""
    whole = np.zeros(count, np.int64)
    return Banks(whole, whole.copy(), np.zeros((count, 3)), np.zeros((count, 3)), np.zeros(count))


@compiled(nogil=True, borrows=True)
def bank_rows(scene: Scene, banks: Banks, rows: Rows, old: Rows, found: int, before: int, cut: bool) -> int:
    """Adds a row for each plate that overlaps a side of the sheet; returns the number of rows, -1: there is no room.

    ``old`` has ``before`` rows; those of banks stand behind those of sides, in the same order.
    ``cut``: slices are new.
    """
    plates, edges, last, c = scene.plates, scene.edges, 0, found
    while last < before and old.point[last].feature != BANK:
        last += 1
    for k in range(banks.slice.shape[0]):
        s, e, n, b = banks.slice[k], banks.edge[k], banks.normal[k], banks.arm[k]
        j = scene.slices.plate[s]
        x, y, z = times(plates.rotation[j], b[0], b[1], b[2])
        side = scene.sections.y[e] + 0.5 * scene.pitch * n[1]
        depth = (side - plates.position[j, 1] - y) * n[1]
        if depth <= 0.0:
            continue
        if c >= rows.point.shape[0]:
            return -1
        point = rows.point[c]
        point.a, point.b, point.edge, point.kind = plates.moved.shape[0] - 1, j, e, SHEET
        point.slot_a, point.slot_b, point.feature = SHEET_SLOT, s, BANK
        point.x, point.y, point.z = plates.position[j, 0] + x, side, plates.position[j, 2] + z
        point.depth, point.most = depth, scene.strength * banks.area[k]
        locate(point, edges.nodes, edges.offset[e], edges.offset[e + 1])
        directions(rows, c, n)
        while last < before and _earlier(old.point[last], s, e):
            last += 1
        same = last < before and old.point[last].feature == BANK
        same = same and old.point[last].slot_b == s and old.point[last].edge == e
        go_on(rows, c, old, last if same else -1, 0.0, cut)
        c += 1
    return c


@compiled(nogil=True, borrows=True)
def _earlier(p: Record, s: int, e: int) -> bool:
    earlier: bool = p.feature == BANK and (p.slot_b < s or (p.slot_b == s and p.edge < e))
    return earlier


@compiled(nogil=True)
def find_banks(scene: Scene, pieces: Pieces, thickness: float, banks: Banks) -> int:
    """Slices that may meet a side of the sheet; returns how many, more than there is room for if so."""
    room = np.empty((CORNERS, 2)), np.empty((4, 2)), np.empty((2, 4))
    return int(_find(scene, pieces, thickness, banks, room))


@compiled(nogil=True, borrows=True)
def _find(scene: Scene, pieces: Pieces, thickness: float, banks: Banks, room: Room) -> int:
    """The same, with room for two outlines and the boxes round them."""
    slices, edges, found = scene.slices, scene.edges, 0
    for s in range(slices.piece.shape[0]):
        for side in range(2):
            sign = 1 - 2 * side  # +1: the sheet stands at smaller y
            e = slices.section[s] - sign
            if e < 0 or e >= edges.body.shape[0] or edges.body[e] == 0:
                continue
            apart = abs(scene.sections.y[slices.section[s]] - scene.sections.y[e])
            if apart > 1.5 * scene.pitch or _cut(scene, s, e):
                continue
            full = found >= banks.area.shape[0]
            if full or _meet(scene, pieces, (s, e, float(sign)), thickness, banks, found, room):
                found += 1
    return found


@compiled(nogil=True, borrows=True)
def _cut(scene: Scene, s: int, e: int) -> bool:
    """Whether the plane of section e cuts the plate of slice s: its contact with the sheet is found there.

    Pieces of a plate have numbers one after the other, so its slices stand side by side.
    """
    slices = scene.slices
    for step in (-1, 1):
        other = s
        while 0 <= other < slices.section.shape[0] and slices.plate[other] == slices.plate[s]:
            if slices.section[other] == e:
                return True
            other += step
    return False


@compiled(nogil=True)
def _common(own: Array, other: Array) -> tuple[float, float, float, float]:
    """Area of what two outlines have in common, its middle, and how deep they stand in each other."""
    common = intersection(own.copy(), other)
    if common.shape[0] < 3:
        return 0.0, 0.0, 0.0, 0.0
    m, (gap, _, _) = area_moments(common), apart(own, other)
    return m.area, m.x, m.z, -gap


@compiled(nogil=True, borrows=True)
def _meet(
    scene: Scene,
    pieces: Pieces,
    which: tuple[int, int, float],
    thickness: float,
    banks: Banks,
    k: int,
    room: Room,
) -> bool:
    """The contact of a slice with the sheet of the next section as bank k; says whether there may be one."""
    (s, e, sign), (own, quad, boxes), corners = which, room, scene.slices.sides[which[0]]
    nodes, first, end = scene.edges.nodes, scene.edges.offset[e], scene.edges.offset[e + 1]
    area, at_x, at_z, deepest, half = 0.0, 0.0, 0.0, 0.0, 0.5 * thickness
    put_outline(scene, s, own)
    box_of(own, corners, boxes[0])
    for i in range(first, end - 1):
        a, b = nodes[i + 1], nodes[i]
        quad[0, 0], quad[0, 1], quad[1, 0], quad[1, 1] = a.x, a.z - half, b.x, b.z - half
        quad[2, 0], quad[2, 1], quad[3, 0], quad[3, 1] = b.x, b.z + half, a.x, a.z + half
        box_of(quad, 4, boxes[1])
        if not boxes_apart(boxes[0], boxes[1], 0.0):
            part, x, z, depth = _common(own[:corners], quad)
            area, at_x, at_z, deepest = area + part, at_x + part * x, at_z + part * z, max(deepest, depth)
    if area <= 0.0 or deepest < ABOVE * thickness:
        return False
    x, z = at_x / area, at_z / area
    y, _, _, _ = end_along_y(scene.plates, scene.slices, pieces, s, x, z, -sign)
    if (y - scene.sections.y[e]) * sign - 0.5 * scene.pitch > NEAR * scene.pitch:
        return False
    j, p, n = scene.slices.plate[s], scene.plates.position, banks.normal[k]
    banks.slice[k], banks.edge[k], banks.area[k] = s, e, area
    n[0], n[1], n[2] = 0.0, sign, 0.0
    arm = turn_back(scene.plates.rotation[j], x - p[j, 0], y - p[j, 1], z - p[j, 2])
    banks.arm[k, 0], banks.arm[k, 1], banks.arm[k, 2] = arm
    return True
