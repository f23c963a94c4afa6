"""A cut plate in motion: the matrices of the stepper for the intact cells, and failure on the way."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from lattice.grid import Array, IntArray
from lattice.ice import Ice
from lattice.specimens import Piece
from lattice.statics import free_dof, ice_area, out_of_plane_stiffness
from lattice.stepper import Stepper, critical_step
from lattice.stiffness import hrennikoff
from lattice.strain import CellState


@dataclass
class MovingPiece:
    """Beam of a test (`Piece`) under a load that grows with time; cells can be taken out between steps.

    Out of plane only. ``c`` is the hydrodynamic damping [N s/m3], ``alpha`` the stiffness-proportional one [s].
    """

    piece: Piece
    c: float = 0.0
    alpha: float = 0.0
    dt: float | None = None  #: None: 0.9 of the stable step [s]
    stepper: Stepper = field(init=False)

    def __post_init__(self) -> None:
        self.intact = self.piece.intact.ravel().copy()
        K, C = self._matrices()
        self.free = free_dof(K, self.piece.held())
        K, C, m = K[self.free][:, self.free], C[self.free][:, self.free], self._mass()[self.free]
        self.dt = 0.9 * critical_step(K, C, m) if self.dt is None else self.dt
        self.stepper = Stepper(K.tocsr(), C.tocsr(), m, self.dt)
        self.load = self.piece.load()[self.free]

    def _matrices(self) -> tuple[sp.csc_matrix, sp.csc_matrix]:
        grid, ice = self.piece.grid, self.piece.ice
        springs = out_of_plane_stiffness(grid, ice, hrennikoff(ice), self.intact, 0.0)
        area = np.zeros(3 * grid.nodes)
        area[::3] = ice_area(grid, self.piece.intact.ravel())
        return (springs + sp.diags(ice.k_f * area)).tocsc(), (self.alpha * springs + sp.diags(self.c * area)).tocsc()

    def _mass(self) -> Array:
        """Mass of the intact ice; broken cells keep theirs, so that nothing loses inertia at a failure."""
        ice, area = self.piece.ice, ice_area(self.piece.grid, self.piece.intact.ravel())
        return mass_of(ice, area)

    def run(self, steps: int, rate: float) -> None:
        """March under the tip force rate * t [N/s]."""
        self.stepper.run(steps, lambda t: rate * t * self.load)

    def remove(self, cells: IntArray) -> None:
        """Take cells out of the stiffness; displacement and velocity go on (thesis 4.2.1)."""
        self.intact[cells] = False
        K, C = self._matrices()
        self.stepper.exchange(K[self.free][:, self.free], C[self.free][:, self.free])

    @property
    def q(self) -> Array:
        """(w, phi_x, phi_y) of all nodes, (nodes, 3)."""
        full = np.zeros(3 * self.piece.grid.nodes)
        full[self.free] = self.stepper.q
        return full.reshape(-1, 3)

    def state(self, cells: IntArray) -> CellState:
        """Strain of these cells now."""
        grid = self.piece.grid
        return CellState.of(grid, np.zeros((grid.nodes, 2)), self.q, cells)


def mass_of(ice: Ice, area: Array) -> Array:
    """Mass and rotary inertia (2.21), (2.22) of nodes that own ``area``, (3 nodes,) [kg], [kg m2]."""
    m = ice.rho_i * ice.h * area
    return np.column_stack((m, m * ice.h**2 / 12.0, m * ice.h**2 / 12.0)).ravel()
