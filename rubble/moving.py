"""A structure that moves, as the rubble meets it.

Its displacement (6,) is that of its waterline point, the origin where it rests: along x, y, z [m], about them [rad].
Contacts are found in its axes, in which it rests: the sections are shifted and turned in their plane, and so pymunk
finds the same whether structure or ice moves. The plane y moves with the structure's points there: by yaw and roll it
shifts along x and z. What moves the structure out of the plane shows by how deep and how steep a contact is (`gather`),
to first order in the angle; where it has gone aside far the cut is made anew. Velocities at contacts and moments are
whole: v + omega x r.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, Record
from rubble.compiled import compiled

ASIDE = 0.1  #: of the pitch: way to the side from which on sections are cut anew [-]


class Moving(NamedTuple):
    """A structure in a window."""

    place: Array  #: (6,) displacement now
    velocity: Array  #: (6,) over the window
    turn: Array  #: (2,) cosine and sine of the pitch
    wrench: Array  #: (6,) impulse of the plates on it since the window began, and its moment about its waterline point
    work: Array  #: (1,) that it has done on plates since the start [J]


def resting() -> Moving:
    """Where it was built."""
    return Moving(np.zeros(6), np.zeros(6), np.array([1.0, 0.0]), np.zeros(6), np.zeros(1))


def stand(moving: Moving, place: Array, velocity: Array) -> None:
    """Put it there, with a velocity."""
    moving.place[:], moving.velocity[:] = place, velocity
    moving.turn[:] = np.cos(place[4]), np.sin(place[4])


@compiled(nogil=True, borrows=True)
def move_structure(moving: Moving, dt: float) -> None:
    """A sub-step on."""
    for d in range(6):
        moving.place[d] += dt * moving.velocity[d]
    moving.turn[0], moving.turn[1] = np.cos(moving.place[4]), np.sin(moving.place[4])


@compiled(nogil=True, borrows=True)
def in_plane(moving: Moving, y: float) -> tuple[float, float]:
    """How far the structure has shifted along x and z in the plane y [m]."""
    d = moving.place
    return d[0] - d[5] * (y - d[1]), d[2] + d[3] * (y - d[1])


@compiled(nogil=True, borrows=True)
def turned(moving: Moving, x: float, z: float) -> tuple[float, float]:
    """A direction in the structure's axes as it is in the plane."""
    cos, sin = moving.turn[0], moving.turn[1]
    return cos * x + sin * z, cos * z - sin * x


@compiled(nogil=True, borrows=True)
def aside(moving: Moving, x: float, z: float) -> float:
    """How far a point of the structure, at x and z in its own axes, has gone along y [m]."""
    d = moving.place
    return float(d[1] + d[5] * x - d[3] * z)


@compiled(nogil=True, borrows=True)
def own_axes(moving: Moving, y: float, x: float, z: float) -> tuple[float, float]:
    """A point of the plane y in the structure's axes, x and z [m]."""
    sx, sz = in_plane(moving, y)
    cos, sin = moving.turn[0], moving.turn[1]
    return cos * (x - sx) - sin * (z - sz), sin * (x - sx) + cos * (z - sz)


@compiled(nogil=True, borrows=True)
def from_axes(moving: Moving, y: float, x: float, z: float) -> tuple[float, float]:
    """The same back."""
    sx, sz = in_plane(moving, y)
    tx, tz = turned(moving, x, z)
    return sx + tx, sz + tz


@compiled(nogil=True, borrows=True)
def speed_of_structure(moving: Moving, point: Record, way: Record) -> float:
    """Of the structure at a point of a row along one of its directions [m/s]."""
    d, v = moving.place, moving.velocity
    rx, ry, rz = point.x - d[0], point.y - d[1], point.z - d[2]
    x = v[0] + v[4] * rz - v[5] * ry
    y = v[1] + v[5] * rx - v[3] * rz
    z = v[2] + v[3] * ry - v[4] * rx
    return float(x * way.x + y * way.y + z * way.z)


@compiled(nogil=True)
def in_axes(moving: Moving, y: float, outline: Array, back: bool) -> Array:
    """An outline (k, 2) of the plane y in the structure's axes, or back from them."""
    out = np.empty_like(outline)
    for i in range(outline.shape[0]):
        x, z = outline[i, 0], outline[i, 1]
        out[i, 0], out[i, 1] = from_axes(moving, y, x, z) if back else own_axes(moving, y, x, z)
    return out


def moved_cut(trim: Callable[[Array], Array], moving: Moving, y: float, polygon: Array) -> Array:
    """What ``trim`` leaves of an outline (k, 2) in the plane y, where the structure has moved."""
    own = in_axes(moving, y, np.ascontiguousarray(polygon), False)
    kept = trim(own)
    if kept.shape == own.shape and np.array_equal(kept, own):
        return polygon
    out: Array = in_axes(moving, y, np.ascontiguousarray(kept), True)
    return out
