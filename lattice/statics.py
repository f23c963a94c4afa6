"""Supports, loads and equilibrium of the lattice: K u = F with some degrees of freedom held.

Supports of an edge (names of `SUPPORTS`):

* ``free``: nothing is held;
* ``simple``: w and the rotation along the edge are zero, (2.49), (2.50), (2.52), (2.53);
* ``clamped``: w, both rotations and both displacements in the plane are zero;
* ``held``: the displacements in the plane are zero, the sheet may still bend (back edge of a floe, chapter 6).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lattice.assembly import assemble, in_plane_springs, out_of_plane_springs
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.stiffness import Springs

#: held out of plane (0 = w, 1 = rotation across the edge, 2 = rotation along the edge), held in plane (yes or no)
SUPPORTS: dict[str, tuple[tuple[int, ...], bool]] = {
    "free": ((), False),
    "simple": ((0, 2), False),
    "clamped": ((0, 1, 2), True),
    "held": ((), True),
}
ALL_EDGES = ("x-", "x+", "y-", "y+")


def all_around(support: str) -> dict[str, str]:
    """The same support on the four edges."""
    return dict.fromkeys(ALL_EDGES, support)


def _support(name: str) -> tuple[tuple[int, ...], bool]:
    if name not in SUPPORTS:
        raise ValueError(f"unknown support {name!r}: use one of {', '.join(SUPPORTS)}")
    return SUPPORTS[name]


def held_out_of_plane(grid: Grid, supports: Mapping[str, str]) -> IntArray:
    """Held degrees of freedom of (w, phi_x, phi_y) for supports such as ``{"x-": "simple"}``, sorted numbers."""
    held = []
    for side, name in supports.items():
        across = 0 if side[0] == "x" else 1
        component = {0: 0, 1: 1 + across, 2: 2 - across}
        held += [3 * grid.edge_nodes(side) + component[part] for part in _support(name)[0]]
    return np.unique(np.concatenate(held)) if held else np.empty(0, dtype=np.int64)


def held_in_plane(grid: Grid, supports: Mapping[str, str]) -> IntArray:
    """Held degrees of freedom of (u_x, u_y), sorted numbers."""
    edges = [grid.edge_nodes(side) for side, name in supports.items() if _support(name)[1]]
    nodes = np.unique(np.concatenate(edges)) if edges else np.empty(0, dtype=np.int64)
    return np.sort(np.concatenate((2 * nodes, 2 * nodes + 1)))


def ice_area(grid: Grid, intact: BoolArray | None = None) -> Array:
    """Area of intact ice that belongs to each node, a quarter of each of its cells, (nodes,) [m2]."""
    cells = grid.cell_nodes if intact is None else grid.cell_nodes[intact]
    corners: Array = np.bincount(cells.ravel(), minlength=grid.nodes).astype(np.float64)
    return corners * (grid.d**2 / 4.0)


def out_of_plane_stiffness(
    grid: Grid, ice: Ice, springs: Springs, intact: BoolArray | None = None, k_f: float | None = None
) -> sp.csc_matrix:
    """Springs of (2.2), (2.10), (2.12) plus the Kelvin foundation rho_w g under the intact ice (2.3.2), (3n, 3n)."""
    K = assemble(grid, out_of_plane_springs(springs, grid.d), intact)
    buoyancy = np.zeros(3 * grid.nodes)
    buoyancy[::3] = (ice.k_f if k_f is None else k_f) * ice_area(grid, intact)
    return (K + sp.diags(buoyancy)).tocsc()


def in_plane_stiffness(grid: Grid, springs: Springs, intact: BoolArray | None = None) -> sp.csc_matrix:
    """Springs of chapter 3, (2n, 2n)."""
    return assemble(grid, in_plane_springs(springs), intact)


def free_dof(K: sp.spmatrix, held: IntArray) -> IntArray:
    """Degrees of freedom that are neither held nor cut off from all cells (zero stiffness)."""
    free = K.diagonal() > 0.0
    free[held] = False
    return np.flatnonzero(free)


def solve(K: sp.csc_matrix, load: Array, held: IntArray) -> Array:
    """Static displacements of K u = F with u = 0 at ``held``; ``load`` is (dof,) or (dof, cases)."""
    free = free_dof(K, held)
    u = np.zeros(load.shape)
    u[free] = splu(K[free][:, free].tocsc()).solve(np.ascontiguousarray(load[free]))
    return u
