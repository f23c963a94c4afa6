"""Factorised system matrix that loses cells as low-rank updates.

With A the matrix at factorisation and U the scaled spring rows of the cells removed since, the present matrix is
A - U U^T and, with Z = A^-1 U and S = I - U^T Z (Woodbury),

    (A - U U^T)^-1 b = A^-1 b + Z S^-1 U^T A^-1 b.

When the rank has grown past `MAX_RANK` the matrix is factorised anew.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lattice.assembly import assemble, cell_dof
from lattice.grid import Array, Grid, IntArray

MAX_RANK = 60  #: columns of U at which a new factorisation is cheaper than carrying them (60 x 60 nodes)
MAX_AT_ONCE = 4  #: cells removed between two uses at which a new factorisation is cheaper than an update


class CrackedSystem:
    """Solves ``(scale * K(intact) + diag) x = b`` with some degrees of freedom held at zero."""

    def __init__(self, grid: Grid, rows: Array, intact: np.ndarray, diagonal: Array, scale: float, held: np.ndarray):
        self._grid, self._rows, self._scale = grid, np.sqrt(scale) * rows, scale
        self._dof = cell_dof(grid, rows.shape[1] // 4)
        self._diagonal, self._free = diagonal, np.flatnonzero(~held)
        self._to_free = np.full(len(held), -1)
        self._to_free[self._free] = np.arange(len(self._free))
        self._intact = intact.copy()
        self._pending: list[int] = []
        self._factorise()

    def _factorise(self) -> None:
        K = assemble(self._grid, self._rows, self._intact)[self._free][:, self._free]
        A = (K + sp.diags(self._diagonal[self._free])).tocsc()
        self._lu = splu(A, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        n = len(self._free)
        self._U, self._Z = np.empty((n, 0)), np.empty((n, 0))
        self._points = np.empty(0, np.int64)
        self._point_columns = np.empty((n, 0))

    def remove(self, cells: IntArray) -> None:
        """Takes cells out of the matrix; the work is done when it is used next."""
        self._intact[cells] = False
        self._pending.extend(int(c) for c in cells)

    def _update(self) -> None:
        """Brings the solver up to date with the cells that were removed."""
        cells, self._pending = self._pending, []
        if len(cells) > MAX_AT_ONCE or self._U.shape[1] + len(cells) * len(self._rows) > MAX_RANK:
            self._factorise()
        elif cells:
            U = self._spring_columns(cells)
            self._U = np.hstack((self._U, U))
            self._Z = np.hstack((self._Z, self._lu.solve(U)))
            self._S = la.lu_factor(np.eye(self._U.shape[1]) - self._U.T @ self._Z)

    def _spring_columns(self, cells: list[int]) -> Array:
        r = len(self._rows)
        U = np.zeros((len(self._free), r * len(cells)))
        for k, cell in enumerate(cells):
            dof = self._to_free[self._dof[cell]]
            on = dof >= 0
            U[dof[on], k * r : (k + 1) * r] = self._rows.T[on]
        return U

    def solve(self, b: Array) -> Array:
        """x for a right side b over all degrees of freedom, held ones come back as 0, (n,)."""
        self._update()
        y = self._lu.solve(b[self._free])
        if self._U.shape[1]:
            y += self._Z @ la.lu_solve(self._S, self._U.T @ y)
        x = np.zeros(len(b))
        x[self._free] = y
        return x

    def spring_force(self, x: Array) -> Array:
        """K x of the springs of the intact cells, (n,)."""
        dof = self._dof[self._intact]
        force = x[dof] @ (self._rows.T @ self._rows / self._scale)
        return np.bincount(dof.ravel(), weights=force.ravel(), minlength=len(x)).astype(np.float64, copy=False)

    def compliance(self, dof: IntArray) -> Array:
        """Rows and columns `dof` of the inverse, (m, m); zero for held ones."""
        self._update()
        if not np.array_equal(dof, self._points):
            self._keep_columns(dof)
        at = self._to_free[dof]
        on = at >= 0
        G = np.zeros((len(dof), len(dof)))
        G_free = self._point_columns[at[on]][:, on]
        if self._U.shape[1]:
            Z = self._Z[at[on]]
            G_free = G_free + Z @ la.lu_solve(self._S, Z.T)
        G[np.ix_(on, on)] = G_free
        return G

    def response(self, dof: IntArray, b: Array) -> Array:
        """x for a right side b (m,) that acts on `dof` only, (n,); from the columns that `compliance` keeps."""
        self._update()
        if not np.array_equal(dof, self._points):
            self._keep_columns(dof)
        y = self._point_columns @ b
        if self._U.shape[1]:
            y += self._Z @ la.lu_solve(self._S, self._U.T @ y)
        x = np.zeros(len(self._to_free))
        x[self._free] = y
        return x

    def _keep_columns(self, dof: IntArray) -> None:
        """Columns of A^-1 at `dof`; those already known are kept."""
        known = {p: k for k, p in enumerate(self._points)}
        columns = np.zeros((len(self._free), len(dof)))
        new = []
        for k, p in enumerate(dof):
            if p in known:
                columns[:, k] = self._point_columns[:, known[p]]
            elif self._to_free[p] >= 0:
                new.append(k)
        if new:
            E = np.zeros((len(self._free), len(new)))
            E[self._to_free[dof[new]], np.arange(len(new))] = 1.0
            columns[:, new] = self._lu.solve(E)
        self._points, self._point_columns = dof.copy(), columns
