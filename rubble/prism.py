"""A block as a prism: strips of constant width along its long axis, their inertia and their wetted edges."""

from __future__ import annotations

import numpy as np

from rubble.geometry import Array, clip, moments
from rubble.water import EDGE_COLUMNS

TOP = 0.9  #: cosine of the steepest edge that belongs to a block's top


def strips(polygon: Array, cuts: Array, widths: Array) -> list[Array]:
    """Parts of a body-frame polygon between the cuts (s + 1,) along body x, one for each of the (s,) widths."""
    parts = []
    for k in range(len(widths)):
        part = polygon if k == 0 else clip(polygon, -1.0, 0.0, -float(cuts[k]))
        parts.append(part if k == len(widths) - 1 else clip(part, 1.0, 0.0, float(cuts[k + 1])))
    return parts


def inertia(parts: list[Array], widths: Array) -> tuple[float, float, float, float]:
    """Volume [m^3], centre x and z [m], and second moment of volume about the centre [m^5] of strips with widths."""
    m = np.array([moments(p) for p in parts])
    volume = m[:, 0] * widths
    total = float(volume.sum())
    x, z = float(volume @ m[:, 1]) / total, float(volume @ m[:, 2]) / total
    polar = m[:, 3] * widths + volume * ((m[:, 1] - x) ** 2 + (m[:, 2] - z) ** 2)
    return total, x, z, float(polar.sum())


def wetted_edges(parts: list[Array], cuts: Array, widths: Array) -> Array:
    """Edge table (e, 8) of a block of strips: outer edges with their strip's width, steps with the difference.

    A face at a cut appears in both strips with opposite directions; keeping it with both widths is the step.
    """
    rows = []
    for k, part in enumerate(parts):
        for a, b in zip(part, np.roll(part, -1, axis=0), strict=True):
            neighbour = _beyond_cut(a[0], b[0], cuts, k, len(parts))
            width = widths[k] - (0.0 if neighbour is None else min(widths[k], widths[neighbour]))
            if width > 0:
                top = neighbour is None and a[0] - b[0] > TOP * np.hypot(*(b - a))
                rows.append((a[0], a[1], b[0], b[1], width, float(top), *((b - a) / max(np.hypot(*(b - a)), 1e-300))))
    return np.array(rows, dtype=np.float64).reshape(-1, EDGE_COLUMNS)


def _beyond_cut(xa: float, xb: float, cuts: Array, k: int, count: int) -> int | None:
    """Number of the strip on the other side of an edge that lies on a cut; None for an outer edge."""
    for cut, other in ((k, k - 1), (k + 1, k + 1)):
        if 0 <= other < count and abs(xa - cuts[cut]) < 1e-12 and abs(xb - cuts[cut]) < 1e-12:
            return other
    return None
