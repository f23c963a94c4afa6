"""Direct solver of the lattice's matrices: multifrontal Cholesky on a nested dissection of the grid.

Each front (`lattice.implicit.dissection`) is eliminated as

    [A11 .]      L L^T = A11,  W = L^-1,  panel P = [W; A21 W^T W],  left for the parent: A22 - A21 W^T W A21^T.
    [A21 A22]

With the panel, forward substitution in a front is y = P x and backward substitution x = P^T (y_own, -x_edge): one
matrix-vector product each (`lattice.implicit.substitution`).
"""

from __future__ import annotations

import numpy as np

from lattice.assembly import CellStiffness
from lattice.compiled import compiled
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.implicit.columns import Columns
from lattice.implicit.dissection import Dissection, dissect
from lattice.implicit.substitution import Way, backward, backward_along, forward, forward_along, way_from


@compiled(nogil=True)
def factorise(s: Dissection, live: BoolArray, cells: CellStiffness, diagonal: Array, held: BoolArray) -> Array:
    """Panels of all fronts, flat; ``live`` in the order of the cells, ``diagonal`` and ``held`` of the dof."""
    first, edge, edge_at, place = s.first, s.edge, s.edge_at, s.place
    panels = np.empty(s.panel_at[-1])
    stack = np.empty(s.stack)
    top, fronts = 0, len(s.children)
    waiting = np.empty(fronts, np.int64)
    count = 0
    where = np.empty(len(diagonal), np.int64)
    for k in range(fronts):
        a, b = first[k], first[k + 1]
        rim = edge[edge_at[k] : edge_at[k + 1]]
        w, m = b - a, len(rim)
        F = np.zeros((w + m, w + m))
        for i in range(w):
            F[i, i] = 1.0 if held[a + i] else diagonal[a + i]
            where[a + i] = i
        for i in range(m):
            where[rim[i]] = w + i
        for c in range(s.cell_at[k], s.cell_at[k + 1]):
            if live[c]:
                K_cell = cells.K[cells.which[s.cells[c]]]
                for i in range(place.shape[1]):
                    p = place[c, i]
                    if not held[a + p if p < w else rim[p - w]]:
                        for j in range(place.shape[1]):
                            q = place[c, j]
                            if not held[a + q if q < w else rim[q - w]]:
                                F[p, q] += K_cell[i, j]
        for _ in range(s.children[k]):
            count -= 1
            child = waiting[count]
            rows = edge[edge_at[child] : edge_at[child + 1]]
            n = len(rows)
            top -= n * n
            left = stack[top : top + n * n].reshape(n, n)
            for i in range(n):
                p = where[rows[i]]
                for j in range(n):
                    F[p, where[rows[j]]] += left[i, j]
        W = inverse_of_factor(np.linalg.cholesky(np.ascontiguousarray(F[:w, :w])))
        P = panels[s.panel_at[k] : s.panel_at[k + 1]].reshape(w + m, w)
        P[:w] = W
        if m:
            L21 = np.dot(np.ascontiguousarray(F[w:, :w]), W.T)
            P[w:] = np.dot(L21, W)
            left = stack[top : top + m * m].reshape(m, m)
            left[:] = F[w:, w:] - np.dot(L21, L21.T)
            top += m * m
        waiting[count] = k
        count += 1
    return panels


@compiled(nogil=True)
def inverse_of_factor(L: Array) -> Array:
    """Inverse of a lower triangle."""
    n = len(L)
    W = np.zeros((n, n))
    for i in range(n):
        if i:
            W[i] = -np.dot(L[i, :i], W[:i])
        W[i, i] = 1.0
        W[i] /= L[i, i]
    return W


class Factors:
    """Factorised ``K(live) + diag`` = L L^T with held degrees of freedom at zero."""

    def __init__(self, grid: Grid, cells: CellStiffness, live: BoolArray, diagonal: Array, held: BoolArray):
        s = self._s = dissect(grid, cells.K.shape[1] // 4)
        self._held = held[s.order]
        self._panels = factorise(s, live[s.cells], cells, diagonal[s.order], self._held)
        self._work = np.empty(s.widest)

    def forward(self, b: Array) -> Array:
        """L^-1 b, (n,) in the order of elimination, for b (n,)."""
        y = b[self._s.order]
        y[self._held] = 0.0
        forward(self._s, self._panels, y, self._work)
        return y

    def backward(self, y: Array) -> Array:
        """L^-T y, (n,), for y (n,) in the order of elimination, which is lost."""
        backward(self._s, self._panels, y, self._work)
        return y[self._s.rank]

    def way(self, dof: IntArray) -> Way:
        """From some dof to the last front."""
        return way_from(self._s, self._s.rank[dof])

    def columns(self, dof: IntArray, way: Way, b: Array) -> Columns:
        """L^-1 of columns that are b (m, r) at some dof, with the way from them, and zero elsewhere."""
        at = self._s.rank[dof]
        x = np.zeros((len(way.rows), b.shape[1]))
        x[np.searchsorted(way.rows, at)] = np.where(self._held[at, None], 0.0, b)
        forward_along(self._s, self._panels, way, x)
        return Columns(way.rows, x)

    def at(self, dof: IntArray, way: Way, y: Array) -> Array:
        """What `backward` gives at some dof (m,), with the way from them; y stays."""
        x = y[way.rows]
        backward_along(self._s, self._panels, way, x)
        return x[np.searchsorted(way.rows, self._s.rank[dof])]
