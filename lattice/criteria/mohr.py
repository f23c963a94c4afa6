"""Mohr's circle of the strain of cells, and the line (4.6) beyond which it means tensile failure.

Tension is positive. With z up and the rotation phi_x = -dw/dx of a thin plate, a fibre at height z has the strain
z d(phi_x)/dx; the top therefore carries +eta h/2 where the thesis, with its rotation reversed, writes -eta h/2 in
(4.17). The faces exchange names, the criterion is the same.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import Connections, Strains


class Circle(NamedTuple):
    """Mohr's circle of strain of some cells."""

    mean: Array  #: (cells,) [-]
    radius: Array  #: (cells,) [-]


class Faces(NamedTuple):
    """Circles at the two faces of the sheet."""

    top: Circle
    bottom: Circle


def mohr_factors(nu: float, strength_ratio: float) -> tuple[float, float]:
    """F_1 and F_2 of the tensile criterion (4.6), from Poisson's ratio and sigma_c / sigma_t."""
    q = 1.0 if np.isinf(strength_ratio) else (strength_ratio - 1.0) / (strength_ratio + 1.0)
    return (1.0 + nu) / (1.0 - nu) * q, (1.0 + q) * (1.0 + nu) / 2.0


def bending_fibre(ice: Ice) -> float:
    """Height h/2 sigma_t / sigma_f at which curvature counts like tension, (4.17)-(4.20) [m]."""
    if np.isinf(ice.sigma_t) and np.isinf(ice.sigma_f):
        return 0.5 * ice.h
    return 0.5 * ice.h * ice.sigma_t / ice.sigma_f


@compiled()
def _circle_at(strains: Strains, z: float) -> Circle:
    mean, radius = np.empty(len(strains.e11)), np.empty(len(strains.e11))
    for c in range(len(mean)):
        e11 = strains.e11[c] + z * strains.k11[c]
        e22 = strains.e22[c] + z * strains.k22[c]
        e12 = strains.e12[c] + z * strains.k12[c]
        mean[c] = 0.5 * (e11 + e22)
        radius[c] = np.sqrt((0.5 * (e11 - e22)) ** 2 + e12**2)
    return Circle(mean, radius)


@compiled()
def _circles(strains: Strains, fibre: float) -> Faces:
    return Faces(_circle_at(strains, fibre), _circle_at(strains, -fibre))


def circle(strains: Strains, z: float = 0.0) -> Circle:
    """Circle at height z above the middle of the sheet [m], (4.1), (4.2), (4.10)-(4.13)."""
    found: Circle = _circle_at(strains, z)
    return found


def faces(strains: Strains, ice: Ice) -> Faces:
    """Circles at top and bottom with curvature scaled by sigma_t / sigma_f, (4.17)-(4.20)."""
    found: Faces = _circles(strains, bending_fibre(ice))
    return found


def circle_of_connections(c: Connections) -> Circle:
    """Mean and radius averaged over the four connections beside a discontinuity, (4.24), (4.25)."""
    mean = 0.25 * (c.n11.sum(axis=1) + c.n22.sum(axis=1))
    radius = np.hypot(c.n11 - mean[:, None], c.s12).sum(axis=1) + np.hypot(c.n22 - mean[:, None], c.s21).sum(axis=1)
    return Circle(mean, 0.25 * radius)


def tensile_utilisation(circle: Circle, limit: Array | float, ice: Ice) -> Array:
    """(F_1 mean + R) / F_2 * E / limit of the tensile criterion (4.6); the cell fails at 1. ``limit`` in Pa."""
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / ice.sigma_t)
    return (F_1 * circle.mean + circle.radius) / F_2 * ice.E / limit
