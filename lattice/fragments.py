"""Pieces of the sheet: connected components of nodes.

Every node owns its tributary ice, two nodes belong together when an intact cell joins them. Components therefore
partition the ice exactly; a node without an intact cell is a piece of its own, and a crack costs no ice.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from lattice.grid import Array, BoolArray, Grid, IntArray


def components(grid: Grid, intact: BoolArray) -> IntArray:
    """Label of the component of each node, (nodes,)."""
    n = grid.cell_nodes[intact]
    i, j = np.repeat(n[:, 0], 3), n[:, 1:].ravel()
    graph = sp.coo_matrix((np.ones(len(i), np.int8), (i, j)), shape=(grid.nodes, grid.nodes))
    label: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return label


def loose_pieces(
    grid: Grid,
    intact: BoolArray,
    present: BoolArray,
    held: BoolArray,
    share: float,
    turned: BoolArray | None = None,
) -> tuple[list[IntArray], int]:
    """Pieces that leave the lattice, and the number of parts that stay.

    A piece leaves when none of its nodes is held and its area is below `share` of the whole floe; a larger free part
    stays and floats. A part of which every node has ``turned`` leaves in any case. ``present``, ``held`` and ``turned``
    are per node. Pieces come as node numbers, ordered by their first node.
    """
    label = components(grid, intact)
    label = np.where(present, label, -1)
    area = np.bincount(label[present], weights=grid.area[present], minlength=label.max() + 1)
    has_held = np.zeros(len(area), bool)
    has_held[label[present & held]] = True
    exists = np.zeros(len(area), bool)
    exists[label[present]] = True
    loose = exists & ~has_held & (area < share * grid.area.sum())
    if turned is not None:
        still = np.zeros(len(area), bool)
        still[label[present & ~turned]] = True
        loose |= exists & ~still
    pieces = [np.flatnonzero(label == k) for k in np.flatnonzero(loose)]
    return sorted(pieces, key=lambda p: int(p[0])), int((exists & ~loose).sum())


def front_rows(grid: Grid, present: BoolArray) -> IntArray:
    """Row of the foremost node (largest x) of each column, -1 where a column has none, (ny,)."""
    p = present.reshape(grid.nx, grid.ny)
    front: Array = grid.nx - 1 - np.argmax(p[::-1], axis=0)
    return np.where(p.any(axis=0), front, -1).astype(np.int64)


def front_x(grid: Grid, present: BoolArray) -> Array:
    """Where the ice of the foremost node of each column ends, -inf where a column has none, (ny,) [m]."""
    row = front_rows(grid, present)
    end = grid.x0 + row * grid.d + np.where(row == grid.nx - 1, 0.0, 0.5 * grid.d)
    return np.where(row >= 0, end, -np.inf)
