"""Outlines of slices in their plane, and how far they are apart."""

from __future__ import annotations

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.plates import times


@compiled(nogil=True, borrows=True)
def put_outline(scene: Scene, s: int, out: Array) -> None:
    """Corners of a slice in the plane (m, 2) [m]."""
    r, b, p = scene.plates.rotation[scene.slices.plate[s]], scene.slices.anchor[s], scene.plates.position
    h, k = max(np.hypot(r[0, 0], r[2, 0]), 1e-12), scene.slices.plate[s]
    cos, sin = r[0, 0] / h, r[2, 0] / h
    ox, _, oz = times(r, b[0], b[1], b[2])
    for c in range(scene.slices.sides[s]):
        x, z = scene.slices.corners[s, c, 0], scene.slices.corners[s, c, 1]
        out[c, 0], out[c, 1] = p[k, 0] + ox + cos * x - sin * z, p[k, 2] + oz + sin * x + cos * z


@compiled(nogil=True, borrows=True)
def apart(a: Array, b: Array) -> tuple[float, float, float]:
    """Gap between two convex outlines along the edge normal on which it is largest, and that normal, from a to b."""
    best, nx, nz = -np.inf, 1.0, 0.0
    for side in range(2):
        own, other, sign = (a, b, 1.0) if side == 0 else (b, a, -1.0)
        for i in range(own.shape[0]):
            j = (i + 1) % own.shape[0]
            tx, tz = own[j, 0] - own[i, 0], own[j, 1] - own[i, 1]
            length = np.hypot(tx, tz)
            if length <= 0.0:
                continue
            ux, uz, least = tz / length, -tx / length, np.inf
            for k in range(other.shape[0]):
                least = min(least, ux * (other[k, 0] - own[i, 0]) + uz * (other[k, 1] - own[i, 1]))
            if least > best:
                best, nx, nz = least, sign * ux, sign * uz
    return best, nx, nz


@compiled(nogil=True, borrows=True)
def boxes_apart(a: Array, b: Array, way: float) -> bool:
    """Whether two boxes (lowest x and z, highest x and z) are farther apart than `_meet` brings outlines together."""
    far: bool = max(a[0] - b[2], b[0] - a[2], a[1] - b[3], b[1] - a[3]) > way
    return far


@compiled(nogil=True, borrows=True)
def box_of(outline: Array, corners: int, box: Array) -> None:
    """Lowest x and z, highest x and z of the first corners of an outline."""
    for d in range(2):
        box[d], box[2 + d] = outline[0, d], outline[0, d]
        for c in range(1, corners):
            box[d], box[2 + d] = min(box[d], outline[c, d]), max(box[2 + d], outline[c, d])
