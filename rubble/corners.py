"""Contacts that are looked for corner by corner: how they go on, and what they carry.

They are not pymunk's, which finds pairs of outlines; a row's identity is who stands at end a, the slice and the feature
of the slice. They stand in the order of slices and features.
"""

from __future__ import annotations

import numpy as np

from rubble.compiled import compiled
from rubble.gather import Scene
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
def bounds(scene: Scene, rows: Rows, start: int, end: int, width: float) -> None:
    """What contacts of ice of a width [m] carry until it crushes: strength times width times length, shared by them."""
    left, right, low, high, length = np.inf, -np.inf, np.inf, -np.inf, scene.shortest
    for c in range(start, end):
        point = rows.point[c]
        left, right, low, high = min(left, point.x), max(right, point.x), min(low, point.z), max(high, point.z)
        length = max(length, 2.0 * point.depth, np.hypot(right - left, high - low))
    for c in range(start, end):
        rows.point[c].most = scene.strength * min(scene.pitch, width) * length / (end - start)
