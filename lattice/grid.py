"""The square mesh of particles (nodes) and cells."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Grid:
    """nx x ny nodes at distance d; node (i, j) has number ``i * ny + j`` and lies at ``(x0 + i d, y0 + j d)``."""

    nx: int
    ny: int
    d: float  #: cell size [m]
    x0: float = 0.0  #: [m]
    y0: float = 0.0  #: [m]

    def __post_init__(self) -> None:
        if self.nx < 2 or self.ny < 2:
            raise ValueError(f"a lattice of {self.nx} x {self.ny} nodes has no cell: use at least 2 x 2")
        if not self.d > 0.0:
            raise ValueError(f"cell size {self.d:g} m must be greater than 0")

    @classmethod
    def rectangle(cls, Lx: float, Ly: float, nx: int, ny: int, x0: float = 0.0, y0: float = 0.0) -> Grid:
        """Mesh of an Lx x Ly plate; the cells must come out square (to 1e-6)."""
        if nx < 2 or ny < 2:
            raise ValueError(f"a lattice of {nx} x {ny} nodes has no cell: use at least 2 x 2")
        dx, dy = Lx / (nx - 1), Ly / (ny - 1)
        if abs(dx - dy) > 1e-6 * dx:
            raise ValueError(
                f"{nx} x {ny} nodes on {Lx:g} m x {Ly:g} m give cells of {dx:g} m x {dy:g} m: "
                f"cells must be square, for example {nx} x {round(Ly / dx) + 1} nodes"
            )
        return cls(nx, ny, dx, x0, y0)

    @property
    def nodes(self) -> int:
        """How many."""
        return self.nx * self.ny

    @property
    def cells(self) -> int:
        """How many."""
        return (self.nx - 1) * (self.ny - 1)

    @cached_property
    def xy(self) -> Array:
        """Node positions, (nodes, 2) [m]."""
        i, j = np.divmod(np.arange(self.nodes), self.ny)
        return np.column_stack((self.x0 + i * self.d, self.y0 + j * self.d))

    @cached_property
    def cell_nodes(self) -> IntArray:
        """(cells, 4): nodes (i, j), (i+1, j), (i, j+1), (i+1, j+1) of cell ``i * (ny - 1) + j``."""
        i, j = np.divmod(np.arange(self.cells), self.ny - 1)
        n = i * self.ny + j
        return np.column_stack((n, n + self.ny, n + 1, n + self.ny + 1)).astype(np.int64)

    @cached_property
    def area(self) -> Array:
        """Tributary area of each node: d^2 inside, 1/2 at an edge, 1/4 at a corner, (nodes,) [m2]."""
        return np.asarray(np.bincount(self.cell_nodes.ravel(), minlength=self.nodes) * (self.d**2 / 4.0), np.float64)

    def node(self, i: int, j: int) -> int:
        """Number of the node in row i (along x) and column j (along y)."""
        return i * self.ny + j

    def edge_nodes(self, side: str) -> IntArray:
        """Nodes of the edge ``x-``, ``x+``, ``y-`` or ``y+``."""
        n = np.arange(self.nodes).reshape(self.nx, self.ny)
        edges: dict[str, IntArray] = {"x-": n[0], "x+": n[-1], "y-": n[:, 0], "y+": n[:, -1]}
        return edges[side].copy()
