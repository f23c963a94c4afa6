"""The structure that the ice meets: a body of revolution about the z axis, or a slope of infinite width.

A body of revolution has the profile r(z), piecewise linear between (z, r) points, z upwards, z = 0 still water. The
plane y cuts it along ``x = -sqrt(r(z)^2 - y^2)`` on the side from which the ice comes (x < 0). The in-plane normal of
that curve is the projection of the surface normal, so a contact force in the plane gives the true Fx and Fz.

Side force: the ice presses along -n, and n of a body of revolution lies in the plane through the axis, so
``Fy / Fx = n_y / n_x = y / x``. On the front (x < 0) at y > 0 the structure is pushed towards -y, the ice towards +y:
ice clears away from the middle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isfinite, pi, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from coupling.compiled import compiled

Array = NDArray[np.float64]

DEEP = 1000.0  #: depth of a structure that stands on the sea bed, out of reach of any ice [m]


@compiled()
def overlap_of(x, y, z, profile_z, profile_r, revolved):
    """How far ice at x (m,) reaches behind the face at y (m, k) and z (m,), and normals of the face (m, k, 3).

    Without a face the overlap is 0 and the normal that of a vertical wall, so that nothing divides by zero.
    """
    L, normal = np.zeros(y.shape), np.zeros((*y.shape, 3))
    normal[..., 0] = -1.0
    last = len(profile_z) - 1
    for i in range(y.shape[0]):
        if not profile_z[0] <= z[i] <= profile_z[last]:
            continue
        p = 0
        while p < last - 1 and z[i] >= profile_z[p + 1]:
            p += 1
        slope = (profile_r[p + 1] - profile_r[p]) / (profile_z[p + 1] - profile_z[p])
        r = profile_r[p] + slope * (z[i] - profile_z[p])
        length = sqrt(1.0 + slope**2)
        for k in range(y.shape[1]):
            across = y[i, k] if revolved else 0.0
            if across * across < r * r:
                face = -sqrt(r * r - across * across) if revolved else -r
                L[i, k] = max(x[i] - face, 0.0)
                normal[i, k, 0] = (face / r if revolved else -1.0) / length
                normal[i, k, 1] = across / r / length if revolved else 0.0
                normal[i, k, 2] = -slope / length
    return L, normal


@dataclass(frozen=True)
class Structure:
    """A body of revolution (``revolved``) or a plane slope. ``profile`` holds (z, r) points, z ascending [m].

    For a plane slope ``r`` is the distance of the face ahead of the y-z plane: x = -r(z), negative r allowed.
    """

    profile: tuple[tuple[float, float], ...]
    revolved: bool = True

    def __post_init__(self) -> None:
        z, r = np.array(self.profile, dtype=np.float64).reshape(-1, 2).T
        if len(z) < 2 or not (np.isfinite(z).all() and np.isfinite(r).all()) or (np.diff(z) <= 0).any():
            raise ValueError(f"profile {self.profile} needs two or more (z, r) points with z ascending; sort it by z")
        if self.revolved and (r.min() < 0 or r.max() <= 0):
            raise ValueError(f"profile has radius {r.min():g} m; a body of revolution needs r >= 0, raise it")

    @cached_property
    def z(self) -> Array:
        """Heights of the profile points, ascending [m]."""
        return np.array([p[0] for p in self.profile])

    @cached_property
    def r(self) -> Array:
        """Radii of the profile points [m]."""
        return np.array([p[1] for p in self.profile])

    @property
    def bottom(self) -> float:
        """Lowest point of the structure [m]."""
        return float(self.profile[0][0])

    @property
    def top(self) -> float:
        """Highest point of the structure [m]."""
        return float(self.profile[-1][0])

    @property
    def faces_down(self) -> bool:
        """Whether the face at the waterline bends ice downwards; the other way it lifts the ice."""
        return bool(self._slope(np.zeros(1))[0] > 0.0)

    def radius(self, z: ArrayLike) -> Array:
        """r(z) [m]; nan above the top and below the toe."""
        return np.interp(np.asarray(z, dtype=np.float64), self.z, self.r, left=np.nan, right=np.nan)

    def face_x(self, y: ArrayLike, z: ArrayLike) -> Array:
        """X of the front face in the plane y at height z [m]; nan where the plane misses the structure."""
        r = self.radius(z)
        if not self.revolved:
            return -r + 0.0 * np.asarray(y, dtype=np.float64)
        square = r * r - np.square(np.asarray(y, dtype=np.float64))
        return -np.sqrt(np.where(square >= 0, square, np.nan))

    def lateral_ratio(self, y: ArrayLike, x: ArrayLike, z: ArrayLike) -> Array:
        """Fy / Fx of the normal force at a point of the face: y / x, since the normal passes through the axis."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64))
        if not self.revolved:
            return np.zeros(x.shape)
        return np.divide(y, x, out=np.full(x.shape, np.nan), where=x != 0)

    def normal(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Outward unit normal (..., 3) of the front face in the plane y at height z; nan where there is no face."""
        y, z = np.broadcast_arrays(np.asarray(y, dtype=np.float64), np.asarray(z, dtype=np.float64))
        r, slope = self.radius(z), self._slope(z)
        x = self.face_x(y, z)
        radial = np.stack([x / r, y / r], -1) if self.revolved else np.stack([-1.0 + 0 * r, 0 * r], -1)
        return np.concatenate([radial, -slope[..., None]], -1) / np.sqrt(1 + slope**2)[..., None]

    def _slope(self, z: Array) -> Array:
        """dr/dz; at a corner of the profile that of the piece above."""
        piece = np.clip(np.searchsorted(self.z, z, side="right") - 1, 0, len(self.z) - 2)
        return (np.diff(self.r) / np.diff(self.z))[piece]

    def section_outline(self, y: float, z_lo: float, z_hi: float, tolerance: float = 0.01) -> Array:
        """Front face in the plane y from z_lo up to z_hi as a polyline (k, 2) of (x, z), z ascending.

        Points lie on the face; no chord is farther from it than ``tolerance`` [m]. Empty (0, 2) if the plane misses.
        """
        if not tolerance > 0:
            raise ValueError(f"tolerance of a section outline is {tolerance:g} m; it must be > 0, for example 0.01")
        points: list[Array] = []
        for (z0, r0), (z1, r1) in zip(self.profile[:-1], self.profile[1:], strict=True):
            a, b = max(z0, z_lo), min(z1, z_hi)
            if a < b:
                points += _piece(y if self.revolved else 0.0, z0, r0, (r1 - r0) / (z1 - z0), a, b, tolerance)
        return _distinct(points)


def _piece(y: float, z0: float, r0: float, slope: float, a: float, b: float, tolerance: float) -> list[Array]:
    """Points of x = -sqrt(r^2 - y^2), r = r0 + slope (z - z0), between the heights a and b.

    With r = |y| cosh(t) the cut is the hyperbola x = -|y| sinh(t): even steps in t follow it well where it bends.
    """
    ra, rb = r0 + slope * (a - z0), r0 + slope * (b - z0)
    if max(ra, rb) <= abs(y) and y != 0.0:
        return []
    if slope == 0.0 or y == 0.0:
        x = -sqrt(max(ra * ra - y * y, 0.0)), -sqrt(max(rb * rb - y * y, 0.0))
        return [np.array([_signed(x[0], ra, y), a]), np.array([_signed(x[1], rb, y), b])]
    ta, tb = (float(np.arccosh(max(r / abs(y), 1.0))) for r in (ra, rb))
    n = _steps(abs(y), 1 / slope, min(ta, tb), max(ta, tb), tolerance)
    t = np.linspace(ta, tb, n + 1)
    z = z0 + (abs(y) * np.cosh(t) - r0) / slope
    z[0], z[-1] = max(z[0], a), min(z[-1], b)
    return list(np.stack([-abs(y) * np.sinh(t), z], -1))


def _signed(x: float, r: float, y: float) -> float:
    return -r if y == 0.0 else x


def _steps(y: float, cot: float, t0: float, t1: float, tolerance: float) -> int:
    """Number of even steps in t whose chords stay within ``tolerance``: sagitta <= |curve''| dt^2 / 8."""
    bend = y * sqrt(np.sinh(t1) ** 2 + (cot * np.cosh(t1)) ** 2)
    return max(1, int(np.ceil((t1 - t0) * sqrt(bend / (8 * tolerance)))))


def _distinct(points: list[Array]) -> Array:
    kept: list[Array] = []
    for p in points:
        if not kept or np.abs(p - kept[-1]).max() > 1e-9:
            kept.append(p)
    return np.array(kept, dtype=np.float64).reshape(-1, 2)


def cone(
    slope_rad: float,
    waterline_radius: float,
    neck_radius: float | None = None,
    *,
    top: float = 5.0,
    toe_depth: float | None = None,
    breaking: str = "downward",
) -> Structure:
    """A cone with slope ``slope_rad`` from the horizontal and radius ``waterline_radius`` at z = 0.

    ``downward``: narrows with depth, r = R + z / tan(slope), down to the neck, a vertical cylinder that ends at
    ``toe_depth`` (without a value it stands on the sea bed). Without a neck the cone ends at its tip or at the toe.
    ``upward``: narrows with height, r = R - z / tan(slope), up to the neck; ``toe_depth`` is the cone's lower rim.
    """
    run = 1 / _checked_tan(slope_rad)
    neck = _checked_neck(neck_radius, waterline_radius)
    if top <= 0:
        raise ValueError(f"top of the structure is {top:g} m, below the waterline; give a height > 0")
    if toe_depth is not None and toe_depth <= 0:
        raise ValueError(f"toe depth is {toe_depth:g} m, so the toe lies above the waterline; give a depth > 0")
    reach = (waterline_radius - neck) / run  # distance of the neck from the waterline
    if breaking == "downward":
        toe = toe_depth if toe_depth is not None else (reach if neck_radius is None else DEEP)
        return Structure(_cut([(-DEEP - reach, neck), (-reach, neck), (top, waterline_radius + top * run)], -toe, top))
    if breaking == "upward":
        if toe_depth is None:
            raise ValueError("an upward-breaking cone widens with depth and needs toe_depth; give the depth of its rim")
        rim = (-toe_depth, waterline_radius + toe_depth * run)
        return Structure(_cut([rim, (reach, neck), (reach + DEEP, neck)], -toe_depth, top))
    raise ValueError(f"breaking is '{breaking}'; choose 'downward' or 'upward'")


def plane_slope(
    slope_rad: float, *, top: float = 5.0, toe_depth: float = DEEP, breaking: str = "downward"
) -> Structure:
    """A slope of infinite width through the waterline at x = 0: x = -z / tan(slope), or +z / tan(slope) if upward."""
    if breaking not in ("downward", "upward"):
        raise ValueError(f"breaking is '{breaking}'; choose 'downward' or 'upward'")
    if top <= 0 or toe_depth <= 0:
        raise ValueError(f"slope from {-toe_depth:g} m to {top:g} m misses the waterline; give top and toe_depth > 0")
    run = (1 if breaking == "downward" else -1) / _checked_tan(slope_rad)
    return Structure(((-toe_depth, -toe_depth * run), (top, top * run)), revolved=False)


def _checked_tan(slope_rad: float) -> float:
    if not (isfinite(slope_rad) and 0 < slope_rad < pi / 2):
        raise ValueError(f"slope is {slope_rad * 180 / pi:g} deg; it must lie between 0 and 90 deg from the horizontal")
    return tan(slope_rad)


def _checked_neck(neck_radius: float | None, waterline_radius: float) -> float:
    if not waterline_radius > 0:
        raise ValueError(f"waterline radius is {waterline_radius:g} m; it must be > 0")
    if neck_radius is not None and not 0 < neck_radius < waterline_radius:
        raise ValueError(
            f"neck radius is {neck_radius:g} m; it must be > 0 and below the waterline radius {waterline_radius:g} m"
        )
    return neck_radius or 0.0


def _cut(points: list[tuple[float, float]], z_lo: float, z_hi: float) -> tuple[tuple[float, float], ...]:
    """The part of a profile between two heights, with end points on it."""
    z, r = np.array(points).T
    if z_lo < z[0] - 1e-12 or z_hi > z[-1] + 1e-12:
        raise ValueError(f"structure reaches from {z[0]:g} to {z[-1]:g} m, not from {z_lo:g} to {z_hi:g} m")
    inner = [(float(a), float(b)) for a, b in points if z_lo < a < z_hi]
    ends = [(float(q), float(np.interp(q, z, r))) for q in (z_lo, z_hi)]
    return (ends[0], *inner, ends[1])
