"""Moments of the load, and where it attacks: of every window, from its forces and their places.

The point of attack is the mean of the places, each weighed by the magnitude of its force: the centre of the forces,
about which they have no moment if they are parallel. The moments themselves take every force at its place.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coupling.attack import PointForces, point_forces
from coupling.interface import Array, Frame


@dataclass(frozen=True, slots=True)
class Grip:
    """How a window's load holds the structure."""

    moment: Array  #: (3, 3) about the point of the scenario, rows by `Phase` [N m]
    weight: Array  #: (4,) sum of the magnitudes of all forces [N], and of each times its place x, y, z [N m]

    @property
    def attack(self) -> Array:
        """(3,) point of attack [m]; nan without a load."""
        return attack_of(self.weight)


def grip_of(frame: Frame, point: tuple[float, float, float]) -> Grip:
    """Of a window; ``point`` is that of the moments [m]."""
    forces = point_forces(frame.contact, frame.blocks)
    return Grip(forces.moments(np.array(point)), weight_of(forces))


def weight_of(forces: PointForces) -> Array:
    """`Grip.weight` of some forces."""
    size = np.linalg.norm(forces.force, axis=1)
    return np.concatenate(([size.sum()], size @ forces.position))


def attack_of(weight: Array) -> Array:
    """Points of attack (..., 3) of `Grip.weight` (..., 4), also of its means; nan without a load [m]."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(np.where(weight[..., :1] > 0.0, weight[..., 1:] / weight[..., :1], np.nan))
