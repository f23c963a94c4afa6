"""Phases of a block: rotating until its long axis has once aligned with a slope near by and it has left the sheet."""

from __future__ import annotations

import numpy as np

from rubble.arrays import Records, record
from rubble.compiled import compiled
from rubble.cut import distance_to, nearest

#: of a block: distance at which a slope counts [m], direction of its long axis [rad], period of that direction [rad]
AXIS = record("reach", "direction", "period")
#: whether its long axis has once aligned with a slope, and whether it slides; 0 or 1
STATUS = record(integers=("aligned", "sliding"))


@compiled(nogil=True)
def update_phases(
    slopes: Records, axes: Records, state: Records, impulses: Records, tolerance: float, status: Records
) -> bool:
    """Bring ``status`` (n,) up to date; says whether anything has changed.

    ``slopes`` are FACEs, at least one; ``impulses`` (n,) are those of the window, ON_BLOCK; ``tolerance`` [rad].
    """
    changed = False
    for i in range(status.shape[0]):
        own, axis, row = status[i], axes[i], state[i]
        if own.sliding == 1:
            continue
        face = slopes[nearest(slopes, row.x, row.z)]
        if own.aligned == 0 and distance_to(face, row.x, row.z) <= axis.reach:
            slope, period = np.arctan2(face.z1 - face.z0, face.x1 - face.x0), axis.period
            turn = axis.direction + row.angle - slope
            if np.abs((turn + period / 2) % period - period / 2) <= tolerance:
                own.aligned, changed = 1, True
        if own.aligned == 1 and impulses[i].sheet <= 0.0:
            own.sliding, changed = 1, True
    return changed
