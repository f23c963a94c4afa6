"""Convex polygons of a structure from the polyline of its front face in a section."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from rubble.arrays import Array
from rubble.geometry import contiguous

SAME = 1e-9  #: points that are nearer to each other are one, over the largest coordinate


def convex_parts(face: Array, back: Array | float | None = None) -> list[Array]:
    """Convex polygons (k, 2) of the solid behind a front face (n, 2) of (x, z) points, z ascending.

    Solid pieces, not lines: what overlaps is pushed out through the face. The solid reaches to the mirror image of
    the face in x = 0, as for a body of revolution, or to ``back``: a line of points like the face, or a wall [m]. It is
    split at heights where the face turns inwards (the corner between cone and neck). No face gives no polygon.
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


def _closed(part: Array, back: Array | float | None) -> Array:
    mirrored = part[::-1] * np.array([-1.0, 1.0])
    rear = mirrored if back is None else _rear(part, np.asarray(back, dtype=np.float64))
    loop = np.concatenate([part, rear])
    kept: Array = loop[np.abs(loop - np.roll(loop, 1, axis=0)).max(axis=1) > SAME * np.abs(loop).max()]
    return kept


def _rear(part: Array, back: Array) -> Array:
    """The back between the ends of a part, from its top down."""
    low, high = part[0, 1], part[-1, 1]
    if back.ndim == 0:
        back = np.array([(back, low), (back, high)])
    x, z = back.T
    ends = [(float(np.interp(at, z, x)), at) for at in (low, high)]
    line = np.array([ends[0], *back[(z > low) & (z < high)].tolist(), ends[1]])
    rearmost, face = float(line[:, 0].max()), float(part[:, 0].max())
    ahead = line[:, 0] < np.interp(line[:, 1], part[:, 1], part[:, 0]) - SAME * abs(rearmost)
    if ahead.any() or rearmost <= face:
        raise ValueError(f"back of the structure at {rearmost:g} m lies ahead of its face; give more than {face:g} m")
    return line[::-1]
