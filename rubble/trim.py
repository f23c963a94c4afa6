"""What a block loses where it would stand inside the structure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rubble.geometry import Array, clip, moments, overlap_area


def cut_away(polygon: Array, solids: Sequence[Array], edges: Array) -> Array:
    """What is left of a convex polygon outside a body made of convex polygons, as one convex polygon.

    For every convex part that it overlaps, the polygon is cut along that outer edge of the body which leaves most.
    Against one straight face this is exact; against a curved face it takes the ice between tangent and face as well.
    """
    out = polygon
    for _ in solids:
        if len(out) == 0 or overlap_area(out, solids) <= 1e-12 * moments(polygon)[0]:
            break
        out = max((_outside(out, edge) for edge in edges), key=lambda rest: _rank(rest, solids))
    return out if overlap_area(out, solids) <= 1e-9 * moments(polygon)[0] else np.empty((0, 2))


def _outside(polygon: Array, edge: Array) -> Array:
    nx, nz = edge[3] - edge[1], edge[0] - edge[2]  # outward normal of a counter-clockwise edge
    return clip(polygon, -nx, -nz, -(nx * edge[0] + nz * edge[1]))


def _rank(rest: Array, solids: Sequence[Array]) -> float:
    return moments(rest)[0] - 2 * overlap_area(rest, solids)
