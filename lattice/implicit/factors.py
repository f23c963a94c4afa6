"""Direct solver of the lattice's matrices: multifrontal Cholesky on a nested dissection of the grid.

Each front (`lattice.implicit.dissection`) is eliminated as

    [A11 .]      L L^T = A11,  W = L^-1,  panel P = [W; A21 W^T W],  left for the parent: A22 - A21 W^T W A21^T.
    [A21 A22]

With the panel, forward substitution in a front is y = P x and backward substitution x = P^T (y_own, -x_edge): one
matrix-vector product each.
"""

from __future__ import annotations

import numpy as np

from lattice.assembly import CellStiffness
from lattice.compiled import compiled
from lattice.grid import Array, BoolArray, Grid
from lattice.implicit.dissection import Dissection, dissect


@compiled()
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


@compiled()
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


@compiled()
def substitute(s: Dissection, panels: Array, x: Array, work: Array) -> None:
    """Forward and backward substitution in place, x (n,) in the order of elimination."""
    first, edge, edge_at, panel_at, fronts = s.first, s.edge, s.edge_at, s.panel_at, len(s.first) - 1
    for k in range(fronts):
        a, b, c = first[k], first[k + 1], edge_at[k]
        w, m = b - a, edge_at[k + 1] - c
        P = panels[panel_at[k] : panel_at[k + 1]].reshape(w + m, w)
        y = work[: w + m]
        np.dot(P, x[a:b], y)
        x[a:b] = y[:w]
        for i in range(m):
            x[edge[c + i]] -= y[w + i]
    for k in range(fronts - 1, -1, -1):
        a, b, c = first[k], first[k + 1], edge_at[k]
        w, m = b - a, edge_at[k + 1] - c
        P = panels[panel_at[k] : panel_at[k + 1]].reshape(w + m, w)
        z = work[: w + m]
        z[:w] = x[a:b]
        for i in range(m):
            z[w + i] = -x[edge[c + i]]
        np.dot(P.T, z, x[a:b])


@compiled()
def substitute_many(s: Dissection, panels: Array, x: Array) -> None:
    """As `substitute` for right sides (n, k), in place."""
    first, edge, edge_at, panel_at = s.first, s.edge, s.edge_at, s.panel_at
    fronts, r = len(first) - 1, x.shape[1]
    for k in range(fronts):
        a, b = first[k], first[k + 1]
        rim = edge[edge_at[k] : edge_at[k + 1]]
        P = panels[panel_at[k] : panel_at[k + 1]].reshape(b - a + len(rim), b - a)
        if x[a:b].any():
            y = np.dot(P, x[a:b])
            x[a:b] = y[: b - a]
            for i in range(len(rim)):
                x[rim[i]] -= y[b - a + i]
    for k in range(fronts - 1, -1, -1):
        a, b = first[k], first[k + 1]
        rim = edge[edge_at[k] : edge_at[k + 1]]
        P = panels[panel_at[k] : panel_at[k + 1]].reshape(b - a + len(rim), b - a)
        z = np.empty((b - a + len(rim), r))
        z[: b - a] = x[a:b]
        for i in range(len(rim)):
            z[b - a + i] = -x[rim[i]]
        x[a:b] = np.dot(P.T, z)


class Factors:
    """Factorised ``K(live) + diag`` with held degrees of freedom at zero."""

    def __init__(self, grid: Grid, cells: CellStiffness, live: BoolArray, diagonal: Array, held: BoolArray):
        s = self._s = dissect(grid, cells.K.shape[1] // 4)
        self._held = np.flatnonzero(held[s.order])
        self._panels = factorise(s, live[s.cells], cells, diagonal[s.order], held[s.order])
        self._work = np.empty(s.widest)

    def solve(self, b: Array) -> Array:
        """X for right sides (n,) or (n, k)."""
        s = self._s
        y = np.ascontiguousarray(b[s.order])
        y[self._held] = 0.0
        if y.ndim == 1:
            substitute(s, self._panels, y, self._work)
        else:
            substitute_many(s, self._panels, y)
        x = np.empty_like(y)
        x[s.order] = y
        return x
