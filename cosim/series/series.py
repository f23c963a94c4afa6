"""A series: loads over time, wherever they come from. SI, signs as everywhere: force of the ice on the structure."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cosim.analysis.run_data import COMPONENTS, RunData
from coupling.interface import Array


@dataclass(frozen=True)
class Series:
    """Components of a load over time, t ascending."""

    name: str
    t: Array  #: (n,) [s]
    loads: dict[str, Array]  #: (n,) by component fx, fy, fz, f [N]
    told: tuple[str, ...] = ()  #: what was repaired, chosen and done, line by line

    def later(self, seconds: float) -> Series:
        """The same, all of it later."""
        return replace(self, t=self.t + seconds)

    def between(self, begin: float, end: float) -> Series:
        """The part between two times, both included."""
        chosen = (self.t >= begin) & (self.t <= end)
        return replace(self, t=self.t[chosen], loads={name: y[chosen] for name, y in self.loads.items()})

    def mean_over(self, seconds: float) -> Series:
        """Means over the last ``seconds``, straight between the samples; 0: as it is.

        Before the first one its value is taken. The same mean as `cosim.analysis.sustained.running_mean` takes of a
        run, whose loads are constant in a window.
        """
        if seconds <= 0.0 or len(self.t) < 2:
            return self
        return replace(self, loads={name: _mean(self.t, y, seconds) for name, y in self.loads.items()})


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
