"""A body of revolution about the z axis.

The plane y cuts the profile r(z) along ``x = -sqrt(r(z)^2 - y^2)`` on the side from which the ice comes (x < 0). The
in-plane normal of that curve is the projection of the surface normal, so a contact force in the plane gives the true
Fx and Fz.

Side force: the ice presses along -n, and n of a body of revolution lies in the plane through the axis, so
``Fy / Fx = n_y / n_x = y / x``. On the front (x < 0) at y > 0 the structure is pushed towards -y, the ice towards +y:
ice clears away from the middle.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike

from coupling.compiled import compiled
from coupling.interface.units import Array, IntArray
from coupling.structure.mesh import triangles
from coupling.structure.profile import Profiled, checked, piece_at, polyline

AROUND = 96  #: sides of the picture


@compiled()
def overlap_of_body(x: Array, y: Array, z: Array, profile_z: Array, profile_r: Array) -> tuple[Array, Array]:
    """`Structure.overlap` of a body of revolution; ice behind the axis has passed the face."""
    L, normal = np.zeros(y.shape), np.zeros((*y.shape, 3))
    normal[..., 0] = -1.0
    for i in range(y.shape[0]):
        if x[i] >= 0.0 or not profile_z[0] <= z[i] <= profile_z[-1]:
            continue
        r, slope = piece_at(z[i], profile_z, profile_r)
        length = sqrt(1.0 + slope**2)
        for k in range(y.shape[1]):
            if y[i, k] * y[i, k] < r * r:
                face = -sqrt(r * r - y[i, k] * y[i, k])
                L[i, k] = max(x[i] - face, 0.0)
                normal[i, k, 0] = face / r / length
                normal[i, k, 1] = y[i, k] / r / length
                normal[i, k, 2] = -slope / length
    return L, normal


@dataclass(frozen=True)
class Revolved(Profiled):
    """The body with the radius r(z)."""

    def __post_init__(self) -> None:
        self.profile.check_radius()

    @property
    def half_width(self) -> float:
        """Radius at the waterline [m]."""
        return float(self.profile.radius(0.0))

    @property
    def reach(self) -> float:
        """The axis, where the body is widest: what has come so far goes on by itself [m]."""
        return 0.0

    def foremost_x(self, z: float) -> float:
        """-r(z) [m]."""
        return float(self.face_x(0.0, z))

    def face_x(self, y: ArrayLike, z: ArrayLike) -> Array:
        """-sqrt(r(z)^2 - y^2) [m]."""
        r = self.profile.radius(z)
        square = r * r - np.square(np.asarray(y, dtype=np.float64))
        return np.asarray(-np.sqrt(np.where(square >= 0, square, np.nan)))

    def normal(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Unit normal, in the plane through the axis."""
        y, z = np.broadcast_arrays(np.asarray(y, dtype=np.float64), np.asarray(z, dtype=np.float64))
        r, slope, x = self.profile.radius(z), self.profile.slope(z), self.face_x(y, z)
        radial = np.stack([x / r, y / r], -1)
        return np.asarray(np.concatenate([radial, -slope[..., None]], -1) / np.sqrt(1 + slope**2)[..., None])

    def overlap(self, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """As `Structure.overlap`."""
        L, normal = overlap_of_body(x, y, z, self.profile.z, self.profile.r)
        return L, normal

    def section(self, y: float, z_lo: float, z_hi: float, tolerance: float) -> tuple[Array, Array]:
        """Hyperbolas in chords, with points on the face; the rear is the mirror image of the front."""
        checked(tolerance)
        points: list[Array] = []
        for z0, r0, slope, a, b in self.profile.pieces(z_lo, z_hi):
            points += _piece(y, z0, r0, slope, a, b, tolerance)
        front = polyline(points)
        return front, front * np.array([-1.0, 1.0])

    def generator(self, z_lo: float, z_hi: float) -> Array:
        """Its profile between the heights."""
        points = [(a, r0 + k * (a - z0), b, r0 + k * (b - z0)) for z0, r0, k, a, b in self.profile.pieces(z_lo, z_hi)]
        return np.array([point[:2] for point in points] + [points[-1][2:]])

    def bearing(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """(0, 1): the normal passes through the axis."""
        shape = np.broadcast_shapes(np.shape(x), np.shape(y), np.shape(z))
        return np.zeros(shape), np.ones(shape)

    def mesh(self, width: float) -> tuple[Array, IntArray]:  # noqa: ARG002 - it ends by itself
        """The whole surface."""
        z, r = self.profile.drawn()
        angle = np.linspace(0.0, 2.0 * np.pi, AROUND + 1)
        ring = np.stack((np.cos(angle), np.sin(angle)))
        return triangles(np.stack((r[:, None] * ring[0], r[:, None] * ring[1], z[:, None] + 0.0 * ring[0]), axis=-1))


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
