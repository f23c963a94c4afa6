"""Phases of a block: rotating until its long axis has once aligned with a slope near by and it has left the sheet."""

from __future__ import annotations

import numpy as np

from rubble.compiled import compiled
from rubble.geometry import Array, IntArray

ROTATING, SLIDING = 1, 2  #: numbers of `coupling.interface.Phase`


@compiled(
    "bool_(float64[:, ::1], float64[:, ::1], float64[:, ::1], float64[:, ::1], float64, int64[:, ::1])",
    nogil=True,
)
def update_phases(slopes: Array, axes: Array, state: Array, sums: Array, tolerance: float, status: IntArray) -> bool:
    """Bring ``status`` (n, 2), aligned and phase, up to date; says whether anything has changed.

    ``slopes`` (n, 2): angle and distance of the nearest slope; ``axes`` (n, 3): distance at which it counts, direction
    of the long axis, period of that direction; ``state`` as in `water`, ``sums`` as in `contacts`.
    """
    changed = False
    for i in range(status.shape[0]):
        if status[i, 1] != ROTATING:
            continue
        if status[i, 0] == 0 and slopes[i, 1] <= axes[i, 0]:
            turn, period = axes[i, 1] + state[i, 2] - slopes[i, 0], axes[i, 2]
            if np.abs((turn + period / 2) % period - period / 2) <= tolerance:
                status[i, 0], changed = 1, True
        if status[i, 0] == 1 and sums[i, 6] <= 0.0:
            status[i, 1], changed = SLIDING, True
    return changed
