"""Joints: what test rigs hold plates with; a run has none."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray
from rubble.compiled import compiled
from rubble.gather import Scene
from rubble.plates import times
from rubble.rows import HOLDS, JOINT, Rows, set_way

TAKEN_OUT = 0.1  #: share of the gap in a joint that is closed in a sub-step


class Joints(NamedTuple):
    """Moment-free connections of plates with points that move at given velocities."""

    plate: IntArray  #: (j,)
    place: Array  #: (j, 3) in the plate's axes [m]
    anchor: Array  #: (j, 3) the other point, now [m]
    velocity: Array  #: (j, 3) with which it moves [m/s]


def no_joints() -> Joints:
    """None."""
    return Joints(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)))


@compiled(nogil=True, borrows=True)
def joint_rows(scene: Scene, joints: Joints, rows: Rows, old: Rows, found: int, before: int) -> int:
    """Adds a row for each joint, held in three directions; returns the number of rows, -1 if there is no room.

    ``old`` has ``before`` rows, of which the last are those of the joints.
    """
    plates, n = scene.plates, joints.plate.shape[0]
    if found + n > rows.point.shape[0]:
        return -1
    for j in range(n):
        c, i, b, o = found + j, joints.plate[j], joints.place[j], before - n + j
        x, y, z = times(plates.rotation[i], b[0], b[1], b[2])
        point = rows.point[c]
        point.x, point.y, point.z = plates.position[i, 0] + x, plates.position[i, 1] + y, plates.position[i, 2] + z
        point.a, point.b, point.edge, point.kind = plates.moved.shape[0] - 1, i, -1, JOINT
        point.slot_a, point.slot_b, point.feature = -4, j, 0
        point.mu, point.depth, point.most, point.shift_speed = HOLDS, 0.0, np.inf, 0.0
        for d in range(3):
            way = rows.way[c, d]
            set_way(way, 1.0 if d == 0 else 0.0, 1.0 if d == 1 else 0.0, 1.0 if d == 2 else 0.0)
            joints.anchor[j, d] += scene.dt * joints.velocity[j, d]
            gap = joints.anchor[j, d] - (point.x if d == 0 else (point.y if d == 1 else point.z))
            way.target = joints.velocity[j, d] + TAKEN_OUT * gap / scene.dt
            way.impulse = old.way[o, d].impulse if o >= 0 and old.point[o].kind == JOINT else 0.0
    return int(found + n)
