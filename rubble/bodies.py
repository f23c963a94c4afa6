"""The moving bodies of a section as compiled code sees them: where pymunk keeps them, and how they move."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Records, record
from rubble.compiled import compiled
from rubble.pointers import BodyLayout, real, set_real

#: centre of mass [m], angle counter-clockwise [rad], velocities [m/s], [rad/s]
STATE = record("x", "z", "angle", "v_x", "v_z", "omega")
#: velocities alone [m/s], [rad/s]
VELOCITY = record("v_x", "v_z", "omega")
#: a force in the plane and its moment about the centre of mass [N, N, N m]
FORCE = record("x", "z", "moment")
#: a force in three dimensions [N]
LOAD = record("x", "y", "z")
#: lateral place [m] and speed [m/s]
LATERAL = record("y", "v_y")


class Bodies(NamedTuple):
    """Blocks in the order of their numbers, and after them the sheet if there is one."""

    address: IntArray  #: (n,) where pymunk keeps the body
    layout: BodyLayout  #: where its fields stand there
    state: Records  #: (n,) STATE
    blocks: int  #: how many are blocks; the sheet's row has this number


class Outlines(NamedTuple):
    """Outlines of all blocks in their body frames."""

    corners: Array  #: (v, 2) [m]
    offset: IntArray  #: (n + 1,) block i owns corners[offset[i]:offset[i + 1]]


@compiled(nogil=True)
def read_bodies(bodies: Bodies) -> None:
    """Bring the states up to date."""
    at, state = bodies.layout, bodies.state
    for i in range(bodies.address.shape[0]):
        body, row = bodies.address[i], state[i]
        row.x, row.z, row.angle = real(body + at.x), real(body + at.z), real(body + at.angle)
        row.v_x, row.v_z, row.omega = real(body + at.v_x), real(body + at.v_z), real(body + at.omega)


@compiled(nogil=True)
def set_force(body: int, layout: BodyLayout, fx: float, fz: float, moment: float) -> None:
    """Force and moment on the body at an address during the next sub-step [N, N, N m]."""
    set_real(body + layout.force_x, fx)
    set_real(body + layout.force_z, fz)
    set_real(body + layout.moment, moment)


@compiled(nogil=True)
def place_all(outlines: Outlines, state: Records) -> Array:
    """The corners (v, 2) of all blocks in world coordinates."""
    corners, offset = outlines.corners, outlines.offset
    out = np.empty_like(corners)
    for i in range(state.shape[0]):
        row = state[i]
        c, s = np.cos(row.angle), np.sin(row.angle)
        for k in range(offset[i], offset[i + 1]):
            out[k, 0] = row.x + c * corners[k, 0] - s * corners[k, 1]
            out[k, 1] = row.z + s * corners[k, 0] + c * corners[k, 1]
    return out
