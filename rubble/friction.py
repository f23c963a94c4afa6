"""Friction of a contact, set before it is solved: by the pair, by the speed of slip, and by the third dimension.

A section knows only the plane y. The face of a cone at the point of contact has the unit normal n with
n_y / n_x = y / x, and its part in the plane has the length ``p = 1 / sqrt(1 + q^2)``, ``q = n_y / p``. With the true
normal force N and the true slip ``(v_s, s)``, v_s in the plane and s = v_y / p across, ``|s| = hypot(v_s, s)``, the
contact force on a block is

    in the plane, along the normal    N (p + mu n_y s / |s|)        = N_plane, what the solver finds
    in the plane, along the face      -mu N v_s / |s|
    across                            N (n_y - mu p s / |s|)

so the solver needs the coefficient ``mu (v_s / |s|) / (p + mu n_y s / |s|)``. On the axis it is mu.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray
from pymunk._chipmunk_cffi import ffi, lib

from rubble.arbiters import ContactReader, note_pair
from rubble.compiled import callback, compiled
from rubble.geometry import Array
from rubble.physics import RATE_DEPENDENT, RubblePhysics
from rubble.pointers import OFFSETS, IntArray, integer, number, offsets, pointer, real, set_real

ICE, STRUCTURE, SHEET = 1, 2, 3  #: collision types
STRUCTURE_SLOT, SHEET_SLOT, UNKNOWN = -1, -2, -3  #: slots of the bodies that are no blocks
_SPREAD = 0x1E3779B97F4A7C15  #: addresses at regular distances do not fall together in the hash table
CREEP = 1e-4  #: slip below which a contact counts as sticking in the plane [m/s]
#: of a law: coefficient (negative: rate-dependent), 1 for a body of revolution, y of the section [m]
LAW = 3
#: header: address of the reader's header, of the law, length of the tables of bodies, addresses of (bodies, slots),
#: rows of the state table, its address, row of the sheet, addresses of (y, v_y) of the blocks, offsets
_FIXED = 10


@compiled("float64(float64)", nogil=True)
def rate_dependent(v: float) -> float:
    """Mu = 0.7 - 0.15 log10(v / 1e-6 m/s), between 1e-6 and 1e-2 m/s (Lishman and Polojarvi 2015)."""
    return 0.7 - 0.15 * np.log10(min(max(abs(v), 1e-6), 1e-2) / 1e-6)


@compiled("int64(int64, int64[::1], int64[::1])", nogil=True, inline="always")
def slot_of(body: int, bodies: IntArray, slots: IntArray) -> int:
    """Slot of a body by its address, in the tables of `slot_table`."""
    mask = bodies.shape[0] - 1
    i = ((body * _SPREAD) >> 40) & mask
    while bodies[i] != body:
        if bodies[i] == 0:
            return UNKNOWN
        i = (i + 1) & mask
    return slots[i]


def slot_table(bodies: list[int], slots: list[int]) -> tuple[IntArray, IntArray]:
    """Hash tables (addresses, slots) with open addressing; their length is a power of two, 0 marks a free place."""
    size = 1 << (4 * len(bodies)).bit_length()
    keys, values = np.zeros(size, np.int64), np.full(size, UNKNOWN, np.int64)
    for body, slot in zip(bodies, slots, strict=True):
        i = ((body * _SPREAD) >> 40) % size
        while keys[i] != 0:
            i = (i + 1) % size
        keys[i], values[i] = body, slot
    return keys, values


@compiled("UniTuple(float64, 2)(float64, float64, float64, float64, float64)", nogil=True)
def tilt(x: float, n_x: float, y_section: float, revolved: float, y: float) -> tuple[float, float]:
    """(p, n_y) of the face of a body of revolution at x in a section, for a block that stands at y.

    The radius is that of the section's face; where the block's own y is out of its reach, 0.95 of the radius counts.
    """
    r = np.hypot(x, y_section)
    if revolved == 0.0 or r == 0.0:
        return 1.0, 0.0
    side = min(max(y, -0.95 * r), 0.95 * r)
    q = side / np.copysign(np.sqrt(r * r - side * side), x) * n_x
    p = 1.0 / np.sqrt(1.0 + q * q)
    return p, q * p


@compiled("UniTuple(float64, 3)(float64[::1], float64, float64, float64, float64)", nogil=True)
def shares(law: Array, p: float, n_y: float, v_s: float, v_y: float) -> tuple[float, float, float]:
    """(mu, N / N_plane, share of the friction that acts across) of a contact with the structure."""
    s = v_y / p
    speed = np.sqrt(v_s * v_s + s * s)
    mu = law[0] if law[0] >= 0.0 else rate_dependent(speed)
    across = s / np.sqrt(speed * speed + CREEP * CREEP)
    return mu, 1.0 / max(p + mu * n_y * across, 1e-3), across


@callback("void(voidptr, voidptr, voidptr)")
def _set_constant(arbiter: Any, space: Any, header: Any) -> None:
    """Pre-solve callback: a coefficient that does not depend on the motion, into the arbiter."""
    h = number(header)
    set_real(number(arbiter) + integer(h + 8 * 16), real(integer(h + 8)))


@callback("void(voidptr, voidptr, voidptr)")
def _set_friction(arbiter: Any, space: Any, header: Any) -> None:
    """Pre-solve callback: friction of the pair into the arbiter."""
    h = carray(header, 22, np.int64)
    base = number(arbiter)
    law = carray(pointer(h[1]), 3, np.float64)
    bodies, slots = carray(pointer(h[3]), h[2], np.int64), carray(pointer(h[4]), h[2], np.int64)
    state = carray(pointer(h[6]), (h[5], 6), np.float64)
    nx, nz = real(base + h[14]), real(base + h[14] + 8)
    c = integer(base + h[13])
    slip, x, n_x, block = 0.0, 0.0, 0.0, -1
    for side in range(2):
        slot, sign = slot_of(integer(base + h[10 + side]), bodies, slots), 1.0 if side == 1 else -1.0
        rx, rz = real(c + h[17 + side]), real(c + h[17 + side] + 8)
        row = h[7] if slot == SHEET_SLOT else slot
        if row >= 0:
            vx, vz = state[row, 3] - state[row, 5] * rz, state[row, 4] + state[row, 5] * rx
            slip += sign * (nx * vz - nz * vx)
        if slot == STRUCTURE_SLOT:
            x, n_x = rx, -sign * nx
        block = max(block, slot)
    u = base + h[16]
    if law[1] == 0.0 or block < 0:
        set_real(u, law[0] if law[0] >= 0.0 else rate_dependent(slip))
        return
    y, v_y = real(h[8] + 8 * block), real(h[9] + 8 * block)
    p, n_y = tilt(x, n_x, law[2], law[1], y)
    mu, more, across = shares(law, p, n_y, slip, v_y)
    set_real(u, mu * more * np.sqrt(max(1.0 - across * across, 0.0)))


def law_of(coefficient: float | str, revolved: bool = False, y: float = 0.0) -> Array:
    """Law of a pair, see LAW."""
    return np.array([-1.0 if coefficient == RATE_DEPENDENT else float(coefficient), float(revolved), y])


class PairFriction:
    """The two laws of a space, ice on ice and ice on structure, and the handlers that apply them and note contacts."""

    def __init__(self, space: Any, physics: RubblePhysics, revolved: bool, y: float, reader: ContactReader) -> None:
        self.ice, self.structure = law_of(physics.mu_ice_ice), law_of(physics.mu_structure, revolved, y)
        self._headers = [np.zeros(_FIXED + OFFSETS, np.int64) for _ in range(2)]
        for header, law in zip(self._headers, (self.ice, self.structure), strict=True):
            header[0], header[1], header[_FIXED:] = reader.header.ctypes.data, law.ctypes.data, offsets()
        for pair, kind in (((ICE, ICE), 0), ((ICE, SHEET), 0), ((ICE, STRUCTURE), 1)):
            handler = lib.cpSpaceAddCollisionHandler(space._space, *pair)
            law = (self.ice, self.structure)[kind]
            set_law = _set_constant if law[0] >= 0.0 and law[1] == 0.0 else _set_friction
            handler.preSolveFunc = ffi.cast("cpCollisionPreSolveFunc", set_law.address)
            handler.postSolveFunc = ffi.cast("cpCollisionPostSolveFunc", note_pair.address)
            handler.userData = ffi.cast("void *", self._headers[kind].ctypes.data)

    def watch(self, bodies: IntArray, slots: IntArray, state: Array, sheet_row: int, side: Array) -> None:
        """Where the callback finds the motion of the bodies; ``side`` (2, blocks) y and v_y. The caller keeps them."""
        for header in self._headers:
            header[2:_FIXED] = (
                len(bodies),
                bodies.ctypes.data,
                slots.ctypes.data,
                len(state),
                state.ctypes.data,
                sheet_row,
                side[0].ctypes.data,
                side[1].ctypes.data,
            )
