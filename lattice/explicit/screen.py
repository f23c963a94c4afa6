"""The combined tensile criterion in every sub-step: a quick look whether any face of a cell has reached its limit.

It repeats `criteria.laws.combined_tension` without leaving the arrays of the loops; a test holds the two together.
What it finds is judged by `criteria.judge` like everything else.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.criteria.mohr import bending_fibre, mohr_factors
from lattice.explicit.layout import PHI_X, PHI_Y, U_X, U_Y, Motion
from lattice.grid import Array
from lattice.ice import Ice


class Screen(NamedTuple):
    """Constants of (4.6) with (4.17)-(4.20)."""

    F_1: float
    fibre: float  #: h/2 sigma_t / sigma_f [m]


def screen_of(ice: Ice) -> Screen:
    """Constants for this ice."""
    return Screen(_factors(ice)[0], bending_fibre(ice))


def thresholds(limits: Array, ice: Ice, d: float) -> Array:
    """What F_1 mean + R is compared with, for tensile limits [Pa], as sums of node differences [m]."""
    return 4.0 * d * _factors(ice)[1] * limits / ice.E


def _factors(ice: Ice) -> tuple[float, float]:
    return mohr_factors(ice.nu, np.inf if np.isinf(ice.sigma_t) else ice.sigma_c / ice.sigma_t)


@compiled(nogil=True)
def overloaded(motion: Motion, threshold: Array, screen: Screen, alpha: float) -> int:
    """How many faces of cells reach F_1 mean + R >= threshold, (4.6) with (4.17)-(4.20); what is not a number counts.

    Strains are left as sums of node differences, 4 d times those of `strain.mean_strains`; so is ``threshold``.
    """
    y, v, f, fibre, count = motion.y, motion.v, screen.F_1, screen.fibre, 0
    for i in range(threshold.shape[0]):
        for j in range(threshold.shape[1]):
            d0x = y[U_X, i + 1, j + 1] - y[U_X, i, j] - alpha * (v[U_X, i + 1, j + 1] - v[U_X, i, j])
            d0y = y[U_Y, i + 1, j + 1] - y[U_Y, i, j] - alpha * (v[U_Y, i + 1, j + 1] - v[U_Y, i, j])
            d1x = y[U_X, i + 1, j] - y[U_X, i, j + 1] - alpha * (v[U_X, i + 1, j] - v[U_X, i, j + 1])
            d1y = y[U_Y, i + 1, j] - y[U_Y, i, j + 1] - alpha * (v[U_Y, i + 1, j] - v[U_Y, i, j + 1])
            r0x = y[PHI_X, i + 1, j + 1] - y[PHI_X, i, j] - alpha * (v[PHI_X, i + 1, j + 1] - v[PHI_X, i, j])
            r0y = y[PHI_Y, i + 1, j + 1] - y[PHI_Y, i, j] - alpha * (v[PHI_Y, i + 1, j + 1] - v[PHI_Y, i, j])
            r1x = y[PHI_X, i + 1, j] - y[PHI_X, i, j + 1] - alpha * (v[PHI_X, i + 1, j] - v[PHI_X, i, j + 1])
            r1y = y[PHI_Y, i + 1, j] - y[PHI_Y, i, j + 1] - alpha * (v[PHI_Y, i + 1, j] - v[PHI_Y, i, j + 1])
            e11, e22, e12 = d0x + d1x, d0y - d1y, d0y + d1y + d0x - d1x
            k11, k22, k12 = fibre * (r0x + r1x), fibre * (r0y - r1y), fibre * (r0y + r1y + r0x - r1x)
            mean, bend = e11 + e22, k11 + k22
            top = f * (mean + bend) + math.sqrt((e11 - e22 + k11 - k22) ** 2 + (e12 + k12) ** 2)
            bottom = f * (mean - bend) + math.sqrt((e11 - e22 - k11 + k22) ** 2 + (e12 - k12) ** 2)
            count += int(not top < threshold[i, j]) + int(not bottom < threshold[i, j])
    return count
