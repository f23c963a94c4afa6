"""A cone with flat sides: n facets about the z axis, at the distance r(z) from it.

Facet i has the horizontal bearing psi_i of its outward normal and is the plane ``x cos psi + y sin psi = r(z)``; inside
is where this sum is smaller for all facets. At height z the cut is a regular polygon with corners at r / cos(pi / n)
between the facets. In a plane y the front is the rearmost of the facets that face the ice (cos psi < 0), the rear the
foremost of the others, all of them straight in z: every section is exact, and convex along each piece of the profile.

With many facets it is the body of revolution with the same profile, up to corners that stick out by r (pi / n)^2 / 2.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos, inf, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from coupling.compiled import compiled
from coupling.interface.units import Array, IntArray
from coupling.structure.mesh import triangles
from coupling.structure.profile import Profiled, checked, piece_at, polyline

ALONG = 1e-12  #: |cos psi| below which a facet stands along the drift and is neither front nor rear


@compiled()
def front_facet(y: float, r: float, cos_psi: Array, sin_psi: Array) -> tuple[float, int]:
    """Front at y, along x, where the facets are r from the axis, and its facet; -1 where a line along x misses."""
    front, rear, facet, beside = -np.inf, np.inf, -1, False
    for i in range(len(cos_psi)):
        if abs(cos_psi[i]) < ALONG:
            beside = beside or y * sin_psi[i] > r
            continue
        x = (r - y * sin_psi[i]) / cos_psi[i]
        if cos_psi[i] > 0.0:
            rear = min(rear, x)
        elif x > front:
            front, facet = x, i
    return front, (-1 if beside or front > rear else facet)


@compiled()
def overlap_of_facets(
    x: Array, y: Array, z: Array, profile_z: Array, profile_r: Array, cos_psi: Array, sin_psi: Array
) -> tuple[Array, Array]:
    """`Structure.overlap` of a multi-sided cone."""
    L, normal = np.zeros(y.shape), np.zeros((*y.shape, 3))
    normal[..., 0] = -1.0
    for i in range(y.shape[0]):
        if not profile_z[0] <= z[i] <= profile_z[-1]:
            continue
        r, slope = piece_at(z[i], profile_z, profile_r)
        length = sqrt(1.0 + slope**2)
        for k in range(y.shape[1]):
            front, facet = front_facet(y[i, k], r, cos_psi, sin_psi)
            if facet >= 0:
                L[i, k] = max(x[i] - front, 0.0)
                normal[i, k, 0] = cos_psi[facet] / length
                normal[i, k, 1] = sin_psi[facet] / length
                normal[i, k, 2] = -slope / length
    return L, normal


@dataclass(frozen=True)
class MultiSidedCone(Profiled):
    """``sides`` facets; with ``orientation`` 0 one faces the ice squarely, pi / sides turns a corner to it [rad]."""

    sides: int
    orientation: float = 0.0

    def __post_init__(self) -> None:
        self.profile.check_radius()
        if self.sides < 3:
            raise ValueError(f"a multi-sided cone of {self.sides} sides; give at least 3")
        if not np.isfinite(self.orientation):
            raise ValueError(f"orientation of the multi-sided cone is {self.orientation}; give an angle")

    @cached_property
    def psi(self) -> Array:
        """Bearings of the facets' outward normals in the plan, from x towards y (n,) [rad]."""
        return np.pi + self.orientation + 2.0 * np.pi * np.arange(self.sides) / self.sides

    @cached_property
    def _facets(self) -> tuple[Array, Array]:
        return np.cos(self.psi), np.sin(self.psi)

    @cached_property
    def _corners(self) -> tuple[Array, Array]:
        """Places x, y of the corners where facets are 1 m from the axis, (n,) each [m]."""
        mid = self.psi + pi / self.sides
        return np.cos(mid) / cos(pi / self.sides), np.sin(mid) / cos(pi / self.sides)

    @property
    def half_width(self) -> float:
        """Of the polygon at the waterline [m]."""
        return float(self.profile.radius(0.0) * np.abs(self._corners[1]).max())

    @property
    def reach(self) -> float:
        """The axis, where the body is widest: what has come so far goes on by itself [m]."""
        return 0.0

    def foremost_x(self, z: float) -> float:
        """Of the foremost corner [m]."""
        return float(self.profile.radius(z) * self._corners[0].min())

    def _front(self, y: ArrayLike, z: ArrayLike) -> tuple[Array, IntArray]:
        """Front along x and its facet, -1 where there is none."""
        y, r = np.broadcast_arrays(np.asarray(y, dtype=np.float64), self.profile.radius(z))
        found = [front_facet(a, b, *self._facets) for a, b in zip(y.ravel().tolist(), r.ravel().tolist(), strict=True)]
        x, facet = (np.array([f[k] for f in found]).reshape(y.shape) for k in range(2))
        return x, np.where(np.isfinite(r), facet, -1).astype(np.int64)

    def face_x(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Of the rearmost facet that faces the ice [m]."""
        x, facet = self._front(y, z)
        return np.where(facet >= 0, x, np.nan)

    def normal(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Unit normal of the facet that is in front."""
        _, facet = self._front(y, z)
        slope = self.profile.slope(np.broadcast_to(np.asarray(z, dtype=np.float64), facet.shape))
        c, s = self._facets
        n = np.stack([c[facet], s[facet], -slope], -1) / np.sqrt(1.0 + slope**2)[..., None]
        return np.where(facet[..., None] >= 0, n, np.nan)

    def overlap(self, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """As `Structure.overlap`."""
        L, normal = overlap_of_facets(x, y, z, self.profile.z, self.profile.r, *self._facets)
        return L, normal

    def section(self, y: float, z_lo: float, z_hi: float, tolerance: float) -> tuple[Array, Array]:
        """Exact: corners where the plane passes from one facet to the next."""
        checked(tolerance)
        front: list[Array] = []
        rear: list[Array] = []
        for z0, r0, slope, a, b in self.profile.pieces(z_lo, z_hi):
            ends = r0 + slope * (a - z0), r0 + slope * (b - z0)
            least = self._least_radius(y)
            if max(ends) <= least:
                continue
            low, high = max(min(ends), least), max(ends)
            for side, points in ((-1.0, front), (1.0, rear)):
                r = self._turns(y, low, high, side)
                z = np.array([a, b]) if slope == 0.0 else z0 + (r - r0) / slope
                x = self._side_x(y, r if slope != 0.0 else np.full(2, r0), side)
                order = np.argsort(z, kind="stable")
                points += list(np.column_stack((x, np.clip(z, a, b)))[order])
        return polyline(front), polyline(rear)

    def _least_radius(self, y: float) -> float:
        """Distance of the facets from the axis from which on the plane y meets the polygon [m]."""
        extent = float((self._corners[1] * np.sign(y)).max())
        return abs(y) / extent if y != 0.0 else 0.0

    def _turns(self, y: float, low: float, high: float, side: float) -> Array:
        """Radii from low to high at which the front (side -1) or rear (+1) in the plane y begins, turns and ends."""
        x, corner = self._corners
        with np.errstate(divide="ignore", invalid="ignore"):
            r = np.where((x * side > ALONG) & (np.abs(corner) > ALONG), y / corner, inf)
        return np.array([low, *np.sort(r[(r > low) & (r < high)]).tolist(), high])

    def _side_x(self, y: float, r: Array, side: float) -> Array:
        """Place along x of the front (side -1) or rear (+1) where the facets are r (k,) from the axis, (k,) [m]."""
        c, s = self._facets
        on = c * side > ALONG
        x = (r[:, None] - y * s[on]) / c[on]
        return np.asarray(side * (side * x).min(axis=1))

    def bearing(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """(tan psi, 0) of the facet on which a point lies, or to which it is next."""
        x, y, _ = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in (x, y, z)))
        c, s = self._facets
        facet = np.argmax(x[..., None] * c + y[..., None] * s, axis=-1)
        return np.asarray(s[facet] / c[facet]), np.zeros(x.shape)

    def mesh(self, width: float) -> tuple[Array, IntArray]:  # noqa: ARG002 - it ends by itself
        """The whole surface."""
        z, r = self.profile.drawn()
        x, y = (np.append(a, a[0]) for a in self._corners)
        return triangles(np.stack((r[:, None] * x, r[:, None] * y, z[:, None] + 0.0 * x), axis=-1))
