"""Plates break again: who is long enough, how its load is followed, and its two parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rubble.arrays import Array, Known
from rubble.bending import CELLS, Ice, Loaded, judge_all
from rubble.geometry import area_moments, clip
from rubble.physics import RubblePhysics
from rubble.piece import Piece, Plate, prism_at
from rubble.prism import Prism
from rubble.store import Store

SHORTEST = 2.0  #: length of a plate, in thicknesses, that can break into parts of one thickness each
LEAST = 1e-3  #: area of a part of a piece, in thicknesses squared, below which it goes to the other part


@dataclass(frozen=True)
class Break:
    """A plate that has broken."""

    position: Array  #: (3,) of the cut [m]
    lengths: tuple[float, float]  #: of the parts across the cut [m]
    areas: tuple[float, float]  #: of the parts, seen from above on the plate [m2]
    stress: float  #: over the flexural strength


class Breaking:
    """Follows what bends plates from window to window, and says which break."""

    def __init__(self, physics: RubblePhysics) -> None:
        p = self.physics = physics
        self.ice = Ice(p.rho_i, p.thickness, p.flexural_strength, p.g, p.rho_w * p.g)
        none = np.zeros(0, np.int64)
        self._time = Known(none, np.zeros(0))  #: over which loads have been summed, by the number of the plate [s]
        self._loads = Known(none, np.zeros((0, 2, CELLS + 1, 3)))  #: the impulses

    def begin(self, store: Store) -> Loaded:
        """Plates that may break, with what has been summed of their loads."""
        span, row = store.tables.told.span, np.full(len(store.list) + 1, -1, np.int64)
        long = (span[..., 1] - span[..., 0]).max(axis=1) >= SHORTEST * self.ice.thickness
        found = np.flatnonzero(long & np.isfinite(self.ice.strength))
        row[found] = np.arange(len(found))
        return Loaded(row, span[found], self._loads.of(store.tables.told.ids[found], 0.0))

    def end(self, store: Store, loaded: Loaded, window: float) -> list[tuple[Plate, Array]]:
        """Plates that break at the end of a window, with stress, axis and place as `bending.judge` gives them."""
        who = np.flatnonzero(loaded.row[:-1] >= 0)
        ids = store.tables.told.ids[who]
        time = self._time.of(ids, 0.0) + window
        due = time >= self.physics.breaking_time * (1.0 - 1e-9)
        self._time, self._loads = Known(ids[~due], time[~due]), Known(ids[~due], loaded.impulse[~due])
        worst = judge_all(who, due, store.plates, store.tables.pieces, loaded, time, self.ice)
        return [(store.list[who[k]], worst[k]) for k in np.flatnonzero(worst[:, 0] >= 1.0).tolist()]


def parts_of(plate: Plate, axis: int, place: float, physics: RubblePhysics) -> list[list[tuple[Prism, Array]]]:
    """Prisms with their places of the two parts of a plate that is cut across an axis at ``place`` [m]."""
    parts: list[list[tuple[Prism, Array]]] = [[], []]
    for piece in plate.pieces:
        for side, cut in enumerate(_cut_x(piece, place) if axis == 0 else _cut_y(piece, place)):
            outline, y, width = cut
            if len(outline) >= 3 and width > 0.0 and area_moments(outline).area >= LEAST * physics.thickness**2:
                parts[side].append(prism_at(outline, y, width, physics.rho_i))
    return parts


def _cut_x(piece: Piece, place: float) -> list[tuple[Array, float, float]]:
    outline, y, w = piece.corners, float(piece.centre[1]), piece.prism.width
    return [(clip(outline, 1.0, 0.0, place), y, w), (clip(outline, -1.0, 0.0, -place), y, w)]


def _cut_y(piece: Piece, place: float) -> list[tuple[Array, float, float]]:
    outline, y, w = piece.corners, float(piece.centre[1]), piece.prism.width
    low, high = y - 0.5 * w, y + 0.5 * w
    at = min(max(place, low), high)
    return [(outline, 0.5 * (low + at), at - low), (outline, 0.5 * (at + high), high - at)]


def part(store: Store, plate: Plate, worst: Array) -> tuple[list[Plate], Break] | None:
    """The two plates that are to take the place of one, and what is told of it; None if it cannot be cut there.

    ``worst`` as `bending.judge` gives it. Each part moves on as the part of a rigid body that it is.
    """
    stress, axis, place = float(worst[0]), int(worst[1]), float(worst[2])
    prisms = [p for p in parts_of(plate, axis, place, store.physics) if p]
    if len(prisms) < 2:
        return None
    new, cut = [store.part_of(plate, own) for own in prisms], plate.position + plate.rotation[:, axis] * place
    lengths = [float(np.diff(p.span[axis])[0]) for p in new]
    areas = [plan_area(own, store.physics.thickness) for own in prisms]
    return new, Break(cut, (lengths[0], lengths[1]), (areas[0], areas[1]), stress)


def plan_area(prisms: Sequence[tuple[Prism, Array]], thickness: float) -> float:
    """Of prisms, seen along the normal of their plate [m2]."""
    return sum(p.area * p.width for p, _ in prisms) / thickness
