"""Triangles of a surface that is given on a grid of points."""

from __future__ import annotations

import numpy as np

from coupling.interface.units import Array, IntArray


def triangles(points: Array) -> tuple[Array, IntArray]:
    """Points (rows, columns, 3) as (p, 3), and two triangles for each mesh of the grid (t, 3)."""
    rows, columns = points.shape[:2]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    a = (i * columns + j).ravel()
    corners = np.concatenate(
        (np.column_stack((a, a + 1, a + columns)), np.column_stack((a + 1, a + columns + 1, a + columns)))
    )
    return points.reshape(-1, 3), corners.astype(np.int64)
