"""Contacts that are looked for corner by corner: how they go on, and what they carry.

They are not pymunk's, which finds pairs of outlines; a row's identity is who stands at end a, the slice and the feature
of the slice. They stand in the order of slices and features.
"""

from __future__ import annotations

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.geometry import chord
from rubble.plates import turn_back
from rubble.rows import Rows, go_on


@compiled(nogil=True, borrows=True)
def first_of(old: Rows, before: int, slot: int) -> int:
    """The first of ``before`` rows with this end a; ``before`` if there is none."""
    last = 0
    while last < before and old.point[last].slot_a != slot:
        last += 1
    return last


@compiled(nogil=True, borrows=True)
def go_on_from(rows: Rows, c: int, old: Rows, last: int, before: int, cut: bool) -> int:
    """Row c goes on from its own of the sub-step before, at ``last`` or behind; returns where it looked last."""
    own = rows.point[c]
    while last < before and old.point[last].slot_a == own.slot_a:
        was = old.point[last]
        if was.slot_b > own.slot_b or (was.slot_b == own.slot_b and was.feature >= own.feature):
            break
        last += 1
    same = last < before and old.point[last].slot_a == own.slot_a
    same = same and old.point[last].slot_b == own.slot_b and old.point[last].feature == own.feature
    go_on(rows, c, old, last if same else -1, 0.0, cut)
    return last


@compiled(nogil=True, borrows=True)
def bounds(scene: Scene, rows: Rows, start: int, end: int, size: tuple[float, float]) -> None:
    """What contacts of ice carry until it crushes: strength times width times length, shared by them.

    ``size``: width of the piece, and length over which its outline meets the surface where it stands deepest, 0 if that
    is not known [m]: a facet widens on both sides as it is pressed in, up to that length.
    """
    left, right, low, high, deep, least = np.inf, -np.inf, np.inf, -np.inf, 0.0, np.inf
    for c in range(start, end):
        point = rows.point[c]
        left, right, low, high = min(left, point.x), max(right, point.x), min(low, point.z), max(high, point.z)
        deep, least = max(deep, point.depth), min(least, point.depth)
    if end > start:
        extent = np.hypot(right - left, high - low)
        length = max(scene.shortest, 2.0 * deep, extent, min(extent + 2.0 * least, size[1]))
        for c in range(start, end):
            rows.point[c].most = scene.strength * min(scene.pitch, size[0]) * length / (end - start)


@compiled(nogil=True, borrows=True)
def deepest_chord(scene: Scene, outline: Array, rows: Rows, start: int, end: int) -> float:
    """Length over which the outline of a piece meets the surface at the deepest of its contacts, 0 without any [m]."""
    if end == start:
        return 0.0
    deep = start
    for c in range(start + 1, end):
        if rows.point[c].depth > rows.point[deep].depth:
            deep = c
    point, n, k = rows.point[deep], rows.way[deep, 0], rows.point[deep].b
    p, r, half = scene.plates.position[k], scene.plates.rotation[k], 0.5 * point.depth
    x, y, z = point.x + half * n.x - p[0], point.y + half * n.y - p[1], point.z + half * n.z - p[2]
    (x, _, z), (n_x, _, n_z) = turn_back(r, x, y, z), turn_back(r, n.x, n.y, n.z)
    found: float = chord(outline, outline.shape[0], x, z, n_x, n_z)
    return found
