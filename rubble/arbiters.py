"""Contacts of a pymunk space with their impulses, noted by a compiled callback while the space is stepped.

pymunk's batch interface gives one impulse per pair of shapes; the moment on the sheet needs the share of each contact
point. The impulse solver keeps it (``cpContact.jnAcc``, ``jtAcc``), and its post-solve callback comes in the order in
which the solver goes through the pairs: the same for every run. The callback keeps the address of the pair's arbiter,
whose contacts stay as they are until the next step. Body b receives ``j = jn n + jt perp(n)``, body a ``-j``; the
normal n points from a to b.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rubble.compiled import callback, compiled
from rubble.geometry import Array
from rubble.pointers import IntArray, integer, number, offsets, real, set_integer

#: columns of a contact: point on a and on b relative to the body's centre, impulse on b, impulse along the normal,
#: x and z component of the normal impulse on b
CONTACT_COLUMNS = 9


@callback("void(voidptr, voidptr, voidptr)")
def note_pair(arbiter: Any, space: Any, data: Any) -> None:
    """Post-solve callback: append the address of an arbiter; data: its first entry is the address of the header."""
    header = integer(number(data))
    count = integer(header)
    set_integer(header, count + 1)  # counted in any case, so that a loss is noticed
    if count < integer(header + 8):
        set_integer(integer(header + 16) + 8 * count, number(arbiter))


@compiled("void(int64, int64, int64[::1], bool_, float64[::1])", nogil=True)
def read_contact(arbiter: int, contact: int, layout: IntArray, turn: bool, v: Array) -> None:
    """One contact of an arbiter as a row, see CONTACT_COLUMNS; ``turn``: as seen from the other body."""
    a, b, sign = (layout[8], layout[7], -1.0) if turn else (layout[7], layout[8], 1.0)
    nx, nz = real(arbiter + layout[4]), real(arbiter + layout[4] + 8)
    jn, jt = real(contact + layout[9]), real(contact + layout[10])
    v[0], v[1], v[2], v[3] = real(contact + a), real(contact + a + 8), real(contact + b), real(contact + b + 8)
    v[4], v[5] = sign * (jn * nx - jt * nz), sign * (jn * nz + jt * nx)
    v[6], v[7], v[8] = jn, sign * (jn * nx), sign * (jn * nz)


class ContactReader:
    """List of the pairs in contact that the callback fills during a step."""

    def __init__(self, capacity: int = 256) -> None:
        self.header = np.zeros(3, np.int64)  #: pairs, room, address of the list
        self.layout = offsets()
        self.reserve(capacity)

    @property
    def capacity(self) -> int:
        """Pairs that fit."""
        return len(self.pairs)

    def reserve(self, capacity: int) -> None:
        """Make room for so many pairs."""
        self.pairs = np.zeros(capacity, np.int64)
        self.header[1:] = capacity, self.pairs.ctypes.data
