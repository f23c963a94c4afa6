"""A fragment is handed over: it becomes a plate, and what arrives is set against what left."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from coupling.interface import Array, Fragment, HandOver
from coupling.rubble_port.births import Momenta, PieceBirth, births, frame_of
from rubble.geometry import area_moments, contiguous
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Plate, Start, prism_at, quaternion_of
from rubble.prism import Prism

#: share of h^2 below which what is left of a trimmed piece counts as crushed: a sliver as long as the ice is thick
#: would be thinner than a fifth of the overlap that contacts leave alone (0.5 % of h), so no contact would hold it
SMALLEST = 1e-3
#: share of mass times (g h)^(1/2) below which a momentum is rest: what is left of it is rounding
REST = 1e-9


class Arrivals:
    """Puts plates into a layer and counts the energy with which they are born."""

    def __init__(self, physics: RubblePhysics):
        self._physics = physics
        self.fragments = 0
        self.born = np.zeros(2)  #: kinetic energy, and that of weight and water, of all plates when they were born [J]

    def add(self, layer: RubbleLayer, fragment: Fragment) -> HandOver:
        """Turns a fragment into a plate where and as it moves now."""
        h, mass = self._physics.thickness, float(fragment.mass.sum())
        self.fragments += 1
        origin, axes = frame_of(fragment, h)
        whole = list(births(fragment, h, origin, axes))
        if not whole:
            return HandOver(0, mass, mass, 0.0)
        density = self._physics.rho_i
        still = Start(origin, quaternion_of(axes), np.zeros(3), np.zeros(3))
        plate = layer.try_plate([prism_at(b.polygon, b.y, b.width, density) for b in whole], still)
        left = Momenta.of(fragment, h, plate.position)
        start, error = _motion(plate, still, left, REST * mass * math.sqrt(self._physics.g * h), h)
        rest = [(trimmed, b) for b in whole if (trimmed := self._trim(layer, b, origin, axes)) is not None]
        if not rest:
            return HandOver(0, mass, mass, error[0], error[1])
        prisms = [prism_at(t, b.y, b.width, density) for t, b in rest]
        number = self._put(layer, prisms, start, plate.position, self._head(fragment))
        born = layer.block(number)
        self.born += layer.runner.parts_of(born)
        return HandOver(1, mass, mass - born.mass, error[0], error[1])

    def _put(
        self,
        layer: RubbleLayer,
        prisms: list[tuple[Prism, Array]],
        start: Start,
        centre: Array,
        head: float | None,
    ) -> int:
        """What is left of a plate moves on as the part of a rigid body that it is."""
        kept = layer.try_plate(prisms, start).position
        start = replace(start, velocity=start.velocity + np.cross(start.omega, kept - centre))
        return layer.add_plate(prisms, start, fragment=self.fragments - 1, flooded=head)

    def _head(self, f: Fragment) -> float | None:
        """Part of the head of water on its top; None where tops do not fill: as `RubblePhysics.backfill` has it."""
        if self._physics.filling_rate <= 0.0:
            return None
        return float(np.average(f.flooded, weights=f.length * f.width))

    def _trim(self, layer: RubbleLayer, b: PieceBirth, origin: Array, axes: Array) -> Array | None:
        """What is left of a piece outside the structure, seen in the section that it stands in; None: nothing."""
        shift = origin + b.y * axes[:, 1]
        turn = axes[np.ix_([0, 2], [0, 2])]
        placed = b.polygon @ turn.T + shift[[0, 2]]
        kept = layer.trim(np.ascontiguousarray(placed), layer.key_at(float(shift[1])))
        if len(kept) < 3 or area_moments(contiguous(kept)).area < SMALLEST * self._physics.thickness**2:
            return None
        if len(kept) == len(placed) and np.abs(kept - placed).max() == 0.0:
            return b.polygon
        return np.ascontiguousarray(np.linalg.solve(turn, (kept - shift[[0, 2]]).T).T)


def _motion(plate: Plate, still: Start, left: Momenta, least: float, h: float) -> tuple[Start, tuple[float, float]]:
    """The motion with which a plate has the momenta that left, about its centre, and by how much it misses them.

    ``least`` momentum that counts as some [N s]; ``h`` thickness [m].
    """
    r = plate.rotation
    spin = r @ plate.spin @ r.T
    velocity, omega = left.linear / plate.mass, np.asarray(np.linalg.solve(spin, left.angular), np.float64)
    missed = np.abs(plate.mass * velocity - left.linear).sum(), np.abs(spin @ omega - left.angular).sum()
    error = missed[0] / max(left.scale[0], least), missed[1] / max(left.scale[1], least * h)
    return replace(still, velocity=velocity, omega=omega), (float(error[0]), float(error[1]))
