"""Contact points of a pymunk space with their impulses, read by a compiled callback.

pymunk's batch interface gives one impulse per pair of shapes; the moment on the sheet needs the share of each contact
point. The impulse solver keeps it (``cpContact.jnAcc``, ``jtAcc``). Body b receives ``j = jn n + jt perp(n)``, body a
``-j``; the normal n points from a to b.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray, cfunc
from pymunk._chipmunk_cffi import ffi, lib

from rubble.pointers import OFFSETS, offsets, pointer

#: columns of a contact row: point on a and on b relative to the body's centre, impulse on b, impulse along the
#: normal, x and z component of the normal impulse on b
CONTACT_COLUMNS = 9
HEADER = 4 + OFFSETS  #: rows, capacity, addresses of bodies and of values, offsets


@cfunc("void(voidptr, voidptr)", cache=True)
def _read_arbiter(arbiter: Any, header: Any) -> None:
    """Append the contacts of one arbiter."""
    h = carray(header, HEADER, np.int64)
    base = carray(arbiter, 8, np.uint8).ctypes.data
    count = carray(pointer(base + h[6]), 1, np.int32)[0]
    state = carray(pointer(base + h[9]), 1, np.int32)[0]
    if state > 1:  # 0 first contact, 1 persisting; ignored, cached and invalidated arbiters carry no impulse
        return
    n = carray(pointer(base + h[8]), 2, np.float64)
    start = carray(pointer(base + h[7]), 1, np.int64)[0]
    bodies, values = carray(pointer(h[2]), (h[1], 2), np.int64), carray(pointer(h[3]), (h[1], 9), np.float64)
    for k in range(count):
        row = h[0]
        h[0] += 1
        if row >= h[1]:
            continue  # counted, so that the caller can enlarge the table
        c = start + k * h[15]
        r1, r2 = carray(pointer(c + h[11]), 2, np.float64), carray(pointer(c + h[12]), 2, np.float64)
        jn, jt = carray(pointer(c + h[13]), 1, np.float64)[0], carray(pointer(c + h[14]), 1, np.float64)[0]
        bodies[row, 0] = carray(pointer(base + h[4]), 1, np.int64)[0]
        bodies[row, 1] = carray(pointer(base + h[5]), 1, np.int64)[0]
        values[row, 0], values[row, 1], values[row, 2], values[row, 3] = r1[0], r1[1], r2[0], r2[1]
        values[row, 4], values[row, 5] = jn * n[0] - jt * n[1], jn * n[1] + jt * n[0]
        values[row, 6], values[row, 7], values[row, 8] = jn, jn * n[0], jn * n[1]


class ContactReader:
    """Reads all contact points of a space after a step."""

    def __init__(self, capacity: int = 256) -> None:
        #: see HEADER; the two last are the addresses of callback and header, for the compiled loop
        self.header = np.zeros(HEADER + 2, np.int64)
        self.header[4:HEADER] = offsets()
        self.header[HEADER:] = int(_read_arbiter.address or 0), self.header.ctypes.data
        self._call = ffi.cast("void (*)(cpArbiter *, void *)", _read_arbiter.address)
        self._allocate(capacity)

    def _allocate(self, capacity: int) -> None:
        self.bodies = np.zeros((capacity, 2), np.int64)
        self.values = np.zeros((capacity, CONTACT_COLUMNS))
        self.header[1:4] = capacity, self.bodies.ctypes.data, self.values.ctypes.data
        self._data = ffi.cast("void *", self.header.ctypes.data)

    def read(self, space: Any) -> int:
        """Fill ``bodies`` (addresses) and ``values``; returns the number of contact points."""
        self.header[0] = 0
        lib.cpSpaceEachCachedArbiter(space._space, self._call, self._data)
        if self.header[0] > self.header[1]:
            self._allocate(2 * int(self.header[0]))
            return self.read(space)
        return int(self.header[0])
