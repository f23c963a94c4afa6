"""Factorised system matrix that loses cells as low-rank updates.

With A the matrix at factorisation and U the scaled spring rows of the cells removed since, the present matrix is
A - U U^T and, with Z = A^-1 U and S = I - U^T Z (Woodbury),

    (A - U U^T)^-1 b = A^-1 b + Z S^-1 U^T A^-1 b.

When the rank has grown past `MAX_RANK` the matrix is factorised anew.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from lattice.assembly import CellSprings, cell_stiffness
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.implicit.factors import Factors
from lattice.memory import Memory, remember
from lattice.springs import SpringTable, spring_force

MAX_RANK = 120  #: columns of U at which a new factorisation is cheaper than carrying them (60 x 60 to 240 x 240 nodes)
MAX_AT_ONCE = 4  #: cells removed between two uses at which a new factorisation is cheaper than an update


class CrackedSystem:
    """Solves ``(scale * K(intact) + diag) x = b`` with some degrees of freedom held at zero."""

    def __init__(
        self, grid: Grid, springs: CellSprings, intact: BoolArray, diagonal: Array, scale: float, held: BoolArray
    ):
        self._grid, self._rows = grid, np.sqrt(scale) * springs.rows
        self._cell_stiffness = cell_stiffness(self._rows, springs.share)
        self._diagonal, self._held, self._springs = diagonal, held, SpringTable.of(grid, *springs)
        self._dof = self._springs.dof
        self._intact = intact.copy()
        self._pending: list[int] = []
        self._factorise()

    def _factorise(self) -> None:
        self._lu = Factors(self._grid, self._cell_stiffness, self._intact, self._diagonal, self._held)
        self._cells = np.empty(0, np.int64)  #: removed since
        self._Z = np.empty((len(self._held), 0))
        self._points = np.empty(0, np.int64)
        self._point_columns = np.empty((len(self._held), 0))

    def save(self) -> Memory:
        """What `memory.recall` sets back; factors and columns are kept by reference."""
        return remember(self, "_intact", "_pending")

    def remove(self, cells: IntArray) -> None:
        """Takes cells out of the matrix; the work is done when it is used next."""
        self._intact[cells] = False
        self._pending.extend(int(c) for c in cells)

    def _update(self) -> None:
        """Brings the solver up to date with the cells that were removed."""
        cells, self._pending = self._pending, []
        if len(cells) > MAX_AT_ONCE or self._Z.shape[1] + len(cells) * len(self._rows) > MAX_RANK:
            self._factorise()
        elif cells:
            self._Z = np.hstack((self._Z, self._lu.solve(self._spring_columns(cells))))
            self._cells = np.append(self._cells, cells)
            self._S = la.lu_factor(np.eye(self._Z.shape[1]) - self._elongation(self._Z))

    def _spring_columns(self, cells: list[int]) -> Array:
        """U of some cells, (n, rank)."""
        r = len(self._rows)
        U = np.zeros((len(self._held), r * len(cells)))
        for k, cell in enumerate(cells):
            U[self._dof[cell], k * r : (k + 1) * r] = (self._root(cell)[:, None] * self._rows).T
        U[self._held] = 0.0
        return U

    def _elongation(self, x: Array) -> Array:
        """U^T x of all removed cells, for x (n,) or (n, k) that is zero where held."""
        ends = x.reshape(len(x), -1)[self._dof[self._cells]]
        long = self._root(self._cells)[:, :, None] * (self._rows @ ends)
        return np.asarray(long.reshape(-1, *x.shape[1:]))

    def _root(self, cell: IntArray | int) -> Array:
        """Roots of the share of each spring of a cell or of cells (k,), (..., springs)."""
        return np.asarray(np.sqrt(self._springs.share[cell][..., self._springs.kind]))

    def solve(self, b: Array) -> Array:
        """X for a right side b over all degrees of freedom, held ones come back as 0, (n,)."""
        self._update()
        return self._corrected(self._lu.solve(b))

    def _corrected(self, x: Array) -> Array:
        """From a solution with the factorised matrix to one with the present matrix."""
        if len(self._cells):
            x += self._Z @ la.lu_solve(self._S, self._elongation(x), check_finite=False)
        return x

    def spring_force(self, x: Array) -> Array:
        """K x of the springs of the intact cells, (n,)."""
        return np.asarray(spring_force(self._springs, self._intact, x))

    def compliance(self, dof: IntArray) -> Array:
        """Rows and columns `dof` of the inverse, (m, m); zero for held ones."""
        self._update()
        self._keep_columns(dof)
        G: Array = self._point_columns[dof]
        if len(self._cells):
            Z = self._Z[dof]
            G = G + Z @ la.lu_solve(self._S, Z.T, check_finite=False)
        return G

    def response(self, dof: IntArray, b: Array) -> Array:
        """X for a right side b (m,) that acts on `dof` only, (n,); from the columns that `compliance` keeps."""
        self._update()
        self._keep_columns(dof)
        return self._corrected(self._point_columns @ b)

    def _keep_columns(self, dof: IntArray) -> None:
        """Columns of A^-1 at `dof`; those already known are kept."""
        if np.array_equal(dof, self._points):
            return
        known = {p: k for k, p in enumerate(self._points.tolist())}
        columns = np.zeros((len(self._held), len(dof)))
        old = [k for k, p in enumerate(dof.tolist()) if p in known]
        new = [k for k, p in enumerate(dof.tolist()) if p not in known]
        columns[:, old] = self._point_columns[:, [known[int(dof[k])] for k in old]]
        if new:
            E = np.zeros((len(self._held), len(new)))
            E[dof[new], np.arange(len(new))] = 1.0
            columns[:, new] = self._lu.solve(E)
        self._points, self._point_columns = dof.copy(), columns
