"""Structures from the numbers by which people know them."""

from __future__ import annotations

from math import isfinite, pi, tan

import numpy as np

from coupling.structure.multi_sided import MultiSidedCone
from coupling.structure.plane import PlaneSlope
from coupling.structure.profile import Profile
from coupling.structure.revolved import Revolved

DEEP = 1000.0  #: depth of a structure that stands on the sea bed, out of reach of any ice [m]


def cone(
    slope_rad: float,
    waterline_radius: float,
    neck_radius: float | None = None,
    *,
    top: float = 5.0,
    toe_depth: float | None = None,
    breaking: str = "downward",
) -> Revolved:
    """A cone with slope ``slope_rad`` from the horizontal and radius ``waterline_radius`` at z = 0.

    ``downward``: narrows with depth, r = R + z / tan(slope), down to the neck, a vertical cylinder that ends at
    ``toe_depth`` (without a value it stands on the sea bed). Without a neck the cone ends at its tip or at the toe.
    ``upward``: narrows with height, r = R - z / tan(slope), up to the neck; ``toe_depth`` is the cone's lower rim.
    """
    return Revolved(_cone_profile(slope_rad, waterline_radius, neck_radius, top, toe_depth, breaking))


def multi_sided_cone(
    sides: int,
    slope_rad: float,
    waterline_radius: float,
    neck_radius: float | None = None,
    *,
    orientation: float = 0.0,
    top: float = 5.0,
    toe_depth: float | None = None,
    breaking: str = "downward",
) -> MultiSidedCone:
    """As `cone`, with flat ``sides``; radii are distances of the facets from the axis, half the width across flats.

    ``orientation`` [rad]: 0 puts a facet squarely to the ice, pi / sides a corner.
    """
    profile = _cone_profile(slope_rad, waterline_radius, neck_radius, top, toe_depth, breaking)
    return MultiSidedCone(profile, sides, orientation)


def plane_slope(
    slope_rad: float, *, top: float = 5.0, toe_depth: float = DEEP, breaking: str = "downward"
) -> PlaneSlope:
    """A slope of infinite width through the waterline at x = 0: x = -z / tan(slope), or +z / tan(slope) if upward."""
    if breaking not in ("downward", "upward"):
        raise ValueError(f"breaking is '{breaking}'; choose 'downward' or 'upward'")
    if top <= 0 or toe_depth <= 0:
        raise ValueError(f"slope from {-toe_depth:g} m to {top:g} m misses the waterline; give top and toe_depth > 0")
    cot = (1 if breaking == "downward" else -1) / _checked_tan(slope_rad)
    return PlaneSlope(Profile(((-toe_depth, -toe_depth * cot), (top, top * cot))))


def _cone_profile(
    slope_rad: float,
    waterline_radius: float,
    neck_radius: float | None,
    top: float,
    toe_depth: float | None,
    breaking: str,
) -> Profile:
    """Profile of `cone`."""
    cot = 1 / _checked_tan(slope_rad)
    neck = _checked_neck(neck_radius, waterline_radius)
    if top <= 0:
        raise ValueError(f"top of the structure is {top:g} m, below the waterline; give a height > 0")
    if toe_depth is not None and toe_depth <= 0:
        raise ValueError(f"toe depth is {toe_depth:g} m, so the toe lies above the waterline; give a depth > 0")
    reach = (waterline_radius - neck) / cot  # distance of the neck from the waterline
    if breaking == "downward":
        toe = toe_depth if toe_depth is not None else (reach if neck_radius is None else DEEP)
        return Profile(_cut([(-DEEP - reach, neck), (-reach, neck), (top, waterline_radius + top * cot)], -toe, top))
    if breaking == "upward":
        if toe_depth is None:
            raise ValueError("an upward-breaking cone widens with depth and needs toe_depth; give the depth of its rim")
        rim = (-toe_depth, waterline_radius + toe_depth * cot)
        return Profile(_cut([rim, (reach, neck), (reach + DEEP, neck)], -toe_depth, top))
    raise ValueError(f"breaking is '{breaking}'; choose 'downward' or 'upward'")


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
