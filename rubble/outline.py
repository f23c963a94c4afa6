"""Convex polygons of a structure from the polyline of its front face in a section."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rubble.arrays import Array
from rubble.geometry import contiguous


def convex_parts(face: Array, back: float | None = None) -> list[Array]:
    """Convex polygons (k, 2) of the solid behind a front face (n, 2) of (x, z) points, z ascending.

    Solid pieces, not lines: what overlaps is pushed out through the face. The solid reaches to the mirror image of
    the face in x = 0, as for a body of revolution, or to ``back`` [m]. It is split at heights where the face turns
    inwards (the corner between cone and neck). No face gives no polygon.
    """
    if len(face) < 2:
        return []
    return [contiguous(_closed(part, back)) for part in _convex_runs(np.asarray(face, dtype=np.float64))]


def _convex_runs(face: Array) -> list[Array]:
    step = np.diff(face, axis=0)
    left_turn = step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0]
    scale = np.hypot(*step[:-1].T) * np.hypot(*step[1:].T)
    ends = [0, *(np.flatnonzero(left_turn > 1e-9 * scale) + 1).tolist(), len(face) - 1]
    return [face[a : b + 1] for a, b in pairwise(ends)]


def _closed(part: Array, back: float | None) -> Array:
    if back is None:
        rear = part[::-1] * np.array([-1.0, 1.0])
    else:
        if part[:, 0].max() >= back:
            raise ValueError(
                f"back of the structure at {back:g} m lies ahead of its face; give more than {part[:, 0].max():g} m"
            )
        rear = np.array([(back, part[-1, 1]), (back, part[0, 1])])
    loop = np.concatenate([part, rear])
    kept: Array = loop[np.abs(loop - np.roll(loop, 1, axis=0)).max(axis=1) > 1e-9]
    return kept
