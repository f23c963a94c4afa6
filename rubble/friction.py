"""Coefficients of friction of a pair of bodies."""

from __future__ import annotations

import numpy as np

from rubble.compiled import compiled
from rubble.physics import RATE_DEPENDENT, Friction


@compiled("float64(float64)", nogil=True)
def rate_dependent(v: float) -> float:
    """Mu = 0.7 - 0.15 log10(v / 1e-6 m/s), between 1e-6 and 1e-2 m/s (Lishman and Polojarvi 2015)."""
    return 0.7 - 0.15 * np.log10(min(max(abs(v), 1e-6), 1e-2) / 1e-6)  # type: ignore[no-any-return]


def coefficient(mu: Friction) -> float:
    """The number of a law for the kernels: negative for the rate-dependent one."""
    return -1.0 if mu == RATE_DEPENDENT else float(mu)
