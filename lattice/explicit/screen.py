"""A tensile criterion in every sub-step: a quick look whether any face of a cell has reached its limit.

It repeats a law of `criteria.laws` without leaving the arrays of the loops; a test holds the two together. What it
finds is judged by `criteria.judge` like everything else. All laws of the form F_1 mean + R >= F_2 limit / E at the
faces can be looked at so, those of `SCREENED`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.criteria.laws import combined_tension, principal_stress
from lattice.criteria.mohr import bending_fibre, mohr_factors
from lattice.explicit.layout import PHI_X, PHI_Y, U_X, U_Y, Motion
from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import CellState

Judge = Callable[[CellState, Ice], Array]


class Screen(NamedTuple):
    """Constants of a law F_1 mean + R >= F_2 limit / E at the faces."""

    F_1: float
    fibre: Array  #: (n_x, n_y) height of the faces of cell (i, j) [m]; for (4.17)-(4.20) h/2 sigma_t / sigma_f


def _combined(ice: Ice) -> tuple[float, float]:
    """F_1 and F_2 of (4.6)."""
    return mohr_factors(ice.nu, np.inf if np.isinf(ice.sigma_t) else ice.sigma_c / ice.sigma_t)


def _principal(ice: Ice) -> tuple[float, float]:
    """The largest principal stress: (4.6) without an end in compression."""
    return mohr_factors(ice.nu, np.inf)


SCREENED: dict[Judge, Callable[[Ice], tuple[float, float]]] = {
    combined_tension: _combined,
    principal_stress: _principal,
}


def screen_of(ice: Ice, thick: Array, judge: Judge = combined_tension) -> Screen:
    """Constants of a law for this ice; ``thick`` (n_x, n_y) is the thickness of cells over that of the ice."""
    return Screen(SCREENED[judge](ice)[0], bending_fibre(ice) * thick)


def thresholds(limits: Array, ice: Ice, d: float, judge: Judge = combined_tension) -> Array:
    """What F_1 mean + R is compared with, for tensile limits [Pa], as sums of node differences [m]."""
    return 4.0 * d * SCREENED[judge](ice)[1] * limits / ice.E


@compiled(inline="always")
def membrane_sums(i: int, j: int, y: Array, v: Array, alpha: float) -> tuple[float, float, float]:
    """Twice d times the membrane strain of cell (i, j), shear in engineering measure [m]."""
    d0x = y[U_X, i + 1, j + 1] - y[U_X, i, j] - alpha * (v[U_X, i + 1, j + 1] - v[U_X, i, j])
    d0y = y[U_Y, i + 1, j + 1] - y[U_Y, i, j] - alpha * (v[U_Y, i + 1, j + 1] - v[U_Y, i, j])
    d1x = y[U_X, i + 1, j] - y[U_X, i, j + 1] - alpha * (v[U_X, i + 1, j] - v[U_X, i, j + 1])
    d1y = y[U_Y, i + 1, j] - y[U_Y, i, j + 1] - alpha * (v[U_Y, i + 1, j] - v[U_Y, i, j + 1])
    return d0x + d1x, d0y - d1y, d0y + d1y + d0x - d1x


@compiled(inline="always")
def reached(
    i: int, j: int, e: tuple[float, float, float], motion: Motion, screen: Screen, alpha: float, limit: float
) -> int:
    """How many faces of cell (i, j) with the `membrane_sums` e reach F_1 mean + R >= limit."""
    y, v, f, fibre, (e11, e22, e12) = motion.y, motion.v, screen.F_1, screen.fibre[i, j], e
    r0x = y[PHI_X, i + 1, j + 1] - y[PHI_X, i, j] - alpha * (v[PHI_X, i + 1, j + 1] - v[PHI_X, i, j])
    r0y = y[PHI_Y, i + 1, j + 1] - y[PHI_Y, i, j] - alpha * (v[PHI_Y, i + 1, j + 1] - v[PHI_Y, i, j])
    r1x = y[PHI_X, i + 1, j] - y[PHI_X, i, j + 1] - alpha * (v[PHI_X, i + 1, j] - v[PHI_X, i, j + 1])
    r1y = y[PHI_Y, i + 1, j] - y[PHI_Y, i, j + 1] - alpha * (v[PHI_Y, i + 1, j] - v[PHI_Y, i, j + 1])
    k11, k22, k12 = fibre * (r0x + r1x), fibre * (r0y - r1y), fibre * (r0y + r1y + r0x - r1x)
    mean, bend = e11 + e22, k11 + k22
    top, bottom = limit - f * (mean + bend), limit - f * (mean - bend)  # left for R, of which the square is known
    R_top, R_bottom = (e11 - e22 + k11 - k22) ** 2 + (e12 + k12) ** 2, (e11 - e22 - k11 + k22) ** 2 + (e12 - k12) ** 2
    return int(not ((top > 0.0) & (R_top < top * top))) + int(not ((bottom > 0.0) & (R_bottom < bottom * bottom)))


@compiled(nogil=True)
def overloaded(motion: Motion, threshold: Array, screen: Screen, alpha: float) -> int:
    """How many faces of cells reach F_1 mean + R >= threshold, (4.6) with (4.17)-(4.20); what is not a number counts.

    Strains are left as sums of node differences, 4 d times those of `strain.mean_strains`; so is ``threshold``.
    """
    count = 0
    for i in range(threshold.shape[0]):
        for j in range(threshold.shape[1]):
            e = membrane_sums(i, j, motion.y, motion.v, alpha)
            count += reached(i, j, e, motion, screen, alpha, threshold[i, j])
    return count
