"""Contact impulses of a section, point by point, summed over every sub-step of a window.

pymunk's batch interface gives one impulse per pair of shapes; the moment on the sheet needs the share of each contact
point. The impulse solver keeps it (``cpContact.jnAcc``, ``jtAcc``), so a compiled callback reads it from the arbiters,
at the offsets that cffi reports for the installed pymunk. Body b receives ``j = jn n + jt perp(n)``, body a ``-j``; the
normal n points from a to b.

Sums are formed in the order of block numbers and places, never in pymunk's, which may follow memory addresses.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray, cfunc, njit, types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray
from pymunk._chipmunk_cffi import ffi, lib

from rubble.geometry import Array

IntArray = NDArray[np.int64]

STRUCTURE, SHEET = -1, -2  #: slots of the bodies that are no blocks
_UNKNOWN = -3

#: columns of a contact row: point on a and on b relative to the body's centre, impulse on b, impulse along the
#: normal, x component of the normal impulse on b
CONTACT_COLUMNS = 8
#: columns of the sums of a block over a window [N s]: impulse on the structure x, z; its normal part in x; sum of
#: normal impulses on the structure; on other ice; normal impulse times the point's x, z; impulse with the sheet
SUM_COLUMNS = 8


def _as_pointer(typingctx: Any, address: Any) -> Any:
    """An int64 address as a pointer that `carray` accepts."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), codegen


_pointer: Any = intrinsic(_as_pointer)


def _offsets() -> IntArray:
    """Where arbiter and contact keep what is read here, in bytes."""
    arbiter, contact = ffi.typeof("cpArbiter"), ffi.typeof("struct cpContact")
    fields = [ffi.offsetof(arbiter, n) for n in ("body_a", "body_b", "count", "contacts", "n", "state")]
    fields += [ffi.offsetof(contact, n) for n in ("r1", "r2", "jnAcc", "jtAcc")]
    return np.array([*fields, ffi.sizeof(contact)], dtype=np.int64)


@cfunc("void(voidptr, voidptr)", cache=True)
def _read_arbiter(arbiter: Any, header: Any) -> None:
    """Append the contacts of one arbiter. header: [rows, capacity, address of bodies, of values, offsets (11)]."""
    h = carray(header, 15, np.int64)
    at = carray(arbiter, 1024, np.uint8)
    base = at.ctypes.data
    count = carray(_pointer(base + h[6]), 1, np.int32)[0]
    state = carray(_pointer(base + h[9]), 1, np.int32)[0]
    if state > 1:  # 0 first contact, 1 persisting; ignored, cached and invalidated arbiters carry no impulse
        return
    n = carray(_pointer(base + h[8]), 2, np.float64)
    start = carray(_pointer(base + h[7]), 1, np.int64)[0]
    bodies, values = carray(_pointer(h[2]), (h[1], 2), np.int64), carray(_pointer(h[3]), (h[1], 8), np.float64)
    for k in range(count):
        row = h[0]
        h[0] += 1
        if row >= h[1]:
            continue  # counted, so that the caller can enlarge the table
        c = start + k * h[14]
        r1, r2 = carray(_pointer(c + h[10]), 2, np.float64), carray(_pointer(c + h[11]), 2, np.float64)
        jn, jt = carray(_pointer(c + h[12]), 1, np.float64)[0], carray(_pointer(c + h[13]), 1, np.float64)[0]
        bodies[row, 0] = carray(_pointer(base + h[4]), 1, np.int64)[0]
        bodies[row, 1] = carray(_pointer(base + h[5]), 1, np.int64)[0]
        values[row, 0], values[row, 1], values[row, 2], values[row, 3] = r1[0], r1[1], r2[0], r2[1]
        values[row, 4], values[row, 5] = jn * n[0] - jt * n[1], jn * n[1] + jt * n[0]
        values[row, 6], values[row, 7] = jn, jn * n[0]


class ContactReader:
    """Reads all contact points of a space after a step."""

    def __init__(self, capacity: int = 256) -> None:
        #: see `_read_arbiter`; 15 and 16 are the addresses of callback and header, for the compiled loop
        self.header = np.zeros(17, np.int64)
        self.header[4:15] = _offsets()
        self.header[15], self.header[16] = int(_read_arbiter.address or 0), self.header.ctypes.data
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


@njit("int64(int64, int64[::1], int64[::1])", cache=True, nogil=True)
def _slot(address: int, addresses: IntArray, slots: IntArray) -> int:
    i = np.searchsorted(addresses, address)
    return slots[i] if i < len(addresses) and addresses[i] == address else _UNKNOWN


@njit("boolean(int64[::1], float64[::1], int64[::1], float64[::1])", cache=True, nogil=True)
def _after(pair_a: IntArray, a: Array, pair_b: IntArray, b: Array) -> bool:
    for k in range(2):
        if pair_a[k] != pair_b[k]:
            return pair_a[k] > pair_b[k]
    for k in range(CONTACT_COLUMNS):
        if a[k] != b[k]:
            return a[k] > b[k]
    return False


