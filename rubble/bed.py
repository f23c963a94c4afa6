"""The sea bed: level ground, on which rubble comes to stand.

It is the half-space below a height. A convex outline reaches deepest into a half-space with its corners, so each corner
of a slice that stands below the bed is one contact: nothing has to be looked for, and its identity is slice and corner.
The normal points up; what the contact carries before the ice crushes is that of one with the structure.
"""

from __future__ import annotations

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled
from rubble.corners import bounds, first_of, go_on_from
from rubble.gather import Scene
from rubble.outlines import put_outline
from rubble.rows import BED, Rows, set_way
from rubble.slots import BED_SLOT


@compiled(nogil=True, borrows=True)
def bed_rows(scene: Scene, both: tuple[Rows, Rows], found: int, before: int, cut: bool, corners: Array) -> int:
    """Adds a row for each corner of a slice below the bed; returns the number of rows, -1 if there is no room.

    ``both``: new rows, and the old ones, of which there are ``before``. ``cut``: slices are new; ``corners`` is room.
    """
    rows, old = both
    if not np.isfinite(scene.bed):
        return found
    plates, slices, last, c = scene.plates, scene.slices, first_of(old, before, BED_SLOT), found
    for s in range(slices.piece.shape[0]):
        k, start = slices.plate[s], c
        put_outline(scene, s, corners)
        for i in range(slices.sides[s]):
            depth = scene.bed - corners[i, 1]
            if depth < 0.0:
                continue
            if c >= rows.point.shape[0]:
                return -1
            point = rows.point[c]
            point.a, point.b, point.edge, point.kind = plates.moved.shape[0] - 1, k, -1, BED
            point.slot_a, point.slot_b, point.feature, point.depth = BED_SLOT, s, i, depth
            point.x, point.y, point.z = corners[i, 0], slices.y[s], scene.bed - 0.5 * depth
            set_way(rows.way[c, 0], 0.0, 0.0, 1.0)
            set_way(rows.way[c, 1], -1.0, 0.0, 0.0)
            set_way(rows.way[c, 2], 0.0, -1.0, 0.0)
            last = go_on_from(rows, c, old, last, before, cut)
            c += 1
        bounds(scene, rows, start, c, (scene.widths[s], 0.0))
    return c
