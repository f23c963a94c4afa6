"""Contact points of a pymunk space with their impulses, noted by a compiled callback while the space is stepped.

pymunk's batch interface gives one impulse per pair of shapes; the moment on the sheet needs the share of each contact
point. The impulse solver keeps it (``cpContact.jnAcc``, ``jtAcc``), and its post-solve callback comes in the order in
which the solver goes through the contacts: the same for every run. Body b receives ``j = jn n + jt perp(n)``, body a
``-j``; the normal n points from a to b.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray, cfunc

from rubble.pointers import OFFSETS, offsets, pointer

#: columns of a contact row: point on a and on b relative to the body's centre, impulse on b, impulse along the
#: normal, x and z component of the normal impulse on b
CONTACT_COLUMNS = 9
HEADER = 4 + OFFSETS  #: rows, capacity, addresses of bodies and of values, offsets


@cfunc("void(voidptr, voidptr, voidptr)", cache=True)
def note_contacts(arbiter: Any, space: Any, data: Any) -> None:
    """Post-solve callback: append the contacts of one arbiter; data: its first entry is the address of the header."""
    h = carray(pointer(carray(data, 1, np.int64)[0]), HEADER, np.int64)
    base = carray(arbiter, 8, np.uint8).ctypes.data
    count = carray(pointer(base + h[6]), 1, np.int32)[0]
    n = carray(pointer(base + h[8]), 2, np.float64)
    start = carray(pointer(base + h[7]), 1, np.int64)[0]
    a, b = carray(pointer(base + h[4]), 1, np.int64)[0], carray(pointer(base + h[5]), 1, np.int64)[0]
    bodies, values = carray(pointer(h[2]), (h[1], 2), np.int64), carray(pointer(h[3]), (h[1], 9), np.float64)
    for k in range(count):
        row = h[0]
        if row >= h[1]:
            h[0] += 1  # counted, so that the loss is noticed
            continue
        c = start + k * h[15]
        r1, r2 = carray(pointer(c + h[11]), 2, np.float64), carray(pointer(c + h[12]), 2, np.float64)
        jn, jt = carray(pointer(c + h[13]), 1, np.float64)[0], carray(pointer(c + h[14]), 1, np.float64)[0]
        bodies[row, 0], bodies[row, 1] = a, b
        values[row, 0], values[row, 1], values[row, 2], values[row, 3] = r1[0], r1[1], r2[0], r2[1]
        values[row, 4], values[row, 5] = jn * n[0] - jt * n[1], jn * n[1] + jt * n[0]
        values[row, 6], values[row, 7], values[row, 8] = jn, jn * n[0], jn * n[1]
        h[0] += 1


class ContactReader:
    """Table that the callback fills during a step."""

    def __init__(self, capacity: int = 256) -> None:
        self.header = np.zeros(HEADER, np.int64)
        self.header[4:] = offsets()
        self.reserve(capacity)

    @property
    def capacity(self) -> int:
        """Contacts that fit."""
        return len(self.values)

    def reserve(self, capacity: int) -> None:
        """Make room for so many contacts."""
        self.bodies = np.zeros((capacity, 2), np.int64)
        self.values = np.zeros((capacity, CONTACT_COLUMNS))
        self.header[1:4] = capacity, self.bodies.ctypes.data, self.values.ctypes.data
