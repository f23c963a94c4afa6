"""Peaks of a load: which, when, how high, and how often a height is passed.

Plain functions of times (n,) [s] and loads (n,) [N] of one sign of interest: a load that is mostly negative is turned
before (`cosim.series.metrics`). None or an empty array is an answer: there are no peaks.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.signal import find_peaks

from coupling.interface import Array, IntArray


def peaks(y: Array, above: float, prominence: float) -> IntArray:
    """Places (m,) of local maxima above ``above`` [N] that stand out by ``prominence`` [N].

    Prominence: height over the higher of the two lowest points between the peak and the next higher one on either side
    (scipy.signal.find_peaks). More prominence, fewer peaks; 0 takes every local maximum.
    """
    found, _ = find_peaks(y, height=above, prominence=prominence)
    return np.asarray(found)


def time_to_first_peak(t: Array, at: IntArray, start: float) -> float | None:
    """``t[first peak] - start`` [s], 0 or more if the start is the first contact."""
    return float(t[at[0]]) - start if len(at) else None


def mean_peak(y: Array, at: IntArray) -> float | None:
    """Mean of the peaks [N]."""
    return float(y[at].mean()) if len(at) else None


def level_between(y: Array, at: IntArray) -> float | None:
    """Mean over the lowest loads between neighbouring peaks [N]; None with fewer than two peaks.

    The load that stays when the ice has broken and new ice has not yet built up; a run knows it by phases as well
    (`cosim.analysis.features.level_between_peaks`), a measurement does not.
    """
    if len(at) < 2:
        return None
    return float(np.mean([y[a : b + 1].min() for a, b in pairwise(at)]))


def period_by_counting(t: Array, at: IntArray) -> float | None:
    """Median time between neighbouring peaks [s]; None with fewer than three peaks."""
    return float(np.median(np.diff(t[at]))) if len(at) > 2 else None


def period_by_crossing(t: Array, y: Array) -> float | None:
    """Mean time between up-crossings of the mean [s], of the first to the last one; None with fewer than two.

    The mean zero-crossing period T_z of wave statistics (IAHR list of sea state parameters, 1986).
    """
    z = y - y.mean()
    up = np.flatnonzero((z[:-1] < 0.0) & (z[1:] >= 0.0))
    if len(up) < 2:
        return None
    at = t[up] + (t[up + 1] - t[up]) * z[up] / (z[up] - z[up + 1])
    return float((at[-1] - at[0]) / (len(up) - 1))


def exceedance(values: Array) -> tuple[Array, Array]:
    """Heights (m,) [N], ascending, and the share of peaks that exceed each, in (0, 1).

    ``1 - i / (m + 1)`` of the i-th smallest (Weibull's plotting position, Gumbel 1958, 1.2.7).
    """
    ordered = np.sort(values)
    return ordered, 1.0 - np.arange(1, len(ordered) + 1) / (len(ordered) + 1)
