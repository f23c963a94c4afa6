"""Plates: rigid bodies with six degrees of freedom, and how they move.

A plate moves with the velocity of its centre of mass and turns with ``omega``; both stand side by side in `motion`.
Its axes are those of the piece of ice when it was born: x along the drift, y to the left, z up. Turning keeps the
angular momentum ``R I R' omega`` and not the rate, so a plate that nobody touches keeps all six momenta to rounding.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, Records, rows, whole_lines, zeros_at_a_line
from rubble.compiled import compiled

#: velocity of a centre of mass [m/s] and rate of turning [rad/s], fixed axes
MOTION = whole_lines("x", "y", "z", "a", "b", "c")


class Plates(NamedTuple):
    """One row per plate, in the order of their numbers; the last row is the ground, which never moves."""

    position: Array  #: (n + 1, 3) centre of mass [m]
    quaternion: Array  #: (n + 1, 4) w, x, y, z: turns the plate's axes into the fixed ones
    motion: Records  #: (n + 1,) MOTION
    shift: Records  #: (n + 1,) MOTION by which the solver takes out overlap in the coming sub-step
    rotation: Array  #: (n + 1, 3, 3) of the quaternion
    moved: Array  #: (n + 1,) mass with added mass [kg]
    inverse_mass: Array  #: (n + 1,) of that; 0 for the ground [1/kg]
    inertia: Array  #: (n + 1, 3, 3) with that of the water that turns along, in the plate's axes [kg m2]
    inverse: Array  #: (n + 1, 3, 3) of the inertia; 0 where a plate is kept from turning
    world: Array  #: (n + 1, 3, 3) the same in the fixed axes
    flooded: Array  #: (n + 1,) part of its head of water that the top carries

    @property
    def number(self) -> int:
        """How many plates there are."""
        return len(self.moved) - 1

    @property
    def velocity(self) -> Array:
        """(n + 1, 6) of `motion`; a view [m/s], [rad/s]."""
        return rows(self.motion, "x", 6)


def empty(count: int) -> Plates:
    """Rows for so many plates, and the ground."""
    n = count + 1
    one = np.tile(np.eye(3), (n, 1, 1))
    still = np.tile(np.array([1.0, 0.0, 0.0, 0.0]), (n, 1))
    return Plates(
        position=np.zeros((n, 3)),
        quaternion=still,
        motion=zeros_at_a_line(n, MOTION),
        shift=zeros_at_a_line(n, MOTION),
        rotation=one,
        moved=np.ones(n),
        inverse_mass=np.zeros(n),
        inertia=np.zeros((n, 3, 3)),
        inverse=np.zeros((n, 3, 3)),
        world=np.zeros((n, 3, 3)),
        flooded=np.ones(n),
    )


@compiled(nogil=True, borrows=True)
def turn_back(r: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """R' v: a vector of the fixed axes in those of a plate."""
    return (
        r[0, 0] * x + r[1, 0] * y + r[2, 0] * z,
        r[0, 1] * x + r[1, 1] * y + r[2, 1] * z,
        r[0, 2] * x + r[1, 2] * y + r[2, 2] * z,
    )


@compiled(nogil=True, borrows=True)
def times(m: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """M v."""
    return (
        m[0, 0] * x + m[0, 1] * y + m[0, 2] * z,
        m[1, 0] * x + m[1, 1] * y + m[1, 2] * z,
        m[2, 0] * x + m[2, 1] * y + m[2, 2] * z,
    )


@compiled(nogil=True, borrows=True)
def orient(plates: Plates, i: int) -> None:
    """Rotation and inverse inertia in the fixed axes of plate i, from its quaternion."""
    w, x, y, z = plates.quaternion[i]
    r, inverse, world = plates.rotation[i], plates.inverse[i], plates.world[i]
    r[0, 0], r[0, 1], r[0, 2] = 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)
    r[1, 0], r[1, 1], r[1, 2] = 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)
    r[2, 0], r[2, 1], r[2, 2] = 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)
    for a in range(3):
        ta, tb, tc = turn_back(inverse, r[a, 0], r[a, 1], r[a, 2])
        for b in range(a, 3):
            world[a, b] = ta * r[b, 0] + tb * r[b, 1] + tc * r[b, 2]
            world[b, a] = world[a, b]


