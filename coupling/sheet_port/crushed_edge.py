"""The edge of the sheet: which nodes meet the structure, and how much of their ice has been crushed.

Per node column the ice in front is cut along the face of the structure. The depth of the cut only grows while the
same row is in front; when the row has left the lattice the next one starts uncut. Crushed ice leaves the node's mass.
"""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, IntArray


class CrushedEdge:
    """Cut depth per column; rows are counted along x, the front is the largest row present."""

    def __init__(self, shape: tuple[int, int], d: float, thickness: float, tan: Array):
        """``shape`` nodes along x and y, ``tan`` (ny,) steepness of the structure's face in each column's plane."""
        self.nx, self.ny = shape
        self.d, self.h, self.tan = d, thickness, tan
        self.depth = np.zeros(self.ny)  #: of the cut at the touching face, from the front of the ice [m]
        self.front = np.full(self.ny, self.nx - 1)
        self.width = np.full(self.ny, d)
        self.width[[0, -1]] = 0.5 * d

    def lead(self, row: IntArray) -> Array:
        """Ice ahead of a node: half a cell inside the sheet, none at its first edge [m]."""
        return np.asarray(np.where(row == self.nx - 1, 0.0, 0.5 * self.d), np.float64)

    def length(self, row: IntArray) -> Array:
        """Extent of a node's ice along x [m]."""
        return np.where((row == self.nx - 1) | (row == 0), 0.5 * self.d, self.d)

    def set_front(self, front: IntArray) -> None:
        """New foremost rows (-1: none); a column whose front has changed starts uncut."""
        self.depth[front != self.front] = 0.0
        self.front = front.copy()

    def crush(self, column: IntArray, depth: Array) -> None:
        """Deepens the cut to a depth given at points across each column (m, samples), keeping the mean cut area."""
        depth = np.sqrt(np.mean(depth**2, axis=1))
        self.depth[column] = np.maximum(self.depth[column], depth)

    def cut(self, row: IntArray, column: IntArray) -> Array:
        """Depth of the cut measured from the front of the node's own ice [m]."""
        first = np.where(
            self.front[column] == self.nx - 1, (self.nx - 1) * self.d, self.front[column] * self.d + 0.5 * self.d
        )
        ahead = first - (row * self.d + self.lead(row))
        return np.maximum(self.depth[column] - ahead, 0.0)

    def crushed_area(self, row: IntArray, column: IntArray) -> Array:
        """Area cut out of each node's ice in the x-z plane [m2]."""
        cut, tan = self.cut(row, column), self.tan[column]
        return self._area(cut, tan) - self._area(np.maximum(cut - self.length(row), 0.0), tan)

    def _area(self, cut: Array, tan: Array) -> Array:
        triangle, full = 0.5 * cut**2 * tan, self.h * cut - 0.5 * self.h**2 / tan
        return np.where(cut * tan < self.h, triangle, full)

    def spent(self) -> IntArray:
        """Columns whose foremost node has no ice left."""
        row = np.maximum(self.front, 0)
        column = np.arange(self.ny)
        gone = self.cut(row, column) >= self.length(row) + self.h / self.tan
        return np.flatnonzero(gone & (self.front >= 0))
