"""A series: loads over time, wherever they come from. SI, signs as everywhere: force of the ice on the structure."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cosim.analysis.run_data import AXES, COMPONENTS, RunData
from cosim.analysis.sustained import running_mean
from coupling.interface import NS, Array


@dataclass(frozen=True)
class Series:
    """Components of a load over time, t ascending."""

    name: str
    t: Array  #: (n,) [s]
    loads: dict[str, Array]  #: (n,) by component fx, fy, fz, f [N]
    told: tuple[str, ...] = ()  #: what was repaired, chosen and done, line by line
    begin: Array | None = None  #: (n,) loads are constant from here to t [s]; None: straight between the values

    def timed(self, factor: float, later: float = 0.0) -> Series:
        """Times by a factor, then all of it later [s]."""
        begin = None if self.begin is None else factor * self.begin + later
        return replace(self, t=factor * self.t + later, begin=begin)

    def between(self, first: float, last: float) -> Series:
        """The part between two times, both included, to the nanosecond."""
        chosen = (self.t >= first - 1.0 / NS) & (self.t <= last + 1.0 / NS)
        begin = None if self.begin is None else self.begin[chosen]
        return replace(self, t=self.t[chosen], loads={n: y[chosen] for n, y in self.loads.items()}, begin=begin)

    def mean_over(self, seconds: float) -> Series:
        """Means over the last ``seconds``; 0: values as they are, those of windows at their middles.

        Before the first one its value is taken, before the first window nothing. The same mean as
        `cosim.analysis.sustained.running_mean` takes of a run.
        """
        begin = self.begin
        if begin is not None and seconds > 0.0:
            ns = [np.rint(v * NS).astype(np.int64) for v in (begin, self.t)]
            loads = {n: running_mean(ns[0], ns[1], y, seconds) for n, y in self.loads.items()}
            return replace(self, loads=loads, begin=None)
        if begin is not None:
            return replace(self, t=0.5 * (begin + self.t), begin=None)
        if seconds <= 0.0 or len(self.t) < 2:
            return self
        return replace(self, loads={n: _mean(self.t, y, seconds) for n, y in self.loads.items()})


def _mean(t: Array, y: Array, seconds: float) -> Array:
    """Running mean of straight pieces; the integral inside a piece is a parabola."""
    steps = np.diff(t)
    whole = np.concatenate(([0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * steps)))
    begin = t - seconds
    k = np.clip(np.searchsorted(t, begin, side="right") - 1, 0, len(t) - 2)
    s = np.maximum(begin - t[k], 0.0)
    before = whole[k] + s * (y[k] + 0.5 * s * (y[k + 1] - y[k]) / steps[k])
    before -= y[0] * np.maximum(t[0] - begin, 0.0)
    return np.asarray((whole - before) / seconds)


def of_run(run: RunData, seconds: float) -> Series:
    """Loads of a run as means over ``seconds``, at the ends of the windows; 0: of windows, at their middles."""
    taken = run.averaged(seconds)
    t = run.t if seconds > 0.0 else (run.t_ns + run.begin_ns) / 2e9
    return Series(run.name, np.asarray(t), {name: taken.component(name) for name in COMPONENTS})


def as_series(run: RunData) -> Series:
    """A run in the place of a measured series: components that are not zero, constant in each window."""
    loads = {name: run.component(name) for name in AXES if np.any(run.component(name))}
    return Series(run.name, run.t, loads, begin=run.begin_ns / NS)
