"""Phases of a plate: rotating until its long axis has once aligned with a slope near by and it has left the sheet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, BoolArray, IntArray, Records, record
from rubble.compiled import compiled
from rubble.cut import distance_to, nearest
from rubble.moving import Moving, own_axes
from rubble.piece import Plate
from rubble.plates import Plates
from rubble.slices import Slices

#: of a plate: distance at which a slope counts [m], direction of its long axis [rad], period of that direction [rad]
AXIS = record("reach", "direction", "period")
SHEET = 4  #: column of `store.ON_PLATE`: normal impulse on the sheet


class Slopes(NamedTuple):
    """`cut.Cut.slopes` of all sections, one after the other."""

    y: Array  #: (k,) planes of the sections [m]
    faces: Records  #: FACE
    offset: IntArray  #: (k + 1,) section i has the faces offset[i] to offset[i + 1]
    tolerance: float  #: of an alignment [rad]


def update_phases(
    list_: Sequence[Plate],
    plates: Plates,
    axes: Records,
    sums: Array,
    slices: Slices,
    slopes: Slopes,
    moving: Moving,
) -> None:
    """Bring the phases of the plates up to date after a window.

    ``axes`` (n,) AXIS; ``sums`` (n, 9) of the window, `store.ON_PLATE`.
    """
    aligned = np.array([p.aligned or p.sliding for p in list_], np.bool_)
    before = aligned.copy()
    _align(aligned, plates, axes, slices, slopes, moving)
    for i in np.flatnonzero(aligned & ~before).tolist():
        list_[i].aligned = True
    for i in np.flatnonzero(aligned & (sums[:, SHEET] <= 0.0)).tolist():
        list_[i].sliding = True


@compiled(nogil=True)
def _align(aligned: BoolArray, plates: Plates, axes: Records, slices: Slices, slopes: Slopes, moving: Moving) -> None:
    """Marks plates that lie along the slope of a section that is nearest to them, if one is near."""
    for s in range(slices.plate.shape[0]):
        k, i = slices.plate[s], slices.section[s]
        first, end = slopes.offset[i], slopes.offset[i + 1]
        if aligned[k] or first == end:
            continue
        r, axis = plates.rotation[k], axes[k]
        x, z = own_axes(moving, slopes.y[i], plates.position[k, 0], plates.position[k, 2])
        face = slopes.faces[first + nearest(slopes.faces[first:end], x, z)]
        if distance_to(face, x, z) > axis.reach:
            continue
        slope = np.arctan2(face.z1 - face.z0, face.x1 - face.x0) - moving.place[4]
        turn, period = axis.direction + np.arctan2(r[2, 0], r[0, 0]) - slope, axis.period
        aligned[k] = abs((turn + period / 2) % period - period / 2) <= slopes.tolerance
