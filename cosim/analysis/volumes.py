"""Rubble over time: fed from the sheet, stored in front of the structure, cleared past it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coupling.interface import NS, Array

POINTS = 200  #: at most so many times are told
LAST = 1.0 / 3.0  #: share of a run over whose end rates are taken


def volumes(
    t_ns: Sequence[int], stored: Sequence[float], cleared: Sequence[float], density: float
) -> dict[str, object]:
    """Volumes of ice [m3] at some windows, and rates of feed and clearing over the last third of the run [kg/s].

    ``stored`` and ``cleared`` are masses at the ends of windows (n,) [kg]. What is fed is what was stored at the end of
    the first window and all that has come since, less what blocks lose by crushing.
    """
    if not len(t_ns):
        return {}
    t, kept, gone = np.asarray(t_ns) / NS, np.asarray(stored, np.float64), np.asarray(cleared, np.float64)
    fed = kept + gone
    at = np.unique(np.linspace(0, len(t) - 1, min(len(t), POINTS)).astype(int))
    first = since(t, LAST)
    span = float(t[-1] - t[first])
    rates = {
        f"{name}_rate": float(mass[-1] - mass[first]) / span if span > 0.0 else 0.0
        for name, mass in (("feed", fed), ("clearing", gone))
    }
    series = {name: (mass[at] / density).tolist() for name, mass in (("fed", fed), ("stored", kept), ("cleared", gone))}
    return {"time": t[at].tolist(), **series, **rates}


def since(t: Array, last: float) -> int:
    """The window with whose end the last share of the time begins; ``t`` (n,) ends of windows [s]."""
    return int(np.searchsorted(t, t[-1] * (1.0 - last)))
