"""Strain of the cells of the lattice, Appendices 2 and 3: what every failure criterion reads.

A positive curvature stretches the top (the thesis, with its rotation reversed, has the minus sign there): downward
bending, the tip of a cantilever pushed down, stretches the top.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.grid import Array, Grid, IntArray


@dataclass(frozen=True)
class Connections:
    """Deformation of the four axial connections of each cell over d; columns are the two parallel connections."""

    n11: Array  #: normal, connections 1-2 and 3-4, (cells, 2)
    n22: Array  #: normal, connections 1-3 and 2-4, (cells, 2)
    s12: Array  #: shear or torsion of 1-2 and 3-4, (cells, 2)
    s21: Array  #: shear or torsion of 1-3 and 2-4, (cells, 2)

    @classmethod
    def of(cls, field: Array, d: float) -> Connections:
        """From the vector (x, y) at the four nodes of each cell, (cells, 4, 2); (A.2.13)-(A.2.16), (A.3.13)-(A.3.16)"""
        along_x = (field[:, [1, 3]] - field[:, [0, 2]]) / d
        along_y = (field[:, [2, 3]] - field[:, [0, 1]]) / d
        return cls(along_x[..., 0], along_y[..., 1], along_x[..., 1], along_y[..., 0])

    def without_rotation(self) -> Connections:
        """Mean rotation of the cell taken out of the shear, so that a piece that turns does not fail by turning."""
        turn = 0.5 * (self.s12.mean(axis=1) - self.s21.mean(axis=1))[:, None]
        return Connections(self.n11, self.n22, self.s12 - turn, self.s21 + turn)

    def tensor(self) -> Array:
        """Averages of parallel connections: 11, 22 and the symmetric 12, (cells, 3)."""
        shear = 0.5 * (self.s12.mean(axis=1) + self.s21.mean(axis=1))
        return np.column_stack((self.n11.mean(axis=1), self.n22.mean(axis=1), shear))


@dataclass(frozen=True)
class CellState:
    """Strain of the cells: what every criterion reads."""

    membrane: Connections  #: [-]
    bending: Connections  #: [1/m]
    shear: Array  #: elongation of the four out-of-plane shear springs over d, (cells, 4) [-]
    diagonal: Array  #: strain of the two diagonals, (A.2.17), (A.2.18), (cells, 2) [-]
    d: float  #: cell size [m]

    @classmethod
    def of(cls, grid: Grid, u: Array, q: Array, cells: IntArray | None = None) -> CellState:
        """From u (nodes, 2) and q = (w, phi_x, phi_y) (nodes, 3), for the given cells or all."""
        nodes = grid.cell_nodes if cells is None else grid.cell_nodes[cells]
        U, Q, d = u[nodes], q[nodes], grid.d
        d1, d2 = U[:, 3] - U[:, 0], U[:, 1] - U[:, 2]
        diagonal = np.column_stack((d1[:, 0] + d1[:, 1], d2[:, 0] - d2[:, 1])) / (2.0 * d)
        return cls(Connections.of(U, d).without_rotation(), Connections.of(Q[..., 1:], d), _shear(Q, d), diagonal, d)


def _shear(Q: Array, d: float) -> Array:
    """Elongations (2.3) over d of the axial connections 1-2, 3-4, 1-3, 2-4, (cells, 4)."""
    springs = ((0, 1, 0), (2, 3, 0), (0, 2, 1), (1, 3, 1))
    w, phi = Q[..., 0], Q[..., 1:]
    return np.column_stack([(w[:, b] - w[:, a]) / d + 0.5 * (phi[:, a, i] + phi[:, b, i]) for a, b, i in springs])


def circle(tensor: Array) -> tuple[Array, Array]:
    """Mean and radius of Mohr's circle, (4.1), (4.2)."""
    mean = 0.5 * (tensor[:, 0] + tensor[:, 1])
    return mean, np.hypot(tensor[:, 0] - mean, tensor[:, 2])


def circle_of_connections(c: Connections) -> tuple[Array, Array]:
    """Mean and radius averaged over the four connections beside a discontinuity, (4.24), (4.25)."""
    mean = 0.25 * (c.n11.sum(axis=1) + c.n22.sum(axis=1))
    radius = np.hypot(c.n11 - mean[:, None], c.s12).sum(axis=1) + np.hypot(c.n22 - mean[:, None], c.s21).sum(axis=1)
    return mean, 0.25 * radius
