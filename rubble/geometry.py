"""Plane geometry of convex polygons in the x-z picture, counter-clockwise, coordinates in metres.

Area, centroid and second moment follow from Green's theorem edge by edge; clipping by a half-plane is one step of
Sutherland and Hodgman (1974). Kernels are pure; polygons are float64 and C-contiguous.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array
from rubble.compiled import compiled

POLYGON = "float64[:, ::1]"


class AreaMoments(NamedTuple):
    """Area, its centroid, and its second moment; area and second moment are positive for counter-clockwise order."""

    area: float  #: [m^2]
    x: float  #: of the centroid [m]
    z: float  #: of the centroid [m]
    polar: float  #: polar second moment about the centroid [m^4]


@compiled(nogil=True)
def area_moments(polygon: Array) -> AreaMoments:
    """Moments of area of a (k, 2) polygon; all 0 if it has no area."""
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
    if area == 0.0:
        return AreaMoments(0.0, 0.0, 0.0, 0.0)
    cx, cz = sx / area, sz / area
    return AreaMoments(area, x0 + cx, z0 + cz, polar - area * (cx * cx + cz * cz))


class SecondMoments(NamedTuple):
    """Second moments of area about the centroid [m^4]."""

    xx: float
    zz: float
    xz: float


@compiled(nogil=True)
def second_moments(polygon: Array) -> SecondMoments:
    """Second moments of a (k, 2) polygon, counter-clockwise."""
    own, k = area_moments(polygon), polygon.shape[0]
    xx = zz = xz = 0.0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        ax, az, bx, bz = polygon[i, 0] - own.x, polygon[i, 1] - own.z, polygon[j, 0] - own.x, polygon[j, 1] - own.z
        cross = ax * bz - bx * az
        xx += cross * (ax * ax + ax * bx + bx * bx) / 12
        zz += cross * (az * az + az * bz + bz * bz) / 12
        xz += cross * (ax * bz + 2 * ax * az + 2 * bx * bz + bx * az) / 24
    return SecondMoments(xx, zz, xz)


@compiled(nogil=True, borrows=True)
def clip_into(out: Array, polygon: Array, k: int, nx: float, nz: float, c: float) -> int:
    """As `clip`, of the first k corners and into ``out`` (k + 1 or more, 2); returns how many corners are left."""
    m = 0
    for i in range(k):
        j = i + 1 if i + 1 < k else 0
        di = nx * polygon[i, 0] + nz * polygon[i, 1] - c
        dj = nx * polygon[j, 0] + nz * polygon[j, 1] - c
        if di <= 0.0 and m <= k:
            out[m, 0], out[m, 1] = polygon[i, 0], polygon[i, 1]
            m += 1
        if (di < 0.0 < dj or dj < 0.0 < di) and m <= k:
            s = di / (di - dj)
            out[m, 0] = polygon[i, 0] + s * (polygon[j, 0] - polygon[i, 0])
            out[m, 1] = polygon[i, 1] + s * (polygon[j, 1] - polygon[i, 1])
            m += 1
    return m


@compiled(f"{POLYGON}({POLYGON}, float64, float64, float64)", nogil=True)
def clip(polygon: Array, nx: float, nz: float, c: float) -> Array:
    """The part of a convex (k, 2) polygon on which ``nx x + nz z <= c``; (m, 2), m = 0 if nothing is left."""
    k = polygon.shape[0]
    out = np.empty((k + 1, 2))
    return out[: clip_into(out, polygon, k, nx, nz, c)].copy()


@compiled(nogil=True, borrows=True)
def chord(corners: Array, count: int, x: float, z: float, nx: float, nz: float) -> float:
    """Length of the line through (x, z) across (nx, nz) in a convex polygon of the first ``count`` corners [m]."""
    low, high, length = np.inf, -np.inf, max(np.hypot(nx, nz), 1e-300)
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        ax, az, bx, bz = corners[i, 0] - x, corners[i, 1] - z, corners[j, 0] - x, corners[j, 1] - z
        p, q = nx * ax + nz * az, nx * bx + nz * bz
        if (p <= 0.0) != (q <= 0.0):
            s = p / (p - q)
            at = (nx * (az + s * (bz - az)) - nz * (ax + s * (bx - ax))) / length
            low, high = min(low, at), max(high, at)
    return max(high - low, 0.0)


@compiled(f"{POLYGON}({POLYGON})", nogil=True)
def submerged(polygon: Array) -> Array:
    """The part of a convex polygon below still water, z <= 0."""
    out: Array = clip(polygon, 0.0, 1.0, 0.0)
    return out


@compiled(f"{POLYGON}({POLYGON}, {POLYGON})", nogil=True)
def intersection(polygon: Array, convex: Array) -> Array:
    """Common part of two convex counter-clockwise polygons; (0, 2) if they do not meet."""
    m, sides = polygon.shape[0], convex.shape[0]
    now, new = np.empty((m + sides, 2)), np.empty((m + sides, 2))
    now[:m] = polygon
    for i in range(sides):
        j = i + 1 if i + 1 < sides else 0
        nx, nz = convex[j, 1] - convex[i, 1], convex[i, 0] - convex[j, 0]
        m = clip_into(new, now, m, nx, nz, nx * convex[i, 0] + nz * convex[i, 1])
        now, new = new, now
    return now[:m].copy()


@compiled(f"{POLYGON}({POLYGON}, float64, float64, float64, float64, float64)", nogil=True)
def place(polygon: Array, x: float, z: float, angle: float, dx: float, dz: float) -> Array:
    """A body-frame polygon, first shifted by (dx, dz), turned by ``angle`` [rad] and moved to (x, z)."""
    c, s = np.cos(angle), np.sin(angle)
    out = np.empty_like(polygon)
    for i in range(polygon.shape[0]):
        px, pz = polygon[i, 0] + dx, polygon[i, 1] + dz
        out[i, 0], out[i, 1] = x + c * px - s * pz, z + s * px + c * pz
    return out


def contiguous(polygon: object) -> Array:
    """A (k, 2) float64 C-contiguous copy in counter-clockwise order; ValueError if it is no polygon."""
    out = np.array(polygon, dtype=np.float64, order="C")
    if out.ndim != 2 or out.shape[1] != 2 or len(out) < 3 or not np.isfinite(out).all():
        raise ValueError(f"outline of shape {out.shape} must be (k >= 3, 2) finite points; check the corners")
    return out if area_moments(out).area >= 0 else out[::-1].copy()


def is_convex(polygon: Array) -> bool:
    """Whether a counter-clockwise polygon turns left at every corner, up to rounding."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    turn = edge[:, 0] * np.roll(edge[:, 1], -1) - edge[:, 1] * np.roll(edge[:, 0], -1)
    return bool((turn >= -1e-9 * np.abs(edge).max() ** 2).all())


def holds(polygon: Array, point: Array) -> bool:
    """Whether a convex polygon holds a point (2,), its edges included."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    left = edge[:, 0] * (point[1] - polygon[:, 1]) - edge[:, 1] * (point[0] - polygon[:, 0])
    return bool((left >= -1e-9 * np.abs(edge).max() ** 2).all())


def overlap_area(polygon: Array, solids: Sequence[Array]) -> float:
    """Area [m^2] that a convex polygon shares with convex polygons that do not overlap each other."""
    return float(sum(area_moments(intersection(polygon, solid)).area for solid in solids))
