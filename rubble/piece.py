"""Plates of broken ice and the prisms of which they are made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import cos, sin

import numpy as np

from rubble.arrays import Array, rows
from rubble.geometry import area_moments, contiguous, is_convex, place
from rubble.physics import RubblePhysics
from rubble.plates import Plates
from rubble.prism import Prism, make_prism
from rubble.slices import CORNERS


@dataclass(frozen=True)
class Slab:
    """Ice that is to become a block, where it lies in its section."""

    outline: Array  #: (k, 2) convex, in world x, z [m]
    cuts: Array  #: (s + 1,) places along its axis between which its width is constant: ``x cos + z sin`` [m]
    widths: Array  #: (s,) along y between the cuts [m]
    density: float  #: [kg/m^3]
    angle: float = 0.0  #: of its axis from x [rad]


@dataclass(eq=False)
class Piece:
    """A prism of a plate."""

    number: int  #: never reused
    prism: Prism
    centre: Array  #: (3,) of its mass, in the plate's axes from the plate's centre [m]
    worn: int = 0  #: how often crushed ice has come off it

    @cached_property
    def corners(self) -> Array:
        """(k, 2) of its outline, counter-clockwise, in the plate's axes [m]."""
        return self.prism.polygon + self.centre[::2]

    @cached_property
    def edges(self) -> Array:
        """(e, 8) wetted edges of its prism, numbers of `pressure.EDGE`, in the plate's axes."""
        out = rows(self.prism.edges).copy()
        out[:, :4] += [self.centre[0], self.centre[2], self.centre[0], self.centre[2]]
        return out


@dataclass(frozen=True)
class Start:
    """Where a plate begins, and how it moves."""

    position: Array  #: (3,) of the point from which its pieces are measured [m]
    quaternion: Array  #: (4,) w, x, y, z
    velocity: Array  #: (3,) of its centre of mass [m/s]
    omega: Array  #: (3,) fixed axes [rad/s]


@dataclass(eq=False)
class Plate:
    """One rigid piece of broken ice; its motion stands in a row of `plates.Plates`."""

    id: int  #: never reused
    fragment: int  #: number of the fragment it came from
    pieces: list[Piece]
    mass: float  #: true mass [kg]
    spin: Array  #: (3, 3) true inertia about the centre of mass, in its axes [kg m2]
    rows: Plates
    row: int
    aligned: bool = False  #: its long axis has once aligned with the slope
    sliding: bool = False  #: its phase: rotating before, sliding after it has aligned and left the sheet
    thrust: Array = field(default_factory=lambda: np.zeros(6))  #: constant force and moment beside the weight [N, N m]

    @property
    def position(self) -> Array:
        """Of the centre of mass (3,); a view [m]."""
        at: Array = self.rows.position[self.row]
        return at

    @property
    def velocity(self) -> Array:
        """Of the centre of mass (3,); a view [m/s]."""
        return self.rows.velocity[self.row, :3]

    @property
    def omega(self) -> Array:
        """Rate of turning (3,), fixed axes; a view [rad/s]."""
        return self.rows.velocity[self.row, 3:]

    @property
    def rotation(self) -> Array:
        """(3, 3) from its axes to the fixed ones."""
        axes: Array = self.rows.rotation[self.row]
        return axes

    @property
    def momentum(self) -> Array:
        """True mass times velocity (3,) [N s]."""
        return self.mass * self.velocity

    @property
    def flooded(self) -> float:
        """Part of its head of water that the top carries."""
        return float(self.rows.flooded[self.row])

    @cached_property
    def width(self) -> float:
        """Mean extent along its y axis [m]."""
        area = sum(p.prism.area for p in self.pieces) / len(self.pieces)
        return sum(p.prism.area * p.prism.width for p in self.pieces) / area

    @property
    def extent(self) -> float:
        """Along its y axis, over all pieces [m]."""
        low = min(float(p.centre[1]) - 0.5 * p.prism.width for p in self.pieces)
        return max(float(p.centre[1]) + 0.5 * p.prism.width for p in self.pieces) - low

    @property
    def angle(self) -> float:
        """Of its x axis, from x towards z, seen in the x-z plane [rad]."""
        return float(np.arctan2(self.rotation[2, 0], self.rotation[0, 0]))

    @cached_property
    def span(self) -> Array:
        """From where to where it reaches along its x and y axes (2, 2) [m]."""
        x = np.concatenate([p.corners[:, 0] for p in self.pieces])
        y = [(p.centre[1] - 0.5 * p.prism.width, p.centre[1] + 0.5 * p.prism.width) for p in self.pieces]
        return np.array([(x.min(), x.max()), (np.min(y), np.max(y))])

    @cached_property
    def middle_piece(self) -> Piece:
        """The piece nearest to its x axis."""
        return min(self.pieces, key=lambda p: abs(p.centre[1]))

    @cached_property
    def middle(self) -> Array:
        """(k, 3) corners of the outline of its middle piece, in its axes [m]."""
        piece = self.middle_piece
        corners: Array = np.insert(piece.prism.polygon, 1, 0.0, axis=1) + piece.centre
        return corners

    @property
    def outline(self) -> Array:
        """(k, 2) corners of its middle piece in world x, z [m]."""
        found: Array = (self.position + self.middle @ self.rotation.T)[:, ::2]
        return np.ascontiguousarray(found)


