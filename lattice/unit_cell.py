"""One cell of the lattice under a uniform stress or moment in any orientation, Appendices 2 and 3.

The loads of (A.2.1)-(A.2.4) and (A.3.1)-(A.3.4) are the tractions of a uniform state on the four sides of the cell,
half of a side's force at each of its nodes.
"""

from __future__ import annotations

import numpy as np

from lattice.assembly import in_plane_springs, out_of_plane_springs
from lattice.grid import Array, Grid
from lattice.ice import Ice
from lattice.stiffness import Springs
from lattice.strain import CellState

OUTWARD = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])  #: sides on which nodes 0-3 lie


def in_cell_axes(principal: Array, alpha: float) -> Array:
    """Tensor of principal values (xx, yy) in the axes of a cell turned by alpha, (2, 2)."""
    turn = np.array([[np.cos(alpha), np.sin(alpha)], [-np.sin(alpha), np.cos(alpha)]])
    return np.asarray(turn @ np.diag(principal) @ turn.T)


def cell_in_stress(ice: Ice, springs: Springs, principal: Array, alpha: float, d: float = 1.0) -> CellState:
    """Strain of a cell at angle alpha in the plane stress (sigma_xx, sigma_yy) [Pa]; Appendix 2."""
    load = 0.5 * ice.h * d * OUTWARD @ in_cell_axes(principal, alpha)
    u = _deform(in_plane_springs(springs), load.ravel()).reshape(4, 2)
    return CellState.of(Grid(2, 2, d), _numbered(u), np.zeros((4, 3)))


def cell_in_bending(ice: Ice, springs: Springs, principal: Array, alpha: float, d: float = 1.0) -> CellState:
    """Curvature of a cell at angle alpha under the bending stress 6 m / h^2 (sigma_xx, sigma_yy) [Pa]; Appendix 3."""
    moment = in_cell_axes(principal, alpha) * ice.h**2 / 6.0
    load = np.zeros((4, 3))
    load[:, 1:] = 0.5 * d * OUTWARD @ moment
    q = _deform(out_of_plane_springs(springs, d), load.ravel()).reshape(4, 3)
    return CellState.of(Grid(2, 2, d), np.zeros((4, 2)), _numbered(q))


def _deform(rows: Array, load: Array) -> Array:
    """Displacement without rigid motion; the loads are in balance."""
    return np.linalg.pinv(rows.T @ rows, rcond=1e-12) @ load


def _numbered(field: Array) -> Array:
    """From cell order (x first) to the node numbers of a 2 x 2 grid (y first)."""
    return field[[0, 2, 1, 3]]
