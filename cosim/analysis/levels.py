"""Levels of a load over a span of time, and of its cycles, as plain functions like those of `features`.

Spans count from first contact [s]; where a quantile is taken, it is of time, whatever the length of the windows. Peaks
are those of `peaks_of`, one definition for period, height and trough.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from cosim.analysis.instants import peaks_in, within
from cosim.analysis.run_data import RunData
from coupling.interface import Array, IntArray


def load_mean(
    run: RunData, component: str = "fx", phase: str | None = None, begin: float = 0.0, end: float | None = None
) -> float | None:
    """Mean over ``begin`` to ``end`` [N]; None if the run is not as long as ``begin``."""
    chosen = within(run, begin, end)
    if not chosen.any():
        return None
    length = (run.t_ns - run.begin_ns)[chosen]
    return float(np.average(run.component(component, phase)[chosen], weights=length))


def load_quantile(
    run: RunData,
    share: float = 0.9,
    component: str = "fx",
    phase: str | None = None,
    begin: float = 0.0,
    end: float | None = None,
) -> float | None:
    """The load [N] below which it is for ``share`` of the time from ``begin`` to ``end``."""
    chosen = within(run, begin, end)
    if not chosen.any():
        return None
    load, length = run.component(component, phase)[chosen], (run.t_ns - run.begin_ns)[chosen]
    order = np.argsort(load, kind="stable")
    passed = np.cumsum(length[order])
    return float(load[order][min(int(np.searchsorted(passed, share * passed[-1])), len(load) - 1)])


def peaks_of(
    run: RunData, component: str, begin: float, prominence: float, smooth: float
) -> tuple[IntArray, Array, float]:
    """Places of the peaks, the load (n,) [N] at even distances, and that distance [s].

    As `instants.peaks_in`, of the load after ``begin``.
    """
    chosen = within(run, begin, None)
    return peaks_in(run.t_ns[chosen], run.component(component)[chosen], prominence, smooth)


def peak_quantile(
    run: RunData,
    share: float = 0.5,
    component: str = "fx",
    begin: float = 0.0,
    prominence: float = 0.2,
    smooth: float = 0.1,
) -> float | None:
    """The quantile ``share`` of the heights of the peaks [N]: the median by default; None without a peak."""
    places, load, _ = peaks_of(run, component, begin, prominence, smooth)
    return float(np.quantile(load[places], share)) if len(places) else None


def peak_interval(
    run: RunData,
    share: float = 0.5,
    component: str = "fx",
    begin: float = 0.0,
    prominence: float = 0.2,
    smooth: float = 0.1,
) -> float | None:
    """The quantile ``share`` of the times between peaks [s]: the median by default; None with fewer than three."""
    places, _, step = peaks_of(run, component, begin, prominence, smooth)
    return float(np.quantile(np.diff(places), share)) * step if len(places) > 2 else None


def trough_load(
    run: RunData, component: str = "fx", begin: float = 0.0, prominence: float = 0.2, smooth: float = 0.1
) -> float | None:
    """Median of the lowest loads between two peaks [N]; None with fewer than two peaks."""
    places, load, _ = peaks_of(run, component, begin, prominence, smooth)
    lowest = [load[a:b].min() for a, b in pairwise(places)]
    return float(np.median(lowest)) if lowest else None
