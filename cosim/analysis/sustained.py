"""What a peak is: the largest mean load over an averaging time, the same wherever a peak is told.

Blocks are rigid, so that a collision hands over its whole impulse in one sub-step: the load of a single window is
the impulse over the length that the window happens to have. A structure answers to what lasts for a part of its own
period, and so did the scales of the basin. So every peak is one of a running mean, and its time is told beside it.

The time is `recording.averaging` of the scenario. Its default follows Froude's law from the thickness of the ice, so
that a model and its prototype have the same dimensionless peaks: half a second for ice of 1 m.
"""

from __future__ import annotations

import math

import numpy as np

from coupling.interface import NS, Array, IntArray

USUAL, AT_THICKNESS, AT_GRAVITY = 0.5, 1.0, 9.81  #: [s] for ice of [m] at [m/s2]


def averaging_time(thickness: float, gravity: float = AT_GRAVITY) -> float:
    """Averaging time of ice of this thickness [m] where a scenario does not say one [s]."""
    return USUAL * math.sqrt(thickness / AT_THICKNESS * AT_GRAVITY / gravity)


def running_mean(begin_ns: IntArray, end_ns: IntArray, load: Array, seconds: float) -> Array:
    """Mean load (n, ...) over the last ``seconds`` before the end of each window, nothing before the first one.

    ``begin_ns``, ``end_ns`` (n,) of windows without gaps; ``load`` (n, ...) is the mean over each.
    """
    if not len(end_ns):
        return load
    flat = load.reshape(len(load), -1)
    edges = np.concatenate((begin_ns[:1], end_ns)) / NS
    impulse = np.concatenate((np.zeros((1, flat.shape[1])), np.cumsum(np.diff(edges)[:, None] * flat, axis=0)))
    end = edges[1:]
    before = np.stack([np.interp(end - seconds, edges, column) for column in impulse.T], axis=1)
    return np.asarray(((impulse[1:] - before) / seconds).reshape(load.shape))


def at_event(end_ns: IntArray, mean: Array, t_ns: int) -> Array:
    """Mean load (3,) at an event: at the end of its window or of the one before, the larger one; never above a peak.

    ``mean`` (n, 3) is that of `running_mean` over all phases. The load drops inside the window of the event.
    """
    k = min(int(np.searchsorted(end_ns, t_ns)), len(end_ns) - 1)
    around = mean[max(k - 1, 0) : k + 1]
    return np.asarray(around[int(np.linalg.norm(around, axis=1).argmax())])
