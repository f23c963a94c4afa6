"""The failure criteria, one function each: utilisation of every cell, which fails at 1.

Tension and elongation are positive; compressive strengths are given as positive numbers, the spalling limit as the
negative stress sigma_spall that the thesis prints. Upward bending has the bottom in tension, downward bending the top.
Chapters 4 and 5 of the thesis, and the largest principal stress. Their names stand in `lattice.criteria.table`.
"""

from __future__ import annotations

import numpy as np

from lattice.criteria.mohr import Circle, circle, circle_of_connections, faces, mohr_factors, tensile_utilisation
from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import CellState

BETA = np.deg2rad(27.0)  #: fault plane against the least-loaded direction, section 4.1.1 [rad]
SLOPE, INTERCEPT = 3.548, 0.747  #: of the threshold line (4.4)


def tension(state: CellState, ice: Ice) -> Array:
    """In-plane tension (4.6) against sigma_t."""
    return tensile_utilisation(circle(state.strains), ice.sigma_t, ice)


def shear_fault(circle: Circle, ice: Ice) -> Array:
    """Coulombic shear fault at 27 degrees, left side of (4.5) over |sigma_c| / E."""
    left = circle.radius * np.sin(2.0 * BETA) + SLOPE * (circle.mean + circle.radius * np.cos(2.0 * BETA))
    return np.asarray(left / INTERCEPT * ice.E / ice.sigma_c)


def compression(state: CellState, ice: Ice) -> Array:
    """In-plane compression (4.5) against sigma_c."""
    return shear_fault(circle(state.strains), ice)


def spalling(state: CellState, ice: Ice) -> Array:
    """Sum of both diagonals (4.9) against the negative sigma_spall: biaxial compression only."""
    return np.asarray(state.diagonal.sum(axis=1) * ice.E / ((1.0 - ice.nu) * ice.sigma_spall))


def _bent_face(state: CellState, z: float, limit: float, ice: Ice) -> Array:
    """(4.14) at the fibre z with F_1, F_2 from sigma_c over this limit."""
    mean, radius = circle(state.strains.bending_only(), z)
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / limit)
    return (F_1 * mean + radius) / F_2 * ice.E / limit


def bending_top(state: CellState, ice: Ice) -> Array:
    """Bending (4.10), (4.11), (4.14): the top against sigma_f."""
    return _bent_face(state, 0.5 * ice.h, ice.sigma_f, ice)


def bending_bottom(state: CellState, ice: Ice) -> Array:
    """Bending (4.12), (4.13), (4.14): the bottom against sigma_f."""
    return _bent_face(state, -0.5 * ice.h, ice.sigma_f, ice)


def upward_bending(state: CellState, ice: Ice) -> Array:
    """(4.15): the bottom against the flexural strength in upward bending."""
    return _bent_face(state, -0.5 * ice.h, ice.sigma_f_upward, ice)


def downward_bending(state: CellState, ice: Ice) -> Array:
    """(4.16): the top against the flexural strength in downward bending."""
    return _bent_face(state, 0.5 * ice.h, ice.sigma_f_downward, ice)


def combined_tension(state: CellState, ice: Ice) -> Array:
    """(4.17)-(4.20) in (4.6): the larger of top and bottom against sigma_t, at a crack tip against (4.31)."""
    top, bottom = faces(state.strains, ice)
    limit = state.limit_or(ice.sigma_t)
    return np.maximum(tensile_utilisation(top, limit, ice), tensile_utilisation(bottom, limit, ice))


def combined_compression(state: CellState, ice: Ice) -> Array:
    """(4.17)-(4.20) in (4.5): the larger of top and bottom against sigma_c."""
    top, bottom = faces(state.strains, ice)
    return np.maximum(shear_fault(top, ice), shear_fault(bottom, ice))


def principal_stress(state: CellState, ice: Ice) -> Array:
    """Largest principal stress E / (1 - nu^2) (e_1 + nu e_2) of top and bottom against the limit of (4.6).

    Plane stress; curvature scaled as in (4.17)-(4.20), so that pure bending fails at sigma_f; (4.31) at a crack tip.
    """
    stiffness, limit = ice.E / (1.0 - ice.nu**2), state.limit_or(ice.sigma_t)
    e_1_and_e_2 = ((face.mean + face.radius, face.mean - face.radius) for face in faces(state.strains, ice))
    top, bottom = (stiffness * (e_1 + ice.nu * e_2) / limit for e_1, e_2 in e_1_and_e_2)
    return np.maximum(top, bottom)


def crack_tip_splitting(state: CellState, ice: Ice) -> Array:
    """First cell ahead of a crack, (4.23) with (4.24), (4.25), against sqrt(2 / (pi d)) K_IC."""
    limit = np.sqrt(2.0 / (np.pi * state.d)) * ice.K_IC
    return tensile_utilisation(circle_of_connections(state.membrane), float(limit), ice)


def crack_tip_bending(state: CellState, ice: Ice) -> Array:
    """Cell beside a discontinuity in bending, (4.31): the worse face against the limit from the beam test."""
    mean, radius = circle_of_connections(state.bending)
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / ice.sigma_f)
    fibre = 0.5 * ice.h * (F_1 * np.abs(mean) + radius) / F_2
    return np.asarray(fibre * ice.E / ice.stress_beside_crack(state.d))


def out_of_plane_shear(state: CellState, ice: Ice) -> Array:
    """Section 5.3: largest shear strain of the four axial connections times G against the shear strength."""
    G = ice.E / (2.0 * (1.0 + ice.nu))
    return np.asarray(np.abs(state.shear).max(axis=1) * G / ice.sigma_shear)
