"""Phases of a plate: rotating until its long axis has once aligned with a slope near by and it has left the sheet."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rubble.arrays import Array, Record, Records, record
from rubble.cut import distance_to, nearest
from rubble.moving import Moving, own_axes
from rubble.piece import Plate
from rubble.section import Section
from rubble.slices import Slices

#: of a plate: distance at which a slope counts [m], direction of its long axis [rad], period of that direction [rad]
AXIS = record("reach", "direction", "period")
SHEET = 4  #: column of `store.ON_PLATE`: normal impulse on the sheet


def update_phases(
    plates: Sequence[Plate],
    axes: Records,
    sums: Array,
    slices: Slices,
    sections: Sequence[Section],
    moving: Moving,
    tolerance: float,
) -> None:
    """Bring the phases of the plates up to date after a window.

    ``axes`` (n,) AXIS; ``sums`` (n, 9) of the window, `store.ON_PLATE`; ``tolerance`` [rad].
    """
    for i, plate in enumerate(plates):
        if plate.sliding:
            continue
        if not plate.aligned:
            own = slices.section[slices.plate == i]
            plate.aligned = any(_aligned(plate, axes[i], sections[s], moving, tolerance) for s in own.tolist())
        if plate.aligned and sums[i, SHEET] <= 0.0:
            plate.sliding = True


def _aligned(plate: Plate, axis: Record, section: Section, moving: Moving, tolerance: float) -> bool:
    """Whether a plate lies along the slope of a section that is nearest to it, if one is near."""
    slopes = section.slopes
    if len(slopes) == 0:
        return False
    x, z = own_axes(moving, section.y, float(plate.position[0]), float(plate.position[2]))
    face = slopes[nearest(slopes, x, z)]
    if distance_to(face, x, z) > axis["reach"]:
        return False
    slope = np.arctan2(face["z1"] - face["z0"], face["x1"] - face["x0"]) - moving.place[4]
    turn, period = axis["direction"] + plate.angle - slope, axis["period"]
    return bool(abs((turn + period / 2) % period - period / 2) <= tolerance)
