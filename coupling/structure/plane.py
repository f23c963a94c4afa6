"""A slope of infinite width across the drift."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np
from numpy.typing import ArrayLike

from coupling.compiled import compiled
from coupling.interface.units import Array, IntArray
from coupling.structure.mesh import triangles
from coupling.structure.profile import Profiled, checked, piece_at, polyline

#: of the solid behind the rearmost point of the face, in heights of the face: more than any block can pass through
THICK = 8.0


@compiled()
def overlap_of_plane(x: Array, y: Array, z: Array, profile_z: Array, profile_r: Array) -> tuple[Array, Array]:
    """`Structure.overlap` of a face x = -r(z)."""
    L, normal = np.zeros(y.shape), np.zeros((*y.shape, 3))
    normal[..., 0] = -1.0
    for i in range(y.shape[0]):
        if not profile_z[0] <= z[i] <= profile_z[-1]:
            continue
        r, slope = piece_at(z[i], profile_z, profile_r)
        length = sqrt(1.0 + slope**2)
        for k in range(y.shape[1]):
            L[i, k] = max(x[i] + r, 0.0)
            normal[i, k, 0] = -1.0 / length
            normal[i, k, 2] = -slope / length
    return L, normal


@dataclass(frozen=True)
class PlaneSlope(Profiled):
    """The face x = -r(z); negative r allowed."""

    @property
    def half_width(self) -> float:
        """It does not end."""
        return inf

    @property
    def reach(self) -> float:
        """The crest of a face that leans back, over which ice may ride [m]."""
        return max(float(self.face_x(0.0, self.top)), 0.0)

    def foremost_x(self, z: float) -> float:
        """-r(z) [m]."""
        return float(self.face_x(0.0, z))

    def face_x(self, y: ArrayLike, z: ArrayLike) -> Array:
        """-r(z) [m]."""
        return -self.profile.radius(z) + 0.0 * np.asarray(y, dtype=np.float64)

    def normal(self, y: ArrayLike, z: ArrayLike) -> Array:
        """Unit normal; it has no part along y."""
        y, z = np.broadcast_arrays(np.asarray(y, dtype=np.float64), np.asarray(z, dtype=np.float64))
        r, slope = self.profile.radius(z), self.profile.slope(z)
        flat = np.stack([-1.0 + 0 * r, 0 * r], -1)
        return np.asarray(np.concatenate([flat, -slope[..., None]], -1) / np.sqrt(1 + slope**2)[..., None])

    def overlap(self, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """As `Structure.overlap`."""
        L, normal = overlap_of_plane(x, y, z, self.profile.z, self.profile.r)
        return L, normal

    def section(  # all planes y cut it alike
        self,
        y: float,  # noqa: ARG002
        z_lo: float,
        z_hi: float,
        tolerance: float,
    ) -> tuple[Array, Array]:
        """The profile itself, the same in all planes, and a rear wall `THICK` behind its rearmost point."""
        checked(tolerance)
        points = []
        for z0, r0, slope, a, b in self.profile.pieces(z_lo, z_hi):
            points += [np.array([-(r0 + slope * (z - z0)), z]) for z in (a, b)]
        front = polyline(points)
        if not len(front):
            return front, front
        back = float(front[:, 0].max()) + THICK * float(front[-1, 1] - front[0, 1])
        return front, np.array([(back, front[0, 1]), (back, front[-1, 1])])

    def bearing(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """(0, 0): it presses along the drift."""
        none = np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y), np.shape(z)))
        return none, none

    def mesh(self, width: float) -> tuple[Array, IntArray]:
        """A strip ``width`` wide."""
        z, r = self.profile.drawn()
        y = np.array([-0.5 * width, 0.5 * width])
        return triangles(
            np.stack((-r[:, None] + 0.0 * y, y + 0.0 * r[:, None], z[:, None] + 0.0 * y), axis=-1)[:, ::-1]
        )
