"""The lattice in the frequency domain: eigenfrequencies, Bloch waves of the assembled equations, forced response."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import eigsh, splu

from lattice.assembly import assemble, out_of_plane_mass, out_of_plane_springs
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.statics import held_out_of_plane, ice_area
from lattice.stiffness import Springs

#: options of SuperLU for a symmetric pattern: a third less fill than the default
SYMMETRIC: dict[str, Any] = {
    "permc_spec": "MMD_AT_PLUS_A",
    "diag_pivot_thresh": 0.01,
    "options": {"SymmetricMode": True},
}


@dataclass(frozen=True)
class Plate:
    """Out-of-plane lattice with its supports; only the free degrees of freedom, in the order of ``dof``."""

    grid: Grid
    dof: IntArray  #: (n,) numbers in (w, phi_x, phi_y) of all nodes
    springs: sp.csc_matrix  #: (n, n) stiffness of the connections, which carry the material damping (2.30)-(2.33)
    mass: Array  #: (n,) [kg], [kg m2]
    area: Array  #: (n,) area on the foundation, zero for rotations [m2]
    k_f: float  #: foundation stiffness per area [N/m3]

    @classmethod
    def build(cls, grid: Grid, ice: Ice, springs: Springs, supports: Mapping[str, str]) -> Plate:
        """All cells intact; supports of the edges as in `lattice.statics`."""
        K = assemble(grid, out_of_plane_springs(springs, grid.d))
        dof = np.setdiff1d(np.arange(3 * grid.nodes), held_out_of_plane(grid, supports))
        area = np.zeros(3 * grid.nodes)
        area[::3] = ice_area(grid)
        return cls(grid, dof, K[dof][:, dof].tocsc(), out_of_plane_mass(grid, ice)[dof], area[dof], ice.k_f)

    @property
    def stiffness(self) -> sp.csc_matrix:
        """Springs and buoyancy."""
        return (self.springs + sp.diags(self.k_f * self.area)).tocsc()

    def position(self, node: int, component: int) -> int:
        """Place of a node's w (0), phi_x (1) or phi_y (2) among the free degrees of freedom."""
        place = int(np.searchsorted(self.dof, 3 * node + component))
        if place == len(self.dof) or self.dof[place] != 3 * node + component:
            raise ValueError(f"component {component} of node {node} is held by the support")
        return place


def eigenfrequencies(plate: Plate, count: int) -> Array:
    """Lowest eigenfrequencies of K q = (2 pi f)^2 M q, (count,) [Hz]; Table 2-2."""
    scale = 1.0 / np.sqrt(plate.mass)
    K = sp.diags(scale) @ plate.stiffness @ sp.diags(scale)
    start = np.random.default_rng(1).standard_normal(len(scale))  # eigsh starts at random: keep the last digit
    values = eigsh(K.tocsc(), k=count, sigma=0.0, which="LM", v0=start, return_eigenvectors=False)
    return np.sort(np.sqrt(values)) / (2.0 * np.pi)


def response(plate: Plate, load_node: int, omega: Array, c: float = 0.0, alpha: float = 0.0) -> Array:
    """Complex amplitudes (w, phi_x, phi_y) of the loaded node under a unit load cos(omega t), (frequencies, 3).

    (K + i omega alpha K_springs + i omega c A - omega^2 M) q = F with c in N s/m3 and alpha in s.
    """
    places = [plate.position(load_node, component) for component in range(3)]
    force = np.zeros(len(plate.dof), dtype=complex)
    force[places[0]] = 1.0
    out = np.empty((np.size(omega), 3), dtype=complex)
    for i, w in enumerate(np.atleast_1d(omega)):
        diagonal = (plate.k_f + 1j * w * c) * plate.area - w**2 * plate.mass
        Z = (1.0 + 1j * w * alpha) * plate.springs + sp.diags(diagonal)
        out[i] = splu(Z.tocsc(), **SYMMETRIC).solve(force)[places]
    return out


@dataclass(frozen=True)
class Stencil:
    """Equations of one inner node, read from the assembled matrices."""

    offset: Array  #: (neighbours, 2) steps to the neighbour in cells
    block: Array  #: (neighbours, 3, 3) stiffness between the node and the neighbour
    mass: Array  #: (3,) of the node

    @classmethod
    def of_assembled(cls, ice: Ice, springs: Springs, d: float) -> Stencil:
        """Rows of the middle node of an assembled 5 x 5 mesh with foundation, (2.7)-(2.9)."""
        grid = Grid(5, 5, d)
        plate = Plate.build(grid, ice, springs, {})
        K, middle = plate.stiffness, grid.node(2, 2)
        rows = K[3 * middle : 3 * middle + 3].toarray().reshape(3, grid.nodes, 3)
        near = np.flatnonzero(np.any(rows != 0.0, axis=(0, 2)))
        offset = np.column_stack(np.divmod(near, grid.ny)) - 2.0
        return cls(offset, rows[:, near].transpose(1, 0, 2), plate.mass[3 * middle : 3 * middle + 3])

    def dispersion(self, Kx: Array | float, Ky: Array | float) -> Array:
        """Angular frequencies of the three Bloch waves at k_x d, k_y d, (..., 3) [rad/s], rising; (2.34)-(2.39)."""
        Kx, Ky = np.broadcast_arrays(np.asarray(Kx, float), np.asarray(Ky, float))
        phase = np.exp(-1j * (Kx[..., None] * self.offset[:, 0] + Ky[..., None] * self.offset[:, 1]))
        scale = 1.0 / np.sqrt(self.mass)
        H = np.einsum("...n,nij->...ij", phase, self.block) * scale[:, None] * scale
        return np.sqrt(np.maximum(np.linalg.eigvalsh(0.5 * (H + np.conj(np.swapaxes(H, -1, -2)))), 0.0))
