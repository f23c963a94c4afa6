"""Plane geometry of convex polygons in the x-z picture, counter-clockwise, coordinates in metres.

Area, centroid and second moment follow from Green's theorem edge by edge; clipping by a half-plane is one step of
Sutherland and Hodgman (1974). All kernels are pure and have one compiled signature: float64, C-contiguous.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rubble.compiled import compiled

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

POINT = "float64[::1]"
POLYGON = "float64[:, ::1]"


@compiled(f"float64[::1]({POLYGON})", nogil=True)
def moments(polygon: Array) -> Array:
    """Area, centroid x, centroid z and polar second moment of area about the centroid of a (k, 2) polygon.

    Units m^2, m, m, m^4; area and second moment are positive for counter-clockwise order.
    """
    k = polygon.shape[0]
    x0, z0 = (polygon[0, 0], polygon[0, 1]) if k > 0 else (0.0, 0.0)  # near origin: no cancellation far from x = 0
    area = sx = sz = polar = 0.0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        ax, az, bx, bz = polygon[i, 0] - x0, polygon[i, 1] - z0, polygon[j, 0] - x0, polygon[j, 1] - z0
        cross = ax * bz - bx * az
        area += cross / 2
        sx += cross * (ax + bx) / 6
        sz += cross * (az + bz) / 6
        polar += cross * (ax * ax + ax * bx + bx * bx + az * az + az * bz + bz * bz) / 12
    out = np.zeros(4)
    if area != 0.0:
        cx, cz = sx / area, sz / area
        out[0], out[1], out[2], out[3] = area, x0 + cx, z0 + cz, polar - area * (cx * cx + cz * cz)
    return out


@compiled(f"{POLYGON}({POLYGON}, float64, float64, float64)", nogil=True)
def clip(polygon: Array, nx: float, nz: float, c: float) -> Array:
    """The part of a convex (k, 2) polygon on which ``nx x + nz z <= c``; (m, 2), m = 0 if nothing is left."""
    k = polygon.shape[0]
    out = np.empty((k + 1, 2))
    m = 0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        di = nx * polygon[i, 0] + nz * polygon[i, 1] - c
        dj = nx * polygon[j, 0] + nz * polygon[j, 1] - c
        if di <= 0.0 and m <= k:
            out[m] = polygon[i]
            m += 1
        if (di < 0.0 < dj or dj < 0.0 < di) and m <= k:
            s = di / (di - dj)
            out[m] = polygon[i] + s * (polygon[j] - polygon[i])
            m += 1
    return out[:m].copy()


@compiled(f"{POLYGON}({POLYGON})", nogil=True)
def submerged(polygon: Array) -> Array:
    """The part of a convex polygon below still water, z <= 0."""
    return clip(polygon, 0.0, 1.0, 0.0)


@compiled(f"{POLYGON}({POLYGON}, {POLYGON})", nogil=True)
def intersection(polygon: Array, convex: Array) -> Array:
    """Common part of two convex counter-clockwise polygons; (0, 2) if they do not meet."""
    out = polygon.copy()
    for i in range(convex.shape[0]):
        j = i + 1 if i + 1 < convex.shape[0] else 0
        nx, nz = convex[j, 1] - convex[i, 1], convex[i, 0] - convex[j, 0]
        if out.shape[0] > 0:
            out = clip(out, nx, nz, nx * convex[i, 0] + nz * convex[i, 1])
    return out


@compiled(f"{POLYGON}({POLYGON}, float64, float64, float64, float64, float64)", nogil=True)
def place(polygon: Array, x: float, z: float, angle: float, dx: float, dz: float) -> Array:
    """A body-frame polygon, first shifted by (dx, dz), turned by ``angle`` [rad] and moved to (x, z)."""
    c, s = np.cos(angle), np.sin(angle)
    out = np.empty_like(polygon)
    for i in range(polygon.shape[0]):
        px, pz = polygon[i, 0] + dx, polygon[i, 1] + dz
        out[i, 0], out[i, 1] = x + c * px - s * pz, z + s * px + c * pz
    return out


@compiled(f"{POLYGON}({POLYGON}, {POLYGON})", nogil=True)
def nearest_edges(edges: Array, points: Array) -> Array:
    """Angle [rad] and distance [m] (n, 2) of the edge (x0, z0, x1, z1) of (e, 4) nearest to each point (n, >= 2)."""
    out = np.full((points.shape[0], 2), np.inf)
    for i in range(points.shape[0]):
        x, z = points[i, 0], points[i, 1]
        for e in range(edges.shape[0]):
            ex, ez = edges[e, 2] - edges[e, 0], edges[e, 3] - edges[e, 1]
            s = ((x - edges[e, 0]) * ex + (z - edges[e, 1]) * ez) / (ex * ex + ez * ez)
            s = min(1.0, max(0.0, s))
            d = np.hypot(x - edges[e, 0] - s * ex, z - edges[e, 1] - s * ez)
            if d < out[i, 1]:
                out[i, 0], out[i, 1] = np.arctan2(ez, ex), d
    return out


@compiled(f"{POLYGON}({POLYGON}, int64[::1], {POLYGON})", nogil=True)
def place_all(polygons: Array, offset: IntArray, state: Array) -> Array:
    """Body-frame polygons (v, 2), block i from offset[i] to offset[i + 1], at the poses (n, >= 3) x, z, angle."""
    out = np.empty_like(polygons)
    for i in range(state.shape[0]):
        c, s = np.cos(state[i, 2]), np.sin(state[i, 2])
        for k in range(offset[i], offset[i + 1]):
            out[k, 0] = state[i, 0] + c * polygons[k, 0] - s * polygons[k, 1]
            out[k, 1] = state[i, 1] + s * polygons[k, 0] + c * polygons[k, 1]
    return out


def contiguous(polygon: object) -> Array:
    """A (k, 2) float64 C-contiguous copy in counter-clockwise order; ValueError if it is no polygon."""
    out = np.array(polygon, dtype=np.float64, order="C")
    if out.ndim != 2 or out.shape[1] != 2 or len(out) < 3 or not np.isfinite(out).all():
        raise ValueError(f"outline of shape {out.shape} must be (k >= 3, 2) finite points; check the corners")
    return out if moments(out)[0] >= 0 else out[::-1].copy()


def is_convex(polygon: Array) -> bool:
    """Whether a counter-clockwise polygon turns left at every corner, up to rounding."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    turn = edge[:, 0] * np.roll(edge[:, 1], -1) - edge[:, 1] * np.roll(edge[:, 0], -1)
    return bool((turn >= -1e-9 * np.abs(edge).max() ** 2).all())


def exposed_edges(solids: Sequence[Array]) -> Array:
    """Outer edges (e, 4) of a body made of convex polygons: those whose middle lies in no other polygon."""
    rows = []
    for i, solid in enumerate(solids):
        for a, b in zip(solid, np.roll(solid, -1, axis=0), strict=True):
            middle = (a + b) / 2
            if not any(_holds(other, middle) for j, other in enumerate(solids) if j != i):
                rows.append((a[0], a[1], b[0], b[1]))
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def _holds(polygon: Array, point: Array) -> bool:
    edge = np.roll(polygon, -1, axis=0) - polygon
    left = edge[:, 0] * (point[1] - polygon[:, 1]) - edge[:, 1] * (point[0] - polygon[:, 0])
    return bool((left >= -1e-9 * np.abs(edge).max() ** 2).all())


def overlap_area(polygon: Array, solids: Sequence[Array]) -> float:
    """Area [m^2] that a convex polygon shares with convex polygons that do not overlap each other."""
    return float(sum(moments(intersection(polygon, solid))[0] for solid in solids))
