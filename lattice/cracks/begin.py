"""The direction in which a cell begins to crack."""

from __future__ import annotations

import numpy as np

from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import CellState


def face_stresses(state: CellState, ice: Ice) -> tuple[Array, Array]:
    """Largest principal stress of each cell at either face and its direction from the x axis, (cells,) [Pa], [rad].

    Plane stress: E / (1 - nu^2) ((1 + nu) m + (1 - nu) R) with mean m and radius R of the strains of the face.
    """
    e11, e22, e12, k11, k22, k12 = state.strains
    worst, angle, nu = np.full(len(state.nodes), -np.inf), np.zeros(len(state.nodes)), ice.nu
    for z in (0.5 * ice.h, -0.5 * ice.h):
        half, shear = 0.5 * (e11 - e22 + z * (k11 - k22)), e12 + z * k12
        mean = 0.5 * (e11 + e22 + z * (k11 + k22))
        stress = ice.E / (1.0 - nu**2) * ((1.0 + nu) * mean + (1.0 - nu) * np.hypot(half, shear))
        angle = np.where(stress > worst, 0.5 * np.arctan2(shear, half), angle)
        worst = np.maximum(worst, stress)
    return worst, angle
