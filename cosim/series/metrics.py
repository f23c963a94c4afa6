"""All metrics by name: of one series for both, and of the aligned pair. A new one is one line here.

Peaks are those above a share of the largest load of the measured series, the same heights in newtons for both. A series
whose largest load is negative is turned before peaks are counted, and the results are turned back.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cosim.analysis.instants import largest
from cosim.series import agreement, extremes, fatigue, spectra
from cosim.series import peaks as of_peaks
from cosim.series.align import contact_time
from cosim.series.description import Metrics
from coupling.interface import Array, IntArray


@dataclass(frozen=True)
class Look:
    """One series ready for its metrics."""

    t: Array  #: (n,) [s]
    y: Array  #: (n,) [N], turned so that the largest is positive
    sign: float  #: by which it was turned
    peaks: IntArray  #: places of the peaks
    threshold: float  #: of the peaks [N]
    stands_out: float  #: by how much they stand out at least [N]
    start: float  #: first contact [s]
    given: Metrics

    @property
    def duration(self) -> float:
        """Of the series [s]."""
        return float(self.t[-1] - self.t[0])

    @cached_property
    def extreme(self) -> extremes.Extreme | None:
        """Of the highest peaks, those above a share of them: where peaks begin to count is no beginning of a tail."""
        g, heights = self.given, self.y[self.peaks]
        if not len(heights):
            return None
        threshold = float(np.quantile(heights, g.below_tail))
        tail = heights[heights > threshold]
        return extremes.of_peaks(tail, threshold, len(tail) / self.duration, g.return_period, g.confidence)


def look(t: Array, y: Array, largest_measured: float, contact: float, given: Metrics) -> Look:
    """A series with its peaks, by heights of the measured one; ``contact`` is a share of its own largest."""
    sign = -1.0 if largest_measured < 0.0 else 1.0
    size = abs(largest_measured)
    turned = sign * y
    found = of_peaks.peaks(turned, given.above * size, given.prominence * size)
    start = contact_time(t, turned, contact) if np.any(y) else float(t[0])
    return Look(t, turned, sign, found, given.above * size, given.prominence * size, start, given)


def _load(function: Callable[[Look], float | None]) -> Callable[[Look], float | None]:
    """A load in the sign of the series."""

    def turned(s: Look) -> float | None:
        value = function(s)
        return None if value is None else s.sign * value

    return turned


def _quantile(share: float) -> Callable[[Look], float | None]:
    return _load(lambda s: float(np.quantile(s.y, share)))


#: of one series: unit and function
SINGLE: dict[str, tuple[str, Callable[[Look], float | None]]] = {
    "largest": ("N", _load(lambda s: float(s.y[largest(s.y)]))),
    "mean": ("N", _load(lambda s: float(np.trapezoid(s.y, s.t) / s.duration))),
    "std": ("N", lambda s: float(np.std(s.y))),
    "quantile_50": ("N", _quantile(0.5)),
    "quantile_95": ("N", _quantile(0.95)),
    "quantile_99": ("N", _quantile(0.99)),
    "peaks": ("-", lambda s: float(len(s.peaks))),
    "mean_peak": ("N", _load(lambda s: of_peaks.mean_peak(s.y, s.peaks))),
    "time_to_first_peak": ("s", lambda s: of_peaks.time_to_first_peak(s.t, s.peaks, s.start)),
    "level_between_peaks": ("N", _load(lambda s: of_peaks.level_between(s.y, s.peaks))),
    "period_by_counting": ("s", lambda s: of_peaks.period_by_counting(s.t, s.peaks)),
    "period_by_crossing": ("s", lambda s: of_peaks.period_by_crossing(s.t, s.y)),
    "period_by_spectrum": ("s", lambda s: spectra.period_by_spectrum(s.t, s.y)),
    "cycles_per_second": ("Hz", lambda s: fatigue.cycle_rate(s.y, s.duration, s.stands_out)),
    "damage_equivalent_load": (
        "N",
        lambda s: fatigue.damage_equivalent_load(s.y, s.duration, s.given.wohler, s.given.rate),
    ),
    "return_level": ("N", _load(lambda s: None if (e := s.extreme) is None else e.level)),
    "return_level_low": ("N", _load(lambda s: None if (e := s.extreme) is None else e.low)),
    "return_level_high": ("N", _load(lambda s: None if (e := s.extreme) is None else e.high)),
}
#: of the aligned pair, simulated and measured: unit, best value and function
PAIR: dict[str, tuple[str, float, Callable[[Array, Array], float | None]]] = {
    "slope": ("-", 1.0, agreement.slope),
    "correlation": ("-", 1.0, agreement.correlation),
    "bias": ("N", 0.0, agreement.bias),
    "mean_absolute_error": ("N", 0.0, agreement.mean_absolute_error),
    "rms_error": ("N", 0.0, agreement.rms_error),
    "scatter_index": ("-", 0.0, agreement.scatter_index),
    "efficiency": ("-", 1.0, agreement.efficiency),
    "index_of_agreement": ("-", 1.0, agreement.index_of_agreement),
    "wasserstein": ("N", 0.0, agreement.wasserstein),
    "kolmogorov_smirnov": ("-", 0.0, agreement.kolmogorov_smirnov),
}
