"""A fragment is handed over: it becomes a plate, and what arrives is set against what left.

All ice of the fragment, with what has been crushed off it, is one rigid body that has the momenta of its nodes. What
lies inside the structure is cut off that body and takes along what it has as a part of it; so does what stays. Neither
the momenta nor the centre of mass jump, in no frame of reference.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from coupling.interface import Array, Fragment, HandOver
from coupling.rubble_port.births import Momenta, PieceBirth, births, frame_of
from rubble.geometry import area_moments, contiguous
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Plate, Start, centre_of, offset_inertia, prism_at, quaternion_of
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
        h, density, mass = self._physics.thickness, self._physics.rho_i, float(fragment.mass.sum())
        self.fragments += 1
        left = Momenta.of(fragment, h, density)
        origin, axes = frame_of(fragment, h)
        pieces = list(births(fragment, h, origin, axes))
        still = Start(origin, quaternion_of(axes), np.zeros(3), np.zeros(3))
        every = [prism_at(b.whole, b.y, b.width, density) for b in pieces]
        whole = layer.try_plate(every, still)
        start = _motion(whole, still, left)
        kept = [(t, b) for b in pieces if (t := self._trim(layer, b, origin, axes)) is not None]
        rest = [prism_at(t, b.y, b.width, density) for t, b in kept]
        crushed, born = _crushed(every, rest, start, whole), None
        if rest:
            born = layer.block(self._put(layer, rest, start, whole.position, self._head(fragment)))
            self.born += layer.runner.parts_of(born)
        arrived, held = _arrived(born, start, whole)
        least = REST * whole.mass * math.sqrt(self._physics.g * h)
        error = _missed(left, arrived + crushed, whole.position, np.array([least, least * h]))
        trimmed = mass if born is None else mass - born.mass
        return HandOver(int(bool(rest)), mass, trimmed, error[0], error[1], _about_0(crushed, whole.position), held)

    def _put(
        self, layer: RubbleLayer, prisms: list[tuple[Prism, Array]], start: Start, centre: Array, head: float | None
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
        least = SMALLEST * self._physics.thickness**2
        if area_moments(b.polygon).area < least:
            return None
        shift = origin + b.y * axes[:, 1]
        turn = axes[np.ix_([0, 2], [0, 2])]
        placed = b.polygon @ turn.T + shift[[0, 2]]
        kept = layer.trim(np.ascontiguousarray(placed), layer.key_at(float(shift[1])))
        if len(kept) < 3 or area_moments(contiguous(kept)).area < least:
            return None
        if len(kept) == len(placed) and np.abs(kept - placed).max() == 0.0:
            return b.polygon
        return np.ascontiguousarray(np.linalg.solve(turn, (kept - shift[[0, 2]]).T).T)


def _motion(whole: Plate, still: Start, left: Momenta) -> Start:
    """The motion with which the whole plate has the momenta that left: velocity of its centre, and rate of turning."""
    r = whole.rotation
    omega = np.asarray(np.linalg.solve(r @ whole.spin @ r.T, left.spin), np.float64)
    return replace(still, velocity=left.linear / whole.mass, omega=omega)


def _crushed(
    every: Sequence[tuple[Prism, Array]], rest: Sequence[tuple[Prism, Array]], start: Start, whole: Plate
) -> Array:
    """Momentum of what is in ``every`` prism and not in the ``rest``, and its moment about the whole's centre (6,)."""
    centre = np.asarray(np.linalg.solve(whole.rotation, whole.position - start.position), np.float64)
    mass, first, second = _moments(every, centre)
    if rest:
        kept = _moments(rest, centre)
        mass, first, second = mass - kept[0], first - kept[1], second - kept[2]
    r = whole.rotation
    p = mass * start.velocity + np.cross(start.omega, r @ first)
    spin = np.cross(r @ first, start.velocity) + r @ second @ r.T @ start.omega
    return np.concatenate([p, spin])


def _moments(prisms: Sequence[tuple[Prism, Array]], about: Array) -> tuple[float, Array, Array]:
    """Mass, first moment (3,) and inertia (3, 3) about a point of prisms, in the axes of their plate."""
    mass, centre, spin = centre_of(prisms)
    d = centre - about
    return mass, mass * d, spin + offset_inertia(mass, d)


def _arrived(born: Plate | None, start: Start, whole: Plate) -> tuple[Array, Array]:
    """Of the plate in the layer: momentum, and its moment about the whole's centre (6,); with it what the layer holds.

    That is angular momentum (3,) which a plate that turns about y alone gives to its neighbours.
    """
    if born is None:
        return np.zeros(6), np.zeros(3)
    r, p = born.rotation, born.momentum
    inertia = r @ born.spin @ r.T
    held = inertia @ (start.omega - born.omega)
    spin = np.cross(born.position - whole.position, p) + inertia @ born.omega + held
    return np.concatenate([p, spin]), held


def _missed(left: Momenta, found: Array, centre: Array, least: Array) -> tuple[float, float]:
    """By how much momenta (6,) about a centre miss those that left, relative; ``least`` (2,) that count as some."""
    angular = left.spin + np.cross(left.centre - centre, left.linear)
    missed = np.array([np.abs(found[:3] - left.linear).sum(), np.abs(found[3:] - angular).sum()])
    error = missed / np.maximum(left.scale, least)
    return float(error[0]), float(error[1])


def _about_0(momenta: Array, centre: Array) -> Array:
    """Momentum and its moment about the origin (6,), from that about a centre."""
    return np.concatenate([momenta[:3], momenta[3:] + np.cross(centre, momenta[:3])])