@compiled(nogil=True, borrows=True)
def orient_all(plates: Plates) -> None:
    """The same for all plates."""
    for i in range(plates.moved.shape[0]):
        orient(plates, i)


@compiled(nogil=True, borrows=True, forceinline=True)
def turn(plates: Plates, i: int, dt: float) -> float:
    """Turn plate i for a time; returns the kinetic energy that it gains, because the step is finite [J]."""
    v, s, r = plates.motion[i], plates.shift[i], plates.rotation[i]
    bx, by, bz = turn_back(r, v.a, v.b, v.c)
    lx, ly, lz = times(plates.inertia[i], bx, by, bz)
    before = bx * lx + by * ly + bz * lz
    lx, ly, lz = times(r, lx, ly, lz)
    hx, hy, hz = 0.5 * dt * (v.a + s.a), 0.5 * dt * (v.b + s.b), 0.5 * dt * (v.c + s.c)
    half = np.sqrt(hx * hx + hy * hy + hz * hz)
    if half == 0.0:
        return 0.0
    c, f = np.cos(half), np.sin(half) / half
    hx, hy, hz, q = f * hx, f * hy, f * hz, plates.quaternion[i]
    w, x, y, z = q[0], q[1], q[2], q[3]
    q[0] = c * w - hx * x - hy * y - hz * z
    q[1] = c * x + hx * w + hy * z - hz * y
    q[2] = c * y + hy * w + hz * x - hx * z
    q[3] = c * z + hz * w + hx * y - hy * x
    q /= np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    orient(plates, i)
    v.a, v.b, v.c = times(plates.world[i], lx, ly, lz)
    return float(0.5 * (v.a * lx + v.b * ly + v.c * lz - before))


@compiled(nogil=True, borrows=True)
def move_all(plates: Plates, dt: float) -> float:
    """Move all plates on by ``dt`` with motion and shift; the shift is left for the books. Returns as `turn`."""
    gained = 0.0
    for i in range(plates.moved.shape[0] - 1):
        v, s, p = plates.motion[i], plates.shift[i], plates.position[i]
        p[0], p[1], p[2] = p[0] + dt * (v.x + s.x), p[1] + dt * (v.y + s.y), p[2] + dt * (v.z + s.z)
        gained += turn(plates, i, dt)
    return gained


@compiled(nogil=True, borrows=True)
def kinetic(plates: Plates) -> float:
    """Kinetic energy of all plates with added mass [J]."""
    total = 0.0
    for i in range(plates.moved.shape[0] - 1):
        v = plates.motion[i]
        bx, by, bz = turn_back(plates.rotation[i], v.a, v.b, v.c)
        lx, ly, lz = times(plates.inertia[i], bx, by, bz)
        total += 0.5 * plates.moved[i] * (v.x * v.x + v.y * v.y + v.z * v.z)
        total += 0.5 * (bx * lx + by * ly + bz * lz)
    return total


def momenta(plates: Plates, mass: Array, spin: Array) -> Array:
    """Momentum and angular momentum about the origin (6,) of plates with ``mass`` (n,) and ``spin`` inertia (n, 3, 3).

    ``spin`` is in the plates' axes. [N s], [N m s]
    """
    n = plates.number
    p = mass[:, None] * plates.velocity[:n, :3]
    r = plates.rotation[:n]
    own = np.einsum("nab,nbc,ndc,nd->na", r, spin, r, plates.velocity[:n, 3:])
    return np.concatenate([p.sum(axis=0), (np.cross(plates.position[:n], p) + own).sum(axis=0)])
