"""Test rigs on plates: what verification needs and a run never uses."""

from __future__ import annotations

import numpy as np

from rubble.arrays import Array
from rubble.joints import Joints
from rubble.layer import RubbleLayer


class Hinge:
    """A moment-free connection of a plate with a point that moves at a given velocity."""

    def __init__(
        self, layer: RubbleLayer, block: int, point: tuple[float, float, float], velocity: tuple[float, float, float]
    ) -> None:
        """At ``point`` [m]; ``velocity`` [m/s]."""
        self._layer, self._number = layer, len(layer.joints.plate)
        plate, old = layer.block(block), layer.joints
        place = plate.rotation.T @ (np.array(point) - plate.position)
        layer.joints = Joints(
            np.append(old.plate, plate.row),
            np.vstack([old.place, place]),
            np.vstack([old.anchor, np.array(point, np.float64)]),
            np.vstack([old.velocity, np.array(velocity, np.float64)]),
        )

    @property
    def position(self) -> Array:
        """Where the hinge is now (3,) [m]."""
        at: Array = self._layer.joints.anchor[self._number]
        return at


def thrust(layer: RubbleLayer, block: int, force: tuple[float, float, float], moment: float = 0.0) -> None:
    """Press a plate with a constant force [N] at its centre and a moment from x towards z [N m]."""
    layer.block(block).thrust = np.array([*force, 0.0, -moment, 0.0])
    layer.store.lay_out()


def lock_rotation(layer: RubbleLayer, block: int) -> None:
    """Let a plate move without turning."""
    plate = layer.block(block)
    plate.rows.inertia[plate.row] = plate.rows.inverse[plate.row] = plate.rows.world[plate.row] = 0.0
    plate.omega[:] = 0.0
