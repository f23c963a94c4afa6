"""Loads that last: means over half a second.

Blocks are rigid, so that a collision hands over its whole impulse in one sub-step: the load of a single window is
the impulse over the length that the window happens to have. A structure answers to what lasts for a part of its own
period, and so did the scales of the basin: half a second, full scale, is 83 ms there (Froude, factor 36).
"""

from __future__ import annotations

import numpy as np

from coupling.interface import NS, Array, IntArray

SUSTAINED = 0.5  #: [s]


def running_mean(begin_ns: IntArray, end_ns: IntArray, load: Array, seconds: float = SUSTAINED) -> Array:
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
