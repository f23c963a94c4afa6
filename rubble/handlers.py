"""What pymunk calls in every sub-step: friction of each pair before it is solved, the list of pairs afterwards."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # numba exports it without saying so
from pymunk._chipmunk_cffi import ffi, lib

from rubble.arbiters import ContactReader, note_pair
from rubble.arrays import Records, record
from rubble.bodies import LATERAL, STATE, Bodies
from rubble.compiled import callback
from rubble.cut import FACE, IN_PLANE, nearest
from rubble.friction import LAW, coefficient, law_of, split, tilt
from rubble.physics import RubblePhysics
from rubble.pointers import ArbiterLayout, integer, number, pointer, real, set_real
from rubble.slots import SHEET_SLOT, STRUCTURE_SLOT, Slots, slot_of

ICE, STRUCTURE, SHEET = 1, 2, 3  #: collision types
#: what a callback is given: addresses and lengths of the tables; ``list`` comes first, see `arbiters.note_pair`
TABLES = record(
    integers=(
        *("list", "law", "places", "address", "slot", "bodies", "state", "sheet_row", "blocks", "lateral"),
        *("faces", "face_count", *ArbiterLayout._fields),
    )
)


@callback("void(voidptr, voidptr, voidptr)")
def _set_constant(arbiter: Any, _space: Any, data: Any) -> None:
    """Pre-solve callback: a coefficient that does not depend on the motion, into the arbiter."""
    tables = carray(data, 1, TABLES)[0]
    set_real(number(arbiter) + tables.u, carray(pointer(tables.law), 1, LAW)[0].mu)


@callback("void(voidptr, voidptr, voidptr)")
def _set_friction(arbiter: Any, _space: Any, data: Any) -> None:
    """Pre-solve callback: friction of the pair into the arbiter.

    On a face whose normal lies in the plane the pair's own coefficient counts, whatever the lateral slip.
    """
    tables, base = carray(data, 1, TABLES)[0], number(arbiter)
    law = carray(pointer(tables.law), 1, LAW)[0]
    address = carray(pointer(tables.address), tables.places, np.int64)
    slots = carray(pointer(tables.slot), tables.places, np.int64)
    state = carray(pointer(tables.state), tables.bodies, STATE)
    nx, nz = real(base + tables.n), real(base + tables.n + 8)
    c = integer(base + tables.contacts)
    slip, x, z, n_x, block = 0.0, 0.0, 0.0, 0.0, -1
    for side in range(2):
        body, point = (tables.body_b, tables.r2) if side == 1 else (tables.body_a, tables.r1)
        slot, sign = slot_of(integer(base + body), address, slots), 1.0 if side == 1 else -1.0
        rx, rz = real(c + point), real(c + point + 8)
        row = tables.sheet_row if slot == SHEET_SLOT else slot
        if row >= 0:
            s = state[row]
            vx, vz = s.v_x - s.omega * rz, s.v_z + s.omega * rx
            slip += sign * (nx * vz - nz * vx)
        if slot == STRUCTURE_SLOT:
            x, z, n_x = rx, rz, -sign * nx
        block = max(block, slot)
    u = base + tables.u
    faces = carray(pointer(tables.faces), tables.face_count, FACE)
    face = faces[nearest(faces, x, z)]
    if block < 0 or (face.constant == 0.0 and face.radial == 0.0):
        set_real(u, coefficient(law, slip))
        return
    own = carray(pointer(tables.lateral), tables.blocks, LATERAL)[block]
    found = split(law, tilt(face, x, n_x, law.y, own.y), slip, own.v_y)
    set_real(u, found.mu * found.true * np.sqrt(max(1.0 - found.lateral * found.lateral, 0.0)))


class Handlers:
    """The two laws of a space, ice on ice and ice on structure, and the callbacks that apply them and note pairs."""

    def __init__(self, space: Any, physics: RubblePhysics, faces: Records, y: float, reader: ContactReader) -> None:
        """``faces``: `cut.Cut.bearings` of the section y."""
        self.structure, self._ice = law_of(physics.mu_structure, y), law_of(physics.mu_ice_ice)
        self.faces, self._between_ice = faces, _in_plane()
        self._tables = np.zeros(2, TABLES)  #: a row for each of the laws
        self._tables["list"] = reader.list.ctypes.data
        for name, offset in reader.layout._asdict().items():
            self._tables[name] = offset
        for row, law, looks, kinds in (
            (0, self._ice, self._between_ice, (ICE, SHEET)),
            (1, self.structure, faces, (STRUCTURE,)),
        ):
            tables = self._tables[row : row + 1]
            tables["law"], tables["faces"], tables["face_count"] = law.ctypes.data, looks.ctypes.data, len(looks)
            constant = law["mu"][0] >= 0.0 and not (looks["constant"].any() or looks["radial"].any())
            before = _set_constant if constant else _set_friction
            for kind in kinds:
                handler = lib.cpSpaceAddCollisionHandler(space._space, ICE, kind)
                handler.preSolveFunc = ffi.cast("cpCollisionPreSolveFunc", before.address)
                handler.postSolveFunc = ffi.cast("cpCollisionPostSolveFunc", note_pair.address)
                handler.userData = ffi.cast("void *", tables.ctypes.data)

    def watch(self, bodies: Bodies, slots: Slots, lateral: Records) -> None:
        """Where the callbacks find the motion of the bodies. The caller keeps the arrays."""
        tables = self._tables
        tables["places"], tables["address"] = len(slots.address), slots.address.ctypes.data
        tables["slot"] = slots.slot.ctypes.data
        tables["bodies"], tables["state"] = len(bodies.state), bodies.state.ctypes.data
        tables["sheet_row"], tables["blocks"] = bodies.blocks, bodies.blocks
        tables["lateral"] = lateral.ctypes.data


def _in_plane() -> Records:
    """Contacts among ice lie in the plane."""
    face = np.zeros(1, FACE)
    face["constant"], face["radial"] = IN_PLANE
    return face
