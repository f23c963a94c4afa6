"""Direct solver of the lattice's matrices: multifrontal Cholesky on a nested dissection of the grid.

The grid is cut in halves by lines of nodes, and these again, down to leaves of a few nodes (George, SIAM J. Numer.
Anal. 10, 1973); halves are eliminated before the line between them. A *front* is the dense matrix of the nodes that are
eliminated together ("own", w dof) and of the later nodes that they touch ("edge", m dof):

    [A11 .]      L L^T = A11,  W = L^-1,  panel P = [W; A21 W^T W],  left for the parent: A22 - A21 W^T W A21^T.
    [A21 A22]

With the panel, forward substitution in a front is y = P x and backward substitution x = P^T (y_own, -x_edge): one
matrix-vector product each. The cuts depend on the grid alone, so they are found once and serve every factorisation.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lattice.assembly import cell_dof
from lattice.compiled import compiled
from lattice.grid import Array, Grid, IntArray

LEAF = 4  #: largest side of a leaf in nodes


@dataclass(frozen=True)
class Dissection:
    """Order of elimination of all dof and the fronts, children before parents. Numbers are those of the new order."""

    order: IntArray  #: (n,) old number of each dof
    first: IntArray  #: (fronts + 1,) first own dof of each front
    edge: IntArray  #: edges of all fronts, one after the other
    edge_at: IntArray  #: (fronts + 1,) where each edge starts in ``edge``
    children: IntArray  #: (fronts,) how many of the fronts before are its own
    cell_at: IntArray  #: (fronts + 1,) where each front's cells start in ``cells``
    cells: IntArray  #: (cells,) each in the front of its first dof
    place: IntArray  #: (cells, dof of a cell) row in that front, own dof before edge dof, in the order of ``cells``
    panel_at: IntArray  #: (fronts + 1,) where each panel starts in the flat array
    stack: int  #: numbers on the stack of what fronts leave for their parents, at most
    widest: int  #: largest front


def cut(grid: Grid) -> list[tuple[list[int], int]]:
    """Own nodes and number of children of each front, children before parents."""
    fronts: list[tuple[list[int], int]] = []

    def divide(i0: int, i1: int, j0: int, j1: int) -> None:
        if max(i1 - i0, j1 - j0) <= LEAF:
            fronts.append(([i * grid.ny + j for i in range(i0, i1) for j in range(j0, j1)], 0))
        elif i1 - i0 >= j1 - j0:
            m = (i0 + i1) // 2
            divide(i0, m, j0, j1)
            divide(m + 1, i1, j0, j1)
            fronts.append(([m * grid.ny + j for j in range(j0, j1)], 2))
        else:
            m = (j0 + j1) // 2
            divide(i0, i1, j0, m)
            divide(i0, i1, m + 1, j1)
            fronts.append(([i * grid.ny + m for i in range(i0, i1)], 2))

    divide(0, grid.nx, 0, grid.ny)
    return fronts


@lru_cache(maxsize=8)
def dissect(grid: Grid, per_node: int) -> Dissection:
    """Symbolic factorisation: needs the grid only, whatever its cells do."""
    fronts = cut(grid)
    nodes = np.array([n for own, _ in fronts for n in own])
    rank = np.empty(grid.nodes, np.int64)
    rank[nodes] = np.arange(grid.nodes)
    sizes = np.array([len(own) for own, _ in fronts])
    first = np.concatenate(([0], np.cumsum(sizes)))
    in_cell = np.sort(rank[grid.cell_nodes], axis=1)
    home = np.searchsorted(first, in_cell[:, 0], side="right") - 1
    cells = np.argsort(home, kind="stable")
    cell_at = np.searchsorted(home[cells], np.arange(len(fronts) + 1))
    edges: list[IntArray] = []
    open_: list[int] = []
    stack = deepest = 0
    for k, (_, count) in enumerate(fronts):
        kids = [open_.pop() for _ in range(count)][::-1]
        mine = [in_cell[cells[cell_at[k] : cell_at[k + 1]]].ravel(), *(edges[c] for c in kids)]
        found = np.unique(np.concatenate(mine))
        edges.append(found[found >= first[k + 1]])
        stack -= sum(len(edges[c]) ** 2 for c in kids)
        open_.append(k)
        stack += len(edges[k]) ** 2
        deepest = max(deepest, stack)
    dof = cell_dof(grid, per_node)[cells]
    node_place = np.empty((grid.cells, 4), np.int64)
    for k in range(len(fronts)):
        of = slice(cell_at[k], cell_at[k + 1])
        r = rank[grid.cell_nodes[cells[of]]]
        node_place[of] = np.where(r < first[k + 1], r - first[k], sizes[k] + np.searchsorted(edges[k], r))
    m = np.array([len(e) for e in edges])
    spread = np.arange(per_node)
    wide = lambda a: (a[..., None] * per_node + spread).reshape(*a.shape[:-1], -1)  # noqa: E731
    w, m = sizes * per_node, m * per_node
    return Dissection(
        wide(nodes),
        first * per_node,
        wide(np.concatenate(edges)),
        np.concatenate(([0], np.cumsum(m))),
        np.array([c for _, c in fronts]),
        cell_at,
        cells,
        wide(node_place).reshape(dof.shape),
        np.concatenate(([0], np.cumsum(w * (w + m)))),
        int(deepest) * per_node**2,
        int((w + m).max()),
    )


@compiled()
def factorise(first, edge, edge_at, children, cell_at, live, place, panel_at, stack_size, K_cell, diagonal, held):
    """Panels of all fronts, flat; ``live`` in the order of the cells, ``diagonal`` and ``held`` of the dof."""
    panels = np.empty(panel_at[-1])
    stack = np.empty(stack_size)
    top, fronts = 0, len(children)
    open_ = np.empty(fronts, np.int64)
    opened = 0
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
        for c in range(cell_at[k], cell_at[k + 1]):
            if live[c]:
                for i in range(place.shape[1]):
                    p = place[c, i]
                    if not held[a + p if p < w else rim[p - w]]:
                        for j in range(place.shape[1]):
                            q = place[c, j]
                            if not held[a + q if q < w else rim[q - w]]:
                                F[p, q] += K_cell[i, j]
        for _ in range(children[k]):
            opened -= 1
            child = open_[opened]
            rows = edge[edge_at[child] : edge_at[child + 1]]
            n = len(rows)
            top -= n * n
            left = stack[top : top + n * n].reshape(n, n)
            for i in range(n):
                p = where[rows[i]]
                for j in range(n):
                    F[p, where[rows[j]]] += left[i, j]
        W = inverse_of_factor(np.linalg.cholesky(np.ascontiguousarray(F[:w, :w])))
        P = panels[panel_at[k] : panel_at[k + 1]].reshape(w + m, w)
        P[:w] = W
        if m:
            L21 = np.dot(np.ascontiguousarray(F[w:, :w]), W.T)
            P[w:] = np.dot(L21, W)
            left = stack[top : top + m * m].reshape(m, m)
            left[:] = F[w:, w:] - np.dot(L21, L21.T)
            top += m * m
        open_[opened] = k
        opened += 1
    return panels


@compiled()
def inverse_of_factor(L):
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
def substitute(first, edge, edge_at, panel_at, panels, x, work):
    """Forward and backward substitution in place, x (n,) in the order of elimination."""
    fronts = len(first) - 1
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
def substitute_many(first, edge, edge_at, panel_at, panels, x):
    """As `substitute` for right sides (n, k), in place."""
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

    def __init__(self, grid: Grid, K_cell: Array, live: np.ndarray, diagonal: Array, held: np.ndarray):
        s = self._s = dissect(grid, K_cell.shape[0] // 4)
        self._held = np.flatnonzero(held[s.order])
        self._panels = factorise(
            s.first,
            s.edge,
            s.edge_at,
            s.children,
            s.cell_at,
            live[s.cells],
            s.place,
            s.panel_at,
            s.stack,
            np.ascontiguousarray(K_cell),
            diagonal[s.order],
            held[s.order],
        )
        self._work = np.empty(s.widest)

    def solve(self, b: Array) -> Array:
        """X for right sides (n,) or (n, k)."""
        s = self._s
        y = np.ascontiguousarray(b[s.order])
        y[self._held] = 0.0
        if y.ndim == 1:
            substitute(s.first, s.edge, s.edge_at, s.panel_at, self._panels, y, self._work)
        else:
            substitute_many(s.first, s.edge, s.edge_at, s.panel_at, self._panels, y)
        x = np.empty_like(y)
        x[s.order] = y
        return x