@njit("int64[::1](int64, int64[:, ::1], float64[:, ::1])", cache=True, nogil=True)
def _order(n: int, pair: IntArray, values: Array) -> IntArray:
    """Rows sorted by pair of slots, then by place: the same for every run."""
    order = np.argsort(pair[:, 0] * 1_000_000 + pair[:, 1])  # nearly done; equal pairs are sorted below
    for i in range(1, n):
        here, j = order[i], i - 1
        while j >= 0 and _after(pair[order[j]], values[order[j]], pair[here], values[here]):
            order[j + 1] = order[j]
            j -= 1
        order[j + 1] = here
    return order


@njit("void(int64[::1], float64[::1])", cache=True, nogil=True)
def _swap(pair: IntArray, v: Array) -> None:
    pair[0], pair[1] = pair[1], pair[0]
    v[0], v[1], v[2], v[3] = v[2], v[3], v[0], v[1]
    v[4], v[5], v[7] = -v[4], -v[5], -v[7]


@njit("void(float64[::1], float64[::1])", cache=True, nogil=True)
def _on_structure(v: Array, block: Array) -> None:
    """A block's contact with the structure, whose body stands at the origin: v[0], v[1] is the point in the section."""
    block[0] -= v[4]
    block[1] -= v[5]
    block[2] -= v[7]
    block[3] += abs(v[6])
    block[5] += abs(v[6]) * v[0]
    block[6] += abs(v[6]) * v[1]


@njit("void(float64[::1], float64[::1], float64[:, ::1])", cache=True, nogil=True)
def _on_sheet(v: Array, sheet: Array, nodes: Array) -> None:
    """Share out a contact with the sheet to the two nodes next to it; force and moment are kept.

    Linear weights along x keep the moment of the vertical force. The horizontal force acts off the line of the nodes;
    its moment goes into a pair of vertical forces.
    """
    x, z, jx, jz = sheet[0] + v[0], sheet[1] + v[1], -v[4], -v[5]
    sheet[4] += v[4] * sheet[2] + v[5] * sheet[3]
    sheet[5] += jx
    sheet[6] += jz
    sheet[7] += x * jz - z * jx
    m = nodes.shape[0]
    if m == 1:
        nodes[0, 2] += jx
        nodes[0, 3] += jz
        return
    k = 0
    while k < m - 2 and x < nodes[k + 1, 0]:
        k += 1
    span = nodes[k, 0] - nodes[k + 1, 0]
    w = (x - nodes[k + 1, 0]) / span
    lever = w * nodes[k, 1] + (1.0 - w) * nodes[k + 1, 1] - z
    nodes[k, 2] += w * jx
    nodes[k, 3] += w * jz + jx * lever / span
    nodes[k + 1, 2] += (1.0 - w) * jx
    nodes[k + 1, 3] += (1.0 - w) * jz - jx * lever / span


@njit("int64(int64, int64[:, ::1], float64[:, ::1], int64[::1], int64[::1], float64[::1], float64[:, ::1], "
      "float64[:, ::1])", cache=True, nogil=True)
def accumulate(n: int, bodies: IntArray, values: Array, addresses: IntArray, slots: IntArray, sheet: Array,
               sums: Array, nodes: Array) -> int:
    """Add the impulses of one sub-step to the sums of the blocks and of the sheet's nodes.

    ``sums`` (blocks, 8) see SUM_COLUMNS; ``nodes`` (m, 4): x, z of the nodes and the impulse on them; ``sheet`` =
    (x, z of the sheet body's origin, its v_x, v_z, work done by the sheet on blocks, impulse x, z on it, moment).
    Returns the number of contacts with bodies that are neither block, sheet nor structure (must be 0).
    """
    pair = np.empty((n, 2), np.int64)
    strange = 0
    for i in range(n):
        pair[i, 0], pair[i, 1] = _slot(bodies[i, 0], addresses, slots), _slot(bodies[i, 1], addresses, slots)
        strange += pair[i, 0] == _UNKNOWN or pair[i, 1] == _UNKNOWN
        if pair[i, 0] > pair[i, 1]:  # smaller slot first: structure and sheet before blocks
            _swap(pair[i], values[i])
    for i in _order(n, pair, values):
        a, b, v = pair[i, 0], pair[i, 1], values[i]
        if b < 0:
            continue
        if a == STRUCTURE:
            _on_structure(v, sums[b])
        elif a == SHEET:
            _on_sheet(v, sheet, nodes)
            sums[b, 4] += abs(v[6])
            sums[b, 7] += abs(v[6])
        else:
            sums[a, 4] += abs(v[6])
            sums[b, 4] += abs(v[6])
    return strange
