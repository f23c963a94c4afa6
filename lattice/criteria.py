"""Strain state of a cell and the failure criteria of the thesis, chapter 4.

Tension is positive. Strains are those of the connections divided by the cell size, as in Appendices 2 and 3. The mean
rotation of the cell is taken out of the shear strains, so that a floe that turns does not fail by turning; in the
thesis's own cases nothing changes.

With z up and the rotation phi_x = -dw/dx of a thin plate, a fibre at height z has the strain z d(phi_x)/dx; the top
therefore carries +eta h/2 where the thesis, with its rotation reversed, writes -eta h/2 in (4.17). The faces exchange
names, the criterion is the same.
"""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array, Grid
from lattice.ice import Ice


def mohr_factors(nu: float, strength_ratio: float) -> tuple[float, float]:
    """F_1 and F_2 of the tensile criterion (4.6), from Poisson's ratio and sigma_c / sigma_t."""
    q = 1.0 if np.isinf(strength_ratio) else (strength_ratio - 1.0) / (strength_ratio + 1.0)
    return (1.0 + nu) / (1.0 - nu) * q, (1.0 + q) * (1.0 + nu) / 2.0


@compiled()
def cell_strains(cell_nodes, d, u, q):
    """Membrane strain and curvature of each cell from node displacements u (n, 2) and q (n, 3).

    Returns (cells, 6): eps_11, eps_22, eps_12 [-] and eta_11, eta_22, eta_12 [1/m]; parallel connections are averaged.
    """
    out = np.empty((cell_nodes.shape[0], 6))
    for c in range(cell_nodes.shape[0]):
        n0, n1, n2, n3 = cell_nodes[c, 0], cell_nodes[c, 1], cell_nodes[c, 2], cell_nodes[c, 3]
        half = 0.5 / d
        out[c, 0] = (u[n1, 0] - u[n0, 0] + u[n3, 0] - u[n2, 0]) * half
        out[c, 1] = (u[n2, 1] - u[n0, 1] + u[n3, 1] - u[n1, 1]) * half
        out[c, 2] = 0.5 * (u[n1, 1] - u[n0, 1] + u[n3, 1] - u[n2, 1] + u[n2, 0] - u[n0, 0] + u[n3, 0] - u[n1, 0]) * half
        out[c, 3] = (q[n1, 1] - q[n0, 1] + q[n3, 1] - q[n2, 1]) * half
        out[c, 4] = (q[n2, 2] - q[n0, 2] + q[n3, 2] - q[n1, 2]) * half
        out[c, 5] = 0.5 * (q[n1, 2] - q[n0, 2] + q[n3, 2] - q[n2, 2] + q[n2, 1] - q[n0, 1] + q[n3, 1] - q[n1, 1]) * half
    return out


@compiled()
def mohr(strains, fibre):
    """Mean and radius of Mohr's circle at the top and at the bottom, (4.17)-(4.20): (cells, 4).

    ``fibre`` is h/2 times sigma_t / sigma_f [m]. Columns: mean and radius at the top, mean and radius at the bottom.
    """
    out = np.empty((strains.shape[0], 4))
    for c in range(strains.shape[0]):
        for face in range(2):
            z = fibre if face == 0 else -fibre
            e11 = strains[c, 0] + z * strains[c, 3]
            e22 = strains[c, 1] + z * strains[c, 4]
            e12 = strains[c, 2] + z * strains[c, 5]
            out[c, 2 * face] = 0.5 * (e11 + e22)
            out[c, 2 * face + 1] = np.sqrt((0.5 * (e11 - e22)) ** 2 + e12**2)
    return out


def tensile_utilisation(mean: Array, radius: Array, limit: Array | float, ice: Ice) -> Array:
    """(F_1 mean + R) / F_2 * E / limit of the tensile criterion (4.6); the cell fails at 1. ``limit`` in Pa."""
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / ice.sigma_t)
    return (F_1 * mean + radius) / F_2 * ice.E / limit


def combined_utilisation(strains: Array, limit: Array | float, ice: Ice) -> Array:
    """Combined tension and bending: the larger utilisation of the two faces, (4.6) with (4.17)-(4.20), (cells,)."""
    circle = mohr(strains, 0.5 * ice.h * ice.sigma_t / ice.sigma_f)
    return np.maximum(
        tensile_utilisation(circle[:, 0], circle[:, 1], limit, ice),
        tensile_utilisation(circle[:, 2], circle[:, 3], limit, ice),
    )


RING = ((0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0))  #: the eight neighbours, going round


def crack_tips(grid: Grid, intact: np.ndarray) -> np.ndarray:
    """Broken cells at which a crack ends, (cells,) bool.

    Going round a tip, what is broken or outside the sheet is one gap of at most three of the eight neighbours. Along
    the flanks of a crack, at its mouth and along a straight broken edge it is more, and strains do not concentrate.
    """
    free = np.pad(~intact.reshape(grid.nx - 1, grid.ny - 1), 1, constant_values=True)
    ring = np.stack([free[i : i + grid.nx - 1, j : j + grid.ny - 1] for i, j in RING])
    gaps = (ring & ~np.roll(ring, 1, axis=0)).sum(axis=0)
    tip: np.ndarray = ~intact & (gaps.ravel() <= 1) & (ring.sum(axis=0).ravel() <= 3)
    return tip


def tensile_limits(grid: Grid, intact: np.ndarray, ice: Ice) -> Array:
    """Tensile limit of each cell: sigma_t, and the limit (4.31) for the eight neighbours of a crack tip [Pa]."""
    tip = np.pad(crack_tips(grid, intact).reshape(grid.nx - 1, grid.ny - 1), 1)
    beside = np.zeros((grid.nx - 1, grid.ny - 1), bool)
    for i, j in RING:
        beside |= tip[i : i + grid.nx - 1, j : j + grid.ny - 1]
    limits = np.full(grid.cells, ice.sigma_t)
    if beside.any():
        limits[beside.ravel()] = ice.stress_beside_crack(grid.d)
    return limits
