"""The failure criteria of chapters 4 and 5, one function each: utilisation of every cell, which fails at 1.

Tension and elongation are positive; compressive strengths are given as positive numbers, the spalling limit as the
negative stress sigma_spall that the thesis prints. Upward bending has the bottom in tension, downward bending the top.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lattice.criteria import mohr_factors, tensile_utilisation
from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import CellState, circle, circle_of_connections

BETA = np.deg2rad(27.0)  #: fault plane against the least-loaded direction, section 4.1.1 [rad]
SLOPE, INTERCEPT = 3.548, 0.747  #: of the threshold line (4.4)


@dataclass(frozen=True)
class Strength:
    """Elastic sheet and the strengths that only some criteria need."""

    ice: Ice
    sigma_spall: float = -np.inf  #: sum of principal stresses at spalling, negative [Pa]
    sigma_f_upward: float = np.inf  #: flexural strength in upward bending, bottom in tension [Pa]
    sigma_f_downward: float = np.inf  #: flexural strength in downward bending, top in tension [Pa]
    sigma_shear: float = np.inf  #: out-of-plane shear strength [Pa]
    K_IC: float = np.inf  #: fracture toughness [Pa sqrt(m)]


def tension(state: CellState, strength: Strength) -> Array:
    """In-plane tension (4.6) against sigma_t."""
    return tensile_utilisation(*circle(state.membrane.tensor()), strength.ice.sigma_t, strength.ice)


def shear_fault(mean: Array, radius: Array, ice: Ice) -> Array:
    """Coulombic shear fault at 27 degrees, left side of (4.5) over |sigma_c| / E."""
    left = radius * np.sin(2.0 * BETA) + SLOPE * (mean + radius * np.cos(2.0 * BETA))
    return left / INTERCEPT * ice.E / ice.sigma_c


def compression(state: CellState, strength: Strength) -> Array:
    """In-plane compression (4.5) against sigma_c."""
    return shear_fault(*circle(state.membrane.tensor()), strength.ice)


def spalling(state: CellState, strength: Strength) -> Array:
    """Sum of both diagonals (4.9) against the negative sigma_spall: biaxial compression only."""
    ice = strength.ice
    return state.diagonal.sum(axis=1) * ice.E / ((1.0 - ice.nu) * strength.sigma_spall)


def _face(tensor: Array, z: float, limit: float, ice: Ice) -> Array:
    """(4.14) at the fibre z with F_1, F_2 from sigma_c over this limit."""
    mean, radius = circle(z * tensor)
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / limit)
    return (F_1 * mean + radius) / F_2 * ice.E / limit


def bending_top(state: CellState, strength: Strength) -> Array:
    """Bending (4.10), (4.11), (4.14): the top against sigma_f."""
    return _face(state.bending.tensor(), 0.5 * strength.ice.h, strength.ice.sigma_f, strength.ice)


def bending_bottom(state: CellState, strength: Strength) -> Array:
    """Bending (4.12), (4.13), (4.14): the bottom against sigma_f."""
    return _face(state.bending.tensor(), -0.5 * strength.ice.h, strength.ice.sigma_f, strength.ice)


def upward_bending(state: CellState, strength: Strength) -> Array:
    """(4.15): the bottom against the flexural strength in upward bending."""
    return _face(state.bending.tensor(), -0.5 * strength.ice.h, strength.sigma_f_upward, strength.ice)


def downward_bending(state: CellState, strength: Strength) -> Array:
    """(4.16): the top against the flexural strength in downward bending."""
    return _face(state.bending.tensor(), 0.5 * strength.ice.h, strength.sigma_f_downward, strength.ice)


def _faces(state: CellState, ice: Ice) -> list[tuple[Array, Array]]:
    """Circles of top and bottom under membrane strain and curvature scaled by sigma_t / sigma_f, (4.17)-(4.20)."""
    z = 0.5 * ice.h * ice.sigma_t / ice.sigma_f
    return [circle(state.membrane.tensor() + side * z * state.bending.tensor()) for side in (1.0, -1.0)]


def combined_tension(state: CellState, strength: Strength) -> Array:
    """(4.17)-(4.20) in (4.6): the larger of top and bottom against sigma_t."""
    ice = strength.ice
    top, bottom = (tensile_utilisation(*face, ice.sigma_t, ice) for face in _faces(state, ice))
    return np.maximum(top, bottom)


def combined_compression(state: CellState, strength: Strength) -> Array:
    """(4.17)-(4.20) in (4.5): the larger of top and bottom against sigma_c."""
    top, bottom = (shear_fault(*face, strength.ice) for face in _faces(state, strength.ice))
    return np.maximum(top, bottom)


def crack_tip_splitting(state: CellState, strength: Strength) -> Array:
    """First cell ahead of a crack, (4.23) with (4.24), (4.25), against sqrt(2 / (pi d)) K_IC."""
    limit = np.sqrt(2.0 / (np.pi * state.d)) * strength.K_IC
    return tensile_utilisation(*circle_of_connections(state.membrane), float(limit), strength.ice)


def crack_tip_bending(state: CellState, strength: Strength) -> Array:
    """Cell beside a discontinuity in bending, (4.31): the worse face against the limit from the beam test."""
    ice = strength.ice
    mean, radius = circle_of_connections(state.bending)
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / ice.sigma_f)
    fibre = 0.5 * ice.h * (F_1 * np.abs(mean) + radius) / F_2
    return fibre * ice.E / ice.stress_beside_crack(state.d)


def out_of_plane_shear(state: CellState, strength: Strength) -> Array:
    """Section 5.3: largest shear strain of the four axial connections times G against the shear strength."""
    G = strength.ice.E / (2.0 * (1.0 + strength.ice.nu))
    return np.abs(state.shear).max(axis=1) * G / strength.sigma_shear


Criterion = Callable[[CellState, Strength], Array]
CRITERIA: dict[str, Criterion] = {
    "tension": tension,
    "compression": compression,
    "spalling": spalling,
    "bending-top": bending_top,
    "bending-bottom": bending_bottom,
    "upward-bending": upward_bending,
    "downward-bending": downward_bending,
    "combined-tension": combined_tension,
    "combined-compression": combined_compression,
    "crack-tip-splitting": crack_tip_splitting,
    "crack-tip-bending": crack_tip_bending,
    "out-of-plane-shear": out_of_plane_shear,
}
