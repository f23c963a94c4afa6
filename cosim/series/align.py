"""A series laid on a run: by first contact, by the largest load, an event, cross-correlation, or by hand. Told.

The shift says by how much the series is later than the run [s]; its times less the shift are times of the run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.signal import correlate, find_peaks

from cosim.analysis.instants import first_event, largest
from cosim.analysis.run_data import RunData
from cosim.series.description import Align
from cosim.series.sensor import factors
from cosim.series.series import Series
from cosim.series.told import SeriesError
from coupling.interface import NS, Array

MOST = 1_000_000  #: values of a correlation
CLOSE = 0.05  #: a second maximum of the correlation so close to the first one is told
WEAK = 0.5  #: so is a correlation below this


@dataclass(frozen=True)
class Alignment:
    """How series and run lie on each other."""

    by: str
    component: str
    shift: float  #: series later than the run [s]
    told: str
    marks: tuple[float | None, float | None] = (
        None,
        None,
    )  #: what was laid on what: time of the run, of the series [s]
    lags: Array | None = None  #: (n,) shifts [s] of a correlation
    correlation: Array | None = None  #: (n,) at these


def align(run: RunData, simulated: Series, measured: Series, given: Align, scale: float = 1.0) -> Alignment:
    """The alignment that the description asks for; ``scale`` is the factor of lengths of the series."""
    component: str = given.component or next(name for name in measured.loads)
    if component not in measured.loads:
        raise SeriesError(f"align.component = {component!r}: the series has {', '.join(measured.loads)}")
    a, b = (simulated.t, simulated.loads[component]), (measured.t, measured.loads[component])
    if given.by == "hand":
        return Alignment("hand", component, float(given.shift), f"aligned by hand: series later by {given.shift:g} s")
    if given.by == "correlation":
        return _by_correlation(a, b, component)
    if given.by == "event":
        event = first_event(run, str(given.event))
        if event is None:
            raise SeriesError(f"{run.name}: no event {given.event!r} to align with; `cosim info --events` lists them")
        here, there = event.t_ns / NS, float(given.at or 0.0) * factors(scale)[0]
        what = f"first {given.event}"
    else:
        finder, what = BY[given.by]
        here, there = (finder(t, y, given.threshold) for t, y in (a, b))
        what = what.format(component=component, threshold=100.0 * given.threshold)
    text = f"aligned by {what}: {here:.3f} s in the run, {there:.3f} s in the series, later by {there - here:.3f} s"
    return Alignment(given.by, component, there - here, text, (here, there))


def contact_time(t: Array, y: Array, threshold: float) -> float:
    """First time at which the load exceeds a share of its largest, straight between the values [s]."""
    level = threshold * float(np.abs(y).max())
    above = np.flatnonzero(np.abs(y) > level)
    if not len(above):
        raise SeriesError("no load to align by; choose another component or align.by")
    k = int(above[0])
    if k == 0:
        return float(t[0])
    before, now = abs(float(y[k - 1])), abs(float(y[k]))
    return float(t[k - 1] + (t[k] - t[k - 1]) * (level - before) / (now - before))


def _peak_time(t: Array, y: Array, _threshold: float) -> float:
    return float(t[largest(y)])


#: by name: what finds the time, and its words
BY: dict[str, tuple[Callable[[Array, Array, float], float], str]] = {
    "contact": (contact_time, "first contact ({component} above {threshold:g} % of its largest)"),
    "peak": (_peak_time, "the largest {component}"),
}


def correlations(x: Array, y: Array, least: int) -> tuple[Array, Array]:
    """Pearson's r (m,) of ``x[i]`` and ``y[i + lag]`` over their overlap, for all lags (m,) with ``least`` values."""
    x, y = x - x.mean(), y - y.mean()
    one_x, one_y = np.ones(len(x)), np.ones(len(y))

    def sums(u: Array, v: Array) -> Array:
        return np.asarray(correlate(v, u, mode="full", method="fft"))

    n = np.maximum(np.rint(sums(one_x, one_y)), 1.0)
    mean_x, mean_y = sums(x, one_y) / n, sums(one_x, y) / n
    covariance = sums(x, y) / n - mean_x * mean_y
    variance = (sums(x * x, one_y) / n - mean_x**2) * (sums(one_x, y * y) / n - mean_y**2)
    floor = 1e-12 * x.var() * y.var()
    r = np.where(variance > floor, covariance / np.sqrt(np.maximum(variance, floor or 1.0)), 0.0)
    lags = np.arange(len(r)) - (len(x) - 1)
    return np.asarray(lags[n >= least], dtype=float), np.asarray(r[n >= least])


def _by_correlation(a: tuple[Array, Array], b: tuple[Array, Array], component: str) -> Alignment:
    """The shift of the largest correlation over at least half of the shorter one, a parabola through its maximum."""
    span = max(np.ptp(a[0]), np.ptp(b[0]))
    step = max(min(float(np.median(np.diff(t))) for t, _ in (a, b)), float(span) / MOST)
    x, y = (np.interp(np.arange(t[0], t[-1], step), t, v) for t, v in (a, b))
    if min(np.ptp(x), np.ptp(y)) == 0.0:
        raise SeriesError(f"{component} does not change: nothing to correlate; choose another align.component")
    lags, r = correlations(x, y, min(len(x), len(y)) // 2)
    k = int(r.argmax())
    at = float(lags[k])
    if 0 < k < len(r) - 1 and (bend := r[k - 1] - 2 * r[k] + r[k + 1]) < 0:
        at += 0.5 * float((r[k - 1] - r[k + 1]) / bend)
    origin = float(b[0][0] - a[0][0])
    shift = origin + step * at
    text = f"aligned by correlation of {component}: series later by {shift:.3f} s, r = {r[k]:.3f}"
    peaks, _ = find_peaks(r, height=r[k] - CLOSE, prominence=CLOSE / 2)
    if len(others := peaks[peaks != k]):
        second = others[r[others].argmax()]
        text += f"; nearly as good: {origin + step * lags[second]:.3f} s with r = {r[second]:.3f}"
    if r[k] < WEAK:
        text += "; a weak correlation, another way to align is safer"
    return Alignment("correlation", component, shift, text, lags=origin + step * lags, correlation=r)
