"""Phases of a plate: rotating until its long axis has once aligned with a slope near by and it has left the sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rubble.arrays import record
from rubble.cut import distance_to, nearest

if TYPE_CHECKING:
    from rubble.sections import SectionTable
    from rubble.store import Store

#: of a plate: distance at which a slope counts [m], direction of its long axis [rad], period of that direction [rad]
AXIS = record("reach", "direction", "period")
#: whether its long axis has once aligned with a slope, and whether it slides; 0 or 1
STATUS = record(integers=("aligned", "sliding"))
SHEET = 4  #: column of `store.ON_PLATE`: normal impulse on the sheet


def update_phases(store: Store, sections: SectionTable, tolerance: float) -> None:
    """Bring the phases of the plates up to date after a window; ``tolerance`` [rad]."""
    tables, planes = store.tables, list(sections.by_key.values())
    for i, plate in enumerate(store.list):
        if plate.sliding:
            continue
        if not plate.aligned:
            own = np.flatnonzero(sections.slices.plate == i)
            x, y, z = plate.position
            for s in own.tolist():
                slopes = planes[sections.slices.section[s]].slopes
                if len(slopes) == 0:
                    continue
                face = slopes[nearest(slopes, x, z)]
                axis = tables.axes[i]
                if distance_to(face, x, z) > axis["reach"]:
                    continue
                slope = np.arctan2(face["z1"] - face["z0"], face["x1"] - face["x0"])
                turn = axis["direction"] + plate.angle - slope
                if abs((turn + axis["period"] / 2) % axis["period"] - axis["period"] / 2) <= tolerance:
                    plate.aligned = True
                    break
        if plate.aligned and tables.sums[i, SHEET] <= 0.0:
            plate.sliding = True
