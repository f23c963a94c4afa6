"""Error measures of aligned series, s simulated and m measured (n,) at the same times, and distances of distributions.

Best value and range stand with each. A measure that does not exist, as a correlation without change, is None.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import ks_2samp, wasserstein_distance

from coupling.interface import Array


def bias(s: Array, m: Array) -> float:
    """``mean(s - m)`` [N]; best 0, any."""
    return float(np.mean(s - m))


def mean_absolute_error(s: Array, m: Array) -> float:
    """``mean |s - m|`` [N]; best 0, 0 and above."""
    return float(np.mean(np.abs(s - m)))


def rms_error(s: Array, m: Array) -> float:
    """``mean((s - m)^2)^(1/2)`` [N]; best 0, 0 and above."""
    return float(np.sqrt(np.mean((s - m) ** 2)))


def scatter_index(s: Array, m: Array) -> float | None:
    """``rms((s - mean s) - (m - mean m)) / |mean m|`` [-]; best 0, 0 and above (Zambresky 1989)."""
    mean = abs(float(np.mean(m)))
    return float(np.std(s - m)) / mean if mean > 0.0 else None


def correlation(s: Array, m: Array) -> float | None:
    """Pearson's r [-]; best 1, from -1 to 1."""
    if np.std(s) == 0.0 or np.std(m) == 0.0:
        return None
    return float(np.corrcoef(s, m)[0, 1])


def efficiency(s: Array, m: Array) -> float | None:
    """``1 - sum (s - m)^2 / sum (m - mean m)^2`` [-]; best 1, below 0 worse than the mean (Nash and Sutcliffe 1970)."""
    spread = float(np.sum((m - np.mean(m)) ** 2))
    return 1.0 - float(np.sum((s - m) ** 2)) / spread if spread > 0.0 else None


def index_of_agreement(s: Array, m: Array) -> float | None:
    """``1 - sum (s - m)^2 / sum (|s - mean m| + |m - mean m|)^2`` [-]; best 1, from 0 to 1 (Willmott 1981)."""
    mean = np.mean(m)
    spread = float(np.sum((np.abs(s - mean) + np.abs(m - mean)) ** 2))
    return 1.0 - float(np.sum((s - m) ** 2)) / spread if spread > 0.0 else None


def slope(s: Array, m: Array) -> float | None:
    """``sum s m / sum m^2`` [-]: factor by which the measured series becomes the simulated one; best 1, any.

    Noise in m lowers it by ``1 + var(noise) / mean(m^2)``.
    """
    square = float(np.sum(m * m))
    return float(np.sum(s * m)) / square if square > 0.0 else None


def wasserstein(s: Array, m: Array) -> float:
    """``integral |F_s(x) - F_m(x)| dx`` of the distributions of the loads [N]; best 0, 0 and above.

    The first Wasserstein, or earth mover's, distance; it needs no alignment.
    """
    return float(wasserstein_distance(s, m))


def kolmogorov_smirnov(s: Array, m: Array) -> float:
    """``max |F_s(x) - F_m(x)|`` [-]; best 0, from 0 to 1. A distance; values of a series are no independent draws."""
    return float(ks_2samp(s, m, method="asymp").statistic)
