"""From cells to matrices.

A cell carries half of its four axial springs and both of its diagonals. An inner axial spring is then the sum of two
halves and a spring on an edge is a half, as (2.10) and (2.12) ask, so that no particle needs a special case and
removing a cell (thesis 4.2.1) is leaving it out of the sum.

Each spring is a row b of a table with energy 1/2 (b . q)^2, so a cell's stiffness is B^T B.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.stiffness import Springs
from lattice.varied import kinds

AXIAL = ((0, 1, 0), (2, 3, 0), (0, 2, 1), (1, 3, 1))  #: first node, second node, direction (0 = x, 1 = y)
DIAGONAL = ((0, 3, 1.0), (2, 1, -1.0))  #: first node, second node, sign of y along the connection


def in_plane_springs(springs: Springs) -> Array:
    """Rows sqrt(stiffness) x elongation for the dof (u_x, u_y) of nodes 0-3, (10, 8) [sqrt(N/m)]; chapter 3."""
    rows = []
    for a, b, along in AXIAL:
        for component, K in ((along, springs.K_n_axi), (1 - along, springs.K_s_axi)):
            row = np.zeros(8)
            row[2 * b + component], row[2 * a + component] = 1.0, -1.0
            rows.append(np.sqrt(0.5 * K) * row)
    for a, b, sign in DIAGONAL:
        row = np.zeros(8)
        row[2 * b : 2 * b + 2] = 1.0, sign
        row[2 * a : 2 * a + 2] = -1.0, -sign
        rows.append(np.sqrt(0.5 * springs.K_n_dia) * row)
    return _without_zero_rows(np.array(rows))


def out_of_plane_springs(springs: Springs, d: float) -> Array:
    """Rows for the dof (w, phi_x, phi_y) of nodes 0-3, (up to 14, 12): shear (2.3), bending (2.4), torsion (2.5)."""
    rows = []
    for a, b, along in AXIAL:
        shear, bend, twist = np.zeros((3, 12))
        shear[3 * b], shear[3 * a] = 1.0, -1.0
        shear[[3 * a + 1 + along, 3 * b + 1 + along]] = 0.5 * d
        bend[3 * b + 1 + along], bend[3 * a + 1 + along] = 1.0, -1.0
        twist[3 * b + 2 - along], twist[3 * a + 2 - along] = 1.0, -1.0
        rows += [
            np.sqrt(0.5 * springs.K_out) * shear,
            np.sqrt(0.5 * springs.G_r_axi) * bend,
            np.sqrt(0.5 * springs.G_t_axi) * twist,
        ]
    for a, b, sign in DIAGONAL:
        row = np.zeros(12)
        row[3 * b + 1 : 3 * b + 3] = 1.0, sign
        row[3 * a + 1 : 3 * a + 3] = -1.0, -sign
        rows.append(np.sqrt(0.5 * springs.G_dia) * row)
    return _without_zero_rows(np.array(rows))


def _without_zero_rows(rows: Array) -> Array:
    return rows[np.any(rows != 0.0, axis=1)]


def cell_dof(grid: Grid, per_node: int) -> IntArray:
    """Numbers of a cell's degrees of freedom, (cells, 4 * per_node)."""
    return (grid.cell_nodes[:, :, None] * per_node + np.arange(per_node)).reshape(grid.cells, -1)


class CellSprings(NamedTuple):
    """Spring table of one cell, and by how much the springs of each cell are stiffer."""

    rows: Array  #: (springs, dof of a cell)
    share: Array  #: (cells, 2), see `lattice.varied`


class CellStiffness(NamedTuple):
    """Stiffness of cells of several kinds."""

    K: Array  #: (kinds, dof of a cell, dof of a cell)
    which: IntArray  #: (cells,) kind of each cell


def cell_stiffness(rows: Array, share: Array) -> CellStiffness:
    """From the spring table of one cell and by how much those of each are stiffer, (cells, 2)."""
    if (share == share[0]).all():
        each, which = share[:1], np.zeros(len(share), np.int64)
    else:
        each, which = np.unique(share, axis=0, return_inverse=True)
    kind = kinds(rows)
    scaled = (np.sqrt(values[kind])[:, None] * rows for values in each)
    return CellStiffness(np.array([b.T @ b for b in scaled]), which.reshape(-1))


def assemble(grid: Grid, rows: Array, intact: BoolArray | None = None, share: Array | None = None) -> sp.csc_matrix:
    """Stiffness of all intact cells from the spring table of one cell, (n, n) with n = dof of the grid [SI].

    ``share`` as in `cell_stiffness`; without it all cells are alike.
    """
    per_node = rows.shape[1] // 4
    cells = cell_stiffness(rows, np.ones((grid.cells, 2)) if share is None else share)
    dof = cell_dof(grid, per_node)
    if intact is not None:
        dof = dof[intact]
    which = cells.which if intact is None else cells.which[intact]
    m = dof.shape[1]
    i = np.repeat(dof, m, axis=1).ravel()
    j = np.tile(dof, (1, m)).ravel()
    data = cells.K[which].ravel()
    n = grid.nodes * per_node
    return sp.coo_matrix((data, (i, j)), shape=(n, n)).tocsc()


def in_plane_mass(grid: Grid, ice: Ice) -> Array:
    """Lumped mass of (u_x, u_y), M = rho h d^2 times the node's share (2.21), (2 nodes,) [kg]."""
    return np.repeat(ice.rho_i * ice.h * grid.area, 2)


def out_of_plane_mass(grid: Grid, ice: Ice) -> Array:
    """Lumped mass of w, that of water with it, and rotary inertia I = rho h^3 d^2 / 12 of phi_x, phi_y (2.21), (2.22).

    (3 nodes,).
    """
    m = ice.rho_i * ice.h * grid.area
    return np.column_stack((m * (1.0 + ice.added_mass), m * ice.h**2 / 12.0, m * ice.h**2 / 12.0)).ravel()


def foundation(grid: Grid, per_area: float) -> Array:
    """Diagonal of a Kelvin foundation (stiffness or damping per area) on w, zero on the rotations, (3 nodes,)."""
    out = np.zeros(3 * grid.nodes)
    out[::3] = per_area * grid.area
    return out
