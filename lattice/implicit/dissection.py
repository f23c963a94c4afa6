"""Nested dissection of the grid: in which order the direct solver eliminates nodes, and what each front holds.

The grid is cut in halves by lines of nodes, and these again, down to leaves of a few nodes (George, SIAM J. Numer.
Anal. 10, 1973); halves are eliminated before the line between them. A *front* is the dense matrix of the nodes that are
eliminated together ("own", w dof) and of the later nodes that they touch ("edge", m dof). The cuts depend on the grid
alone, so they are found once and serve every factorisation.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from lattice.assembly import cell_dof
from lattice.grid import Grid, IntArray

LEAF = 4  #: largest side of a leaf in nodes


class Dissection(NamedTuple):
    """Order of elimination of all dof and the fronts, children before parents. Numbers are those of the new order."""

    order: IntArray  #: (n,) old number of each dof
    rank: IntArray  #: (n,) new number of each dof
    first: IntArray  #: (fronts + 1,) first own dof of each front
    edge: IntArray  #: edges of all fronts, one after the other
    edge_at: IntArray  #: (fronts + 1,) where each edge starts in ``edge``
    children: IntArray  #: (fronts,) how many of the fronts before are its own
    parent: IntArray  #: (fronts,) the front that this one is a child of; of the last one -1
    cell_at: IntArray  #: (fronts + 1,) where each front's cells start in ``cells``
    cells: IntArray  #: (cells,) each in the front of its first dof
    place: IntArray  #: (cells, dof of a cell) row in that front, own dof before edge dof, in the order of ``cells``
    panel_at: IntArray  #: (fronts + 1,) where each panel starts in the flat array
    stack: int  #: numbers on the stack of what fronts leave for their parents, at most
    widest: int  #: largest front


Fronts = list[tuple[list[int], int]]  #: own nodes and number of children of each front, children before parents


def cut(grid: Grid) -> Fronts:
    """The fronts of a grid."""
    fronts: Fronts = []

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
    touched = [in_cell[cells[cell_at[k] : cell_at[k + 1]]].ravel() for k in range(len(fronts))]
    edges, parent, deepest = _edges(fronts, first, touched)
    node_place = np.empty((grid.cells, 4), np.int64)
    for k in range(len(fronts)):
        of = slice(cell_at[k], cell_at[k + 1])
        r = rank[grid.cell_nodes[cells[of]]]
        node_place[of] = np.where(r < first[k + 1], r - first[k], sizes[k] + np.searchsorted(edges[k], r))
    w, m = sizes * per_node, np.array([len(e) for e in edges]) * per_node
    return Dissection(
        order=_to_dof(nodes, per_node),
        rank=_to_dof(rank, per_node),
        first=first * per_node,
        edge=_to_dof(np.concatenate(edges), per_node),
        edge_at=np.concatenate(([0], np.cumsum(m))),
        children=np.array([c for _, c in fronts]),
        parent=parent,
        cell_at=cell_at,
        cells=cells,
        place=_to_dof(node_place, per_node).reshape(cell_dof(grid, per_node).shape),
        panel_at=np.concatenate(([0], np.cumsum(w * (w + m)))),
        stack=deepest * per_node**2,
        widest=int((w + m).max()),
    )


def _to_dof(nodes: IntArray, per_node: int) -> IntArray:
    """Numbers of the dof of nodes (..., k), one after the other, (..., k per_node)."""
    return (nodes[..., None] * per_node + np.arange(per_node)).reshape(*nodes.shape[:-1], -1)


def _edges(fronts: Fronts, first: IntArray, touched: list[IntArray]) -> tuple[list[IntArray], IntArray, int]:
    """Later nodes that each front touches, sorted, its parent, and the largest stack that waits for parents.

    ``touched`` are the nodes of the cells of each front; the stack is one of squares of edges.
    """
    edges: list[IntArray] = []
    parent = np.full(len(fronts), -1)
    waiting: list[int] = []
    stack = deepest = 0
    for k, (_, count) in enumerate(fronts):
        kids = [waiting.pop() for _ in range(count)][::-1]
        parent[kids] = k
        found = np.unique(np.concatenate([touched[k], *(edges[c] for c in kids)]))
        edges.append(found[found >= first[k + 1]])
        stack += len(edges[k]) ** 2 - sum(len(edges[c]) ** 2 for c in kids)
        waiting.append(k)
        deepest = max(deepest, stack)
    return edges, parent, deepest
