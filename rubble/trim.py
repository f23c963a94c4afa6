"""What a block loses where it would stand inside the structure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rubble.arrays import Array, Record
from rubble.cut import Cut
from rubble.geometry import area_moments, clip, overlap_area


def cut_away(polygon: Array, cut: Cut) -> Array:
    """What is left of a convex polygon outside the structure, as one convex polygon.

    For every convex part that it overlaps, the polygon is cut along that outer edge of the body which leaves most.
    Against one straight face this is exact; against a curved face it takes the ice between tangent and face as well.
    """
    out, solids, area = polygon, cut.polygons, area_moments(polygon).area
    for _ in solids:
        if len(out) == 0 or overlap_area(out, solids) <= 1e-12 * area:
            break
        out = max((_outside(out, face) for face in cut.faces), key=lambda rest: _rank(rest, solids))
    return out if overlap_area(out, solids) <= 1e-9 * area else np.empty((0, 2))


def _outside(polygon: Array, face: Record) -> Array:
    nx, nz = face["z1"] - face["z0"], face["x0"] - face["x1"]  # outward normal of a counter-clockwise edge
    rest: Array = clip(polygon, -nx, -nz, -(nx * face["x0"] + nz * face["z0"]))
    return rest


def _rank(rest: Array, solids: Sequence[Array]) -> float:
    return float(area_moments(rest).area) - 2 * overlap_area(rest, solids)
