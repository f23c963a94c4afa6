"""Contacts of a pymunk space with their impulses, noted by a compiled callback while the space is stepped.

pymunk's batch interface gives one impulse per pair of shapes; the moment on the sheet needs the part of each contact
point. The impulse solver keeps it (``cpContact.jnAcc``, ``jtAcc``), and its post-solve callback comes in the order in
which the solver goes through the pairs: the same for every run. The callback keeps the address of the pair's arbiter,
whose contacts stay as they are until the next step. Body b receives ``j = jn n + jt perp(n)``, body a ``-j``; the
normal n points from a to b.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # numba exports it without saying so

from rubble.arrays import IntArray, Records, record
from rubble.compiled import callback, compiled
from rubble.pointers import ArbiterLayout, arbiter_layout, integer, number, pointer, real, set_integer

#: pairs counted in a sub-step, pairs that fit into the list, address of the list
LIST = record(integers=("count", "room", "address"))


class Pairs(NamedTuple):
    """The pairs in contact in a sub-step."""

    list: Records  #: (1,) LIST
    arbiter: IntArray  #: (room,) addresses of the arbiters
    layout: ArbiterLayout


class Contact(NamedTuple):
    """One contact point of two bodies a and b, as the solver has left it."""

    a_x: float  #: the point, relative to the centre of body a [m]
    a_z: float
    b_x: float  #: the same point, relative to the centre of body b [m]
    b_z: float
    j_x: float  #: impulse on body b [N s]
    j_z: float
    push: float  #: its part along the normal [N s]
    push_x: float  #: the same as a vector [N s]
    push_z: float


@callback("void(voidptr, voidptr, voidptr)")
def note_pair(arbiter: Any, _space: Any, data: Any) -> None:
    """Post-solve callback: append the address of an arbiter; data: its first entry is the address of the `LIST`."""
    found = carray(pointer(integer(number(data))), 1, LIST)[0]
    count = found.count
    found.count = count + 1  # counted in any case, so that a loss is noticed
    if count < found.room:
        set_integer(found.address + 8 * count, number(arbiter))


@compiled(nogil=True)
def read_contact(arbiter: int, contact: int, layout: ArbiterLayout, turn: bool) -> Contact:
    """One contact of an arbiter; ``turn``: as seen from the other body."""
    a, b, sign = (layout.r2, layout.r1, -1.0) if turn else (layout.r1, layout.r2, 1.0)
    nx, nz = real(arbiter + layout.n), real(arbiter + layout.n + 8)
    jn, jt = real(contact + layout.jn), real(contact + layout.jt)
    return Contact(
        a_x=real(contact + a),
        a_z=real(contact + a + 8),
        b_x=real(contact + b),
        b_z=real(contact + b + 8),
        j_x=sign * (jn * nx - jt * nz),
        j_z=sign * (jn * nz + jt * nx),
        push=jn,
        push_x=sign * (jn * nx),
        push_z=sign * (jn * nz),
    )


class ContactReader:
    """List of the pairs in contact that the callback fills during a step."""

    def __init__(self, capacity: int = 256) -> None:
        self.list = np.zeros(1, LIST)
        self.layout = arbiter_layout()
        self.reserve(capacity)

    @property
    def count(self) -> int:
        """Pairs in contact in the last sub-step."""
        return int(self.list["count"][0])

    @property
    def capacity(self) -> int:
        """Pairs that fit."""
        return len(self.pairs.arbiter)

    def reserve(self, capacity: int) -> None:
        """Make room for so many pairs."""
        arbiter = np.zeros(capacity, np.int64)
        self.list["room"], self.list["address"] = capacity, arbiter.ctypes.data
        self.pairs = Pairs(self.list, arbiter, self.layout)
