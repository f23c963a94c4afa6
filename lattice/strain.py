"""Strain of the cells of the lattice, Appendices 2 and 3: what every failure criterion reads.

A positive curvature stretches the top (the thesis, with its rotation reversed, has the minus sign there): downward
bending, the tip of a cantilever pushed down, stretches the top. Strains are those of the connections divided by the
cell size. The mean rotation of the cell is taken out of the shear strains, so that a floe that turns does not fail by
turning; in the thesis's own cases nothing changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array, Grid, IntArray


class Strains(NamedTuple):
    """Membrane strain and curvature of some cells; parallel connections are averaged."""

    e11: Array  #: (cells,) [-]
    e22: Array  #: (cells,) [-]
    e12: Array  #: (cells,) [-]
    k11: Array  #: (cells,) curvature [1/m]
    k22: Array  #: (cells,) [1/m]
    k12: Array  #: (cells,) [1/m]

    def bending_only(self) -> Strains:
        """The same curvature without membrane strain."""
        none = np.zeros_like(self.e11)
        return Strains(none, none, none, self.k11, self.k22, self.k12)


@compiled()
def mean_strains(cell_nodes: IntArray, d: float, u: Array, q: Array) -> Strains:
    """From node displacements u (n, 2) [m] and q (n, 3) = w [m], phi_x, phi_y [rad]; ``cell_nodes`` (cells, 4)."""
    cells = cell_nodes.shape[0]
    e11, e22, e12 = np.empty(cells), np.empty(cells), np.empty(cells)
    k11, k22, k12 = np.empty(cells), np.empty(cells), np.empty(cells)
    for c in range(cells):
        n0, n1, n2, n3 = cell_nodes[c, 0], cell_nodes[c, 1], cell_nodes[c, 2], cell_nodes[c, 3]
        half = 0.5 / d
        e11[c] = (u[n1, 0] - u[n0, 0] + u[n3, 0] - u[n2, 0]) * half
        e22[c] = (u[n2, 1] - u[n0, 1] + u[n3, 1] - u[n1, 1]) * half
        e12[c] = 0.5 * (u[n1, 1] - u[n0, 1] + u[n3, 1] - u[n2, 1] + u[n2, 0] - u[n0, 0] + u[n3, 0] - u[n1, 0]) * half
        k11[c] = (q[n1, 1] - q[n0, 1] + q[n3, 1] - q[n2, 1]) * half
        k22[c] = (q[n2, 2] - q[n0, 2] + q[n3, 2] - q[n1, 2]) * half
        k12[c] = 0.5 * (q[n1, 2] - q[n0, 2] + q[n3, 2] - q[n2, 2] + q[n2, 1] - q[n0, 1] + q[n3, 1] - q[n1, 1]) * half
    return Strains(e11, e22, e12, k11, k22, k12)


@dataclass(frozen=True)
class Connections:
    """Deformation of the four axial connections of each cell over d; columns are the two parallel connections."""

    n11: Array  #: normal, connections 1-2 and 3-4, (cells, 2)
    n22: Array  #: normal, connections 1-3 and 2-4, (cells, 2)
    s12: Array  #: shear or torsion of 1-2 and 3-4, (cells, 2)
    s21: Array  #: shear or torsion of 1-3 and 2-4, (cells, 2)

    @classmethod
    def of(cls, field: Array, d: float) -> Connections:
        """Of the vector (x, y) at the four nodes of each cell, (cells, 4, 2); (A.2.13)-(A.2.16), (A.3.13)-(A.3.16)."""
        along_x = (field[:, [1, 3]] - field[:, [0, 2]]) / d
        along_y = (field[:, [2, 3]] - field[:, [0, 1]]) / d
        return cls(along_x[..., 0], along_y[..., 1], along_x[..., 1], along_y[..., 0])

    def without_rotation(self) -> Connections:
        """Mean rotation of the cell taken out of the shear, so that a piece that turns does not fail by turning."""
        turn = 0.5 * (self.s12.mean(axis=1) - self.s21.mean(axis=1))[:, None]
        return Connections(self.n11, self.n22, self.s12 - turn, self.s21 + turn)


@dataclass(frozen=True)
class CellState:
    """Displacement of the nodes of some cells; their strains are worked out when a criterion first asks."""

    nodes: IntArray  #: (cells, 4) as `Grid.cell_nodes`
    u: Array  #: (nodes of the grid, 2) [m]
    q: Array  #: (nodes of the grid, 3) w [m], phi_x, phi_y [rad]
    d: float  #: cell size [m]
    limit: Array | None = None  #: (cells,) of the tensile criteria where cells are beside crack tips [Pa]
    lean: Array | None = None  #: (3, cells) membrane strain that u does not have: xx, yy, shear in engineering measure
    thick: Array | None = None  #: (cells,) thickness over that of the ice: the faces lie further out, curvature is more

    @classmethod
    def of(
        cls,
        grid: Grid,
        u: Array,
        q: Array,
        cells: IntArray | None = None,
        limit: Array | None = None,
        lean: Array | None = None,
        thick: Array | None = None,
    ) -> CellState:
        """The given cells or all, from u (nodes, 2) and q = (w, phi_x, phi_y) (nodes, 3)."""
        return cls(grid.cell_nodes if cells is None else grid.cell_nodes[cells], u, q, grid.d, limit, lean, thick)

    def limit_or(self, strength: float) -> Array | float:
        """The tensile limit of each cell, or this strength [Pa] where the state is judged without a sheet around."""
        return strength if self.limit is None else self.limit

    @cached_property
    def strains(self) -> Strains:
        """Averages over parallel connections."""
        found: Strains = mean_strains(self.nodes, self.d, np.ascontiguousarray(self.u), np.ascontiguousarray(self.q))
        if self.lean is not None:
            xx, yy, xy = self.lean
            found = found._replace(e11=found.e11 + xx, e22=found.e22 + yy, e12=found.e12 + 0.5 * xy)
        if self.thick is not None:
            t = self.thick
            found = found._replace(k11=t * found.k11, k22=t * found.k22, k12=t * found.k12)
        return found

    @cached_property
    def membrane(self) -> Connections:
        """Strain of each connection, without the rotation of the cell [-]."""
        flat = Connections.of(self.u[self.nodes], self.d).without_rotation()
        if self.lean is None:
            return flat
        xx, yy, xy = self.lean[:, :, None]
        return Connections(flat.n11 + xx, flat.n22 + yy, flat.s12 + 0.5 * xy, flat.s21 + 0.5 * xy)

    @cached_property
    def bending(self) -> Connections:
        """Curvature of each connection [1/m]."""
        turned = self.q[self.nodes][..., 1:]
        return Connections.of(turned if self.thick is None else self.thick[:, None, None] * turned, self.d)

    @cached_property
    def diagonal(self) -> Array:
        """Strain of the two diagonals, (A.2.17), (A.2.18), (cells, 2) [-]."""
        U = self.u[self.nodes]
        d1, d2 = U[:, 3] - U[:, 0], U[:, 1] - U[:, 2]
        flat = np.column_stack((d1[:, 0] + d1[:, 1], d2[:, 0] - d2[:, 1])) / (2.0 * self.d)
        if self.lean is None:
            return flat
        xx, yy, xy = self.lean
        return flat + 0.5 * np.column_stack((xx + yy + xy, xx + yy - xy))

    @cached_property
    def shear(self) -> Array:
        """Elongations (2.3) of the out-of-plane shear springs 1-2, 3-4, 1-3, 2-4 over d, (cells, 4) [-]."""
        springs = ((0, 1, 0), (2, 3, 0), (0, 2, 1), (1, 3, 1))
        Q = self.q[self.nodes]
        w, phi = Q[..., 0], Q[..., 1:]
        return np.column_stack(
            [(w[:, b] - w[:, a]) / self.d + 0.5 * (phi[:, a, i] + phi[:, b, i]) for a, b, i in springs]
        )
