"""The profile r(z) of a structure: piecewise linear, as many slopes as one likes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from coupling.compiled import compiled
from coupling.interface.units import Array


@dataclass(frozen=True)
class Profile:
    """Points (z, r), z ascending [m]."""

    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        z, r = np.array(self.points, dtype=np.float64).reshape(-1, 2).T
        if len(z) < 2 or not (np.isfinite(z).all() and np.isfinite(r).all()) or (np.diff(z) <= 0).any():
            raise ValueError(f"profile {self.points} needs two or more (z, r) points with z ascending; sort it by z")

    def check_radius(self) -> None:
        """Refuses a profile that is none of a body about the z axis."""
        if self.r.min() < 0 or self.r.max() <= 0:
            raise ValueError(f"profile has radius {self.r.min():g} m; a body about the z axis needs r >= 0, raise it")

    @cached_property
    def z(self) -> Array:
        """Heights of the points, ascending (n,) [m]."""
        return np.array([p[0] for p in self.points])

    @cached_property
    def r(self) -> Array:
        """Radii of the points (n,) [m]."""
        return np.array([p[1] for p in self.points])

    @cached_property
    def slopes(self) -> Array:
        """dr/dz of the pieces between the points (n - 1,)."""
        return np.asarray(np.diff(self.r) / np.diff(self.z))

    @property
    def bottom(self) -> float:
        """Lowest point [m]."""
        return float(self.points[0][0])

    @property
    def top(self) -> float:
        """Highest point [m]."""
        return float(self.points[-1][0])

    def radius(self, z: ArrayLike) -> Array:
        """r(z) [m]; nan above the top and below the toe."""
        return np.interp(np.asarray(z, dtype=np.float64), self.z, self.r, left=np.nan, right=np.nan)

    def slope(self, z: Array) -> Array:
        """dr/dz; at a corner that of the piece above, beyond the ends that of the end."""
        piece = np.clip(np.searchsorted(self.z, z, side="right") - 1, 0, len(self.z) - 2)
        return np.asarray(self.slopes[piece])

    def pieces(self, z_lo: float, z_hi: float) -> Iterator[tuple[float, float, float, float, float]]:
        """Straight pieces between two heights: start (z0, r0) and slope of each, heights a < b that are inside."""
        for (z0, r0), (z1, r1) in zip(self.points[:-1], self.points[1:], strict=True):
            a, b = max(z0, z_lo), min(z1, z_hi)
            if a < b:
                yield z0, r0, (r1 - r0) / (z1 - z0), a, b

    def drawn(self, sea_bed: float = -40.0) -> tuple[Array, Array]:
        """Heights and radii of the points, cut off at the depth to which a picture goes [m]."""
        z = self.z.copy()
        z[0] = max(z[0], sea_bed)
        return z, self.radius(z)


@dataclass(frozen=True)
class Profiled:
    """A surface with the same profile all along its face: what `Structure` asks for and the profile alone answers."""

    profile: Profile

    @property
    def bottom(self) -> float:
        """Lowest point [m]."""
        return self.profile.bottom

    @property
    def top(self) -> float:
        """Highest point [m]."""
        return self.profile.top

    @property
    def faces_down(self) -> bool:
        """Whether the face at the waterline bends ice downwards: it widens upwards."""
        return bool(self.profile.slope(np.zeros(1))[0] > 0.0)

    def generator(self, z_lo: float, z_hi: float) -> Array | None:  # noqa: ARG002 - of one that is turned
        """None: what has a profile is not yet a body of revolution."""
        return None

    def normal_z(self, z: Array) -> Array:
        """n_z of the face at heights z."""
        slope = self.profile.slope(z)
        return np.asarray(-slope / np.sqrt(1.0 + slope**2))


@compiled()
def piece_at(z: float, profile_z: Array, profile_r: Array) -> tuple[float, float]:
    """Radius and slope dr/dz of a profile at a height inside it."""
    last, p = len(profile_z) - 1, 0
    while p < last - 1 and z >= profile_z[p + 1]:
        p += 1
    slope = (profile_r[p + 1] - profile_r[p]) / (profile_z[p + 1] - profile_z[p])
    return profile_r[p] + slope * (z - profile_z[p]), slope


def polyline(points: Sequence[Array]) -> Array:
    """Points (2,) as (n, 2), each once: what is nearer than a billionth of the largest coordinate is one."""
    kept: list[Array] = []
    same = 1e-9 * max((float(np.abs(p).max()) for p in points), default=0.0)
    for p in points:
        if not kept or np.abs(p - kept[-1]).max() > same:
            kept.append(p)
    return np.array(kept, dtype=np.float64).reshape(-1, 2)


def checked(tolerance: float) -> float:
    """The tolerance of a section, if it is one."""
    if not tolerance > 0:
        raise ValueError(f"tolerance of a section outline is {tolerance:g} m; it must be > 0, for example 0.01")
    return tolerance
