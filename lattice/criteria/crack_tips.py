"""Where strains concentrate: cells beside the tip of a crack, and their tensile limit."""

from __future__ import annotations

import numpy as np

from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice

RING = ((0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0))  #: the eight neighbours, going round


def crack_tips(grid: Grid, intact: BoolArray) -> BoolArray:
    """Broken cells at which a crack ends, (cells,) bool.

    Going round a tip, what is broken or outside the sheet is one gap of at most three of the eight neighbours. Along
    the flanks of a crack, at its mouth and along a straight broken edge it is more, and strains do not concentrate.
    """
    free = np.pad(~intact.reshape(grid.nx - 1, grid.ny - 1), 1, constant_values=True)
    ring = np.stack([free[i : i + grid.nx - 1, j : j + grid.ny - 1] for i, j in RING])
    gaps = (ring & ~np.roll(ring, 1, axis=0)).sum(axis=0)
    tip: BoolArray = ~intact & (gaps.ravel() <= 1) & (ring.sum(axis=0).ravel() <= 3)
    return tip


def beside_tips(grid: Grid, intact: BoolArray) -> BoolArray:
    """The eight neighbours of every crack tip, (cells,) bool."""
    tip = np.pad(crack_tips(grid, intact).reshape(grid.nx - 1, grid.ny - 1), 1)
    beside = np.zeros((grid.nx - 1, grid.ny - 1), bool)
    for i, j in RING:
        beside |= tip[i : i + grid.nx - 1, j : j + grid.ny - 1]
    return beside.ravel()


def tensile_limits(grid: Grid, beside: BoolArray, ice: Ice) -> Array:
    """Limit of the combined tensile criterion: sigma_t, and (4.31) for cells beside a crack tip, (cells,) [Pa].

    (4.31) bounds the *bending* stress. The combined criterion counts a bending stress with sigma_t / sigma_f
    (4.17)-(4.20), and so the limit is scaled likewise: pure bending then fails at the stress of (4.31).
    """
    limits = np.full(grid.cells, ice.sigma_t)
    if beside.any():
        limits[beside] = ice.stress_beside_crack(grid.d) * bending_in_tension(ice)
    return limits


def bending_in_tension(ice: Ice) -> float:
    """What one pascal of bending stress counts in the combined criterion, sigma_t / sigma_f [-]."""
    return 1.0 if ice.sigma_t == ice.sigma_f else ice.sigma_t / ice.sigma_f