def turned(angle: float) -> Array:
    """Quaternion (4,) of a turn from x towards z [rad]."""
    return np.array([cos(angle / 2), 0.0, -sin(angle / 2), 0.0])


def quaternion_of(axes: Array) -> Array:
    """Quaternion (4,) of the turn that brings x, y, z to the columns of ``axes`` (3, 3), by less than 180 degrees."""
    w = 0.5 * np.sqrt(max(1.0 + float(np.trace(axes)), 1e-12))
    d = np.array([axes[2, 1] - axes[1, 2], axes[0, 2] - axes[2, 0], axes[1, 0] - axes[0, 1]])
    found = np.array([w, *(d / (4.0 * w))])
    return np.asarray(found / np.linalg.norm(found))


def prism_at(outline: Array, y: float, width: float, density: float) -> tuple[Prism, Array]:
    """A prism of one width with its place (3,) from an outline (k, 2), both in the axes of its plate."""
    ends = np.array([outline[:, 0].min(), outline[:, 0].max()])
    return prism_of(outline, y, ends, np.array([width]), density)


def prism_of(outline: Array, y: float, cuts: Array, widths: Array, density: float) -> tuple[Prism, Array]:
    """The same of strips: widths (s,) between cuts (s + 1,) along x. ValueError if the outline is not convex."""
    prism, (x, z) = make_prism(_checked(outline), cuts, widths, density)
    return prism, np.array([x, y, z])


def one_piece(slab: Slab, y: float, velocity: Sequence[float], omega: float) -> tuple[list[tuple[Prism, Array]], Start]:
    """The prism of a slab with its place, and its start: what `assemble` needs for a plate of one piece."""
    angle = slab.angle
    own = place(_checked(slab.outline), 0.0, 0.0, -angle, 0.0, 0.0)
    prism, (cx, cz) = make_prism(own, slab.cuts, slab.widths, slab.density)
    v = np.array(velocity if len(velocity) == 3 else (velocity[0], 0.0, velocity[1]), np.float64)
    start = Start(np.array([0.0, y, 0.0]), turned(angle), v, np.array([0.0, -float(omega), 0.0]))
    return [(prism, np.array([cx, 0.0, cz]))], start


def centre_of(prisms: Sequence[tuple[Prism, Array]]) -> tuple[float, Array, Array]:
    """Mass [kg], centre of mass (3,) [m] and inertia about it (3, 3) [kg m2] of prisms at places (3,)."""
    mass = sum(p.mass for p, _ in prisms)
    centre = np.asarray(sum(p.mass * at for p, at in prisms) / mass)
    spin = np.zeros((3, 3))
    for prism, at in prisms:
        d = at - centre
        spin += prism.tensor + offset_inertia(prism.mass, d)
    return mass, centre, spin


def offset_inertia(mass: float, d: Array) -> Array:
    """What the inertia of a mass [kg] about a point has beyond that about its centre, d (3,) away (3, 3) [kg m2]."""
    return np.asarray(mass * (d @ d * np.eye(3) - np.outer(d, d)))


def moved_mass(plate: Plate, physics: RubblePhysics, volume: float) -> tuple[float, Array]:
    """Mass [kg] and inertia (3, 3) [kg m2] with those of the water that moves along; ``volume`` of ice [m3]."""
    water = physics.rho_w * volume / plate.mass
    return plate.mass * (1.0 + physics.added_mass * water), plate.spin * (1.0 + physics.added_inertia * water)


def volume_of(pieces: Sequence[Piece]) -> float:
    """Of ice [m3]."""
    return sum(p.prism.area * p.prism.width for p in pieces)


def _checked(polygon: Array) -> Array:
    out = contiguous(polygon)
    if not is_convex(out) or area_moments(out).area <= 0:
        raise ValueError(f"a block's outline with {len(out)} corners is not convex; split it into convex parts")
    if len(out) > CORNERS - 2:
        raise ValueError(f"a block's outline has {len(out)} corners; give at most {CORNERS - 2}")
    return out
