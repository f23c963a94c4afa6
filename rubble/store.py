"""All plates in the order of their numbers, and the tables that kernels read, laid out anew when plates change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Records, filled
from rubble.phases import AXIS
from rubble.physics import RubblePhysics
from rubble.piece import Piece, Plate, Start, centre_of, moved_mass, volume_of
from rubble.plates import Plates, empty, momenta, orient_all
from rubble.pressure import EDGE
from rubble.prism import Prism
from rubble.slices import Pieces
from rubble.water import Hulls

#: A plate narrower than this many sections is seen by one plane at a time. What rolls or yaws it is pressure at two
#: places along y, which one plane does not tell apart: it turns about y alone, as if neighbours held the rest
NARROW = 1.5
#: of a plate over a window: impulse on the structure x, y, z [N s]; normal impulses on other ice, on the sheet; normal
#: impulse on the structure, and weighted with x, y and z of the point [N s m]
ON_PLATE = ("structure_x", "structure_y", "structure_z", "ice", "sheet", "push", "at_x", "at_y", "at_z")


class Told(NamedTuple):
    """What is told of the plates, beside their motion."""

    ids: IntArray  #: (n,) their numbers
    width: Array  #: (n,) mean extent along their y axes [m]
    span: Array  #: (n, 2, 2) from where to where they reach along their x and y axes [m]
    corners: Array  #: (v, 3) of the outlines of their middle pieces, in their axes [m]
    offset: IntArray  #: (n + 1,) plate i owns corners[offset[i]:offset[i + 1]]


class Tables(NamedTuple):
    """What follows from the plates, beside their motion."""

    pieces: Pieces
    hulls: Hulls
    mass: Array  #: (n,) true mass [kg]
    spin: Array  #: (n, 3, 3) true inertia [kg m2]
    thrust: Array  #: (n, 6) constant force and moment beside the weight [N, N m]
    axes: Records  #: (n,) AXIS
    sums: Array  #: (n, 9) ON_PLATE over the window
    told: Told


class Store:
    """Adds and takes plates; `plates` and `tables` are valid after `lay_out`."""

    def __init__(self, physics: RubblePhysics, pitch: float) -> None:
        self.physics, self.narrow = physics, NARROW * pitch
        self.list: list[Plate] = []
        self.plates = empty(0)
        self._next, self._next_piece = 0, 0
        self._summed: list[int] = []  #: numbers of the plates in the tables
        self.tables: Tables
        self.lay_out()

    def make(self, fragment: int, prisms: Sequence[tuple[Prism, Array]], start: Start, flooded: float) -> Plate:
        """A plate of prisms at places (3,) in its axes; it has a number, and belongs to nobody yet."""
        mass, centre, spin = centre_of(prisms)
        pieces = [Piece(k, prism, at - centre) for k, (prism, at) in enumerate(prisms, self._next_piece)]
        own = empty(1)
        own.quaternion[0], own.flooded[0] = start.quaternion, flooded
        orient_all(own)
        own.position[0] = start.position + own.rotation[0] @ centre
        own.velocity[0] = *start.velocity, *start.omega
        plate = Plate(self._next, fragment, pieces, mass, spin, own, 0)
        weigh(plate, self.physics, self.narrow)
        self._next, self._next_piece = self._next + 1, self._next_piece + len(pieces)
        return plate

    def part_of(self, plate: Plate, prisms: Sequence[tuple[Prism, Array]]) -> Plate:
        """A plate of prisms at places (3,) in the axes of a plate of which they are a part: it moves on as it did."""
        own = plate.rows.quaternion[plate.row].copy(), plate.velocity.copy(), plate.omega.copy()
        part = self.make(plate.fragment, prisms, Start(plate.position.copy(), *own), plate.flooded)
        part.velocity[:] += np.cross(plate.omega, part.position - plate.position)
        part.aligned, part.sliding = plate.aligned, plate.sliding
        return part

    def replace(self, pairs: Sequence[tuple[Plate, Sequence[Plate]]]) -> Array:
        """Others take the place of plates; the first of them has what was summed of the plate in the window.

        Returns by how much what all plates carry has changed (6,), see `carried`.
        """
        if not pairs:
            return np.zeros(6)
        before = self.carried
        sums = [self.tables.sums[plate.row].copy() for plate, _ in pairs]
        self._take_out([plate for plate, _ in pairs])
        self.list = sorted([*self.list, *(new for _, others in pairs for new in others)], key=lambda p: p.id)
        self.lay_out()
        for (_, others), own in zip(pairs, sums, strict=True):
            if others:
                self.tables.sums[others[0].row] = own
        return self.carried - before

    @property
    def carried(self) -> Array:
        """Momentum and angular momentum about the origin (6,) of all plates with the water that moves along."""
        return momenta(self.plates, self.plates.moved[:-1], self.plates.inertia[:-1])

    def add(self, *plates: Plate) -> None:
        """Take in plates."""
        self.list = sorted([*self.list, *plates], key=lambda p: p.id)
        self.lay_out()

    def take(self, *plates: Plate) -> None:
        """Take out plates; they keep their motion."""
        self._take_out(plates)
        self.lay_out()

    def _take_out(self, plates: Sequence[Plate]) -> None:
        for plate in plates:
            own = empty(1)
            _copy(plate.rows, plate.row, own, 0)
            plate.rows, plate.row = own, 0
        out = {id(p) for p in plates}
        self.list = [p for p in self.list if id(p) not in out]

    def lay_out(self) -> None:
        """Tables anew; the plates move into them with what was summed of each."""
        before = dict(zip(self._summed, self.tables.sums, strict=True)) if self._summed else {}
        new = empty(len(self.list))
        for i, plate in enumerate(self.list):
            _copy(plate.rows, plate.row, new, i)
            plate.rows, plate.row = new, i
        orient_all(new)
        self.plates = new
        self.tables = _tables(self.list, self.physics)
        self._summed = [p.id for p in self.list]
        for row, number in zip(self.tables.sums, self._summed, strict=True):
            row[:] = before.get(number, 0.0)


def weigh(plate: Plate, physics: RubblePhysics, narrow: float) -> None:
    """Mass and inertia of a plate into its row; one that is no wider than ``narrow`` turns about its y axis alone."""
    moved, inertia = moved_mass(plate, physics, volume_of(plate.pieces))
    own, i = plate.rows, plate.row
    own.moved[i], own.inverse_mass[i], own.inertia[i] = moved, 1.0 / moved, inertia
    if plate.extent > narrow or not np.isfinite(narrow):
        own.inverse[i] = np.linalg.inv(inertia)
    else:
        own.inertia[i] = own.inverse[i] = 0.0
        own.inertia[i, 1, 1], own.inverse[i, 1, 1] = inertia[1, 1], 1.0 / inertia[1, 1]
        own.motion["a"][i] = own.motion["c"][i] = 0.0


def _copy(source: Plates, i: int, target: Plates, k: int) -> None:
    for a, b in zip(source, target, strict=True):
        b[k] = a[i]


def _tables(plates: Sequence[Plate], physics: RubblePhysics) -> Tables:
    pieces = [(i, p) for i, plate in enumerate(plates) for p in plate.pieces]
    owner = np.array([i for i, _ in pieces], np.int64)
    y = np.array([p.centre[1] for _, p in pieces], np.float64)
    width = np.array([p.prism.width for _, p in pieces], np.float64)
    corners = [p.corners for _, p in pieces]
    return Tables(
        pieces=Pieces(
            np.array([p.number for _, p in pieces], np.int64),
            np.array([p.worn for _, p in pieces], np.int64),
            owner,
            y,
            width,
            np.concatenate([np.zeros((0, 2)), *corners]),
            np.cumsum([0, *map(len, corners)], dtype=np.int64),
            np.zeros((len(pieces), 2), np.int64),
        ),
        hulls=_hulls(plates, pieces, owner, y, width, physics.g),
        mass=np.array([p.mass for p in plates], np.float64),
        spin=np.array([p.spin for p in plates]).reshape(-1, 3, 3),
        thrust=np.array([p.thrust for p in plates]).reshape(-1, 6),
        axes=_axes(plates, physics.thickness),
        told=_told(plates),
        sums=np.zeros((len(plates), len(ON_PLATE))),
    )


def _told(plates: Sequence[Plate]) -> Told:
    return Told(
        ids=np.array([p.id for p in plates], np.int64),
        width=np.array([p.width for p in plates], np.float64),
        span=np.array([p.span for p in plates]).reshape(-1, 2, 2),
        corners=np.concatenate([np.zeros((0, 3)), *(p.middle for p in plates)]),
        offset=np.cumsum([0, *(len(p.middle) for p in plates)], dtype=np.int64),
    )


def _hulls(
    plates: Sequence[Plate], pieces: Sequence[tuple[int, Piece]], owner: IntArray, y: Array, width: Array, g: float
) -> Hulls:
    edges = [p.edges for _, p in pieces]
    alone = np.array([len(plates[i].pieces) for i, _ in pieces], np.float64)
    force = np.array([p.thrust[:3] - [0.0, 0.0, p.mass * g] for p in plates]).reshape(-1, 3)
    return Hulls(
        plate=owner,
        y=y,
        side=1.0 / (alone * width) if len(pieces) else np.zeros(0),
        edges=filled(EDGE, np.concatenate([np.zeros((0, len(EDGE.names or ()))), *edges])),
        offset=np.cumsum([0, *map(len, edges)], dtype=np.int64),
        weight=force,
        moment=np.array([p.thrust[3:] for p in plates]).reshape(-1, 3),
    )


def _axes(plates: Sequence[Plate], thickness: float) -> Records:
    """A plate counts as next to a slope within its own reach and one thickness; its axis is that of a middle piece."""
    found = []
    for plate in plates:
        prism = plate.middle_piece.prism
        found.append((prism.reach + thickness, prism.long_axis, np.pi if prism.slender else np.pi / 2))
    return filled(AXIS, found)
