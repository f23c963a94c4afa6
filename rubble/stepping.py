"""The loop over the sub-steps of a window, compiled: forces, step, contacts, without Python in between.

A Python loop costs as much as the solver for a section of thirty blocks, and two threads gain nothing because each of
many short calls waits for the interpreter lock. Here one compiled call holds no lock for a whole window. It calls the
same library functions as `pymunk.Space.step` and `pymunk.batch`, by the addresses that cffi reports.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray, njit
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from rubble.contacts import accumulate
from rubble.geometry import Array
from rubble.pointers import IntArray, address, for_each, pointer, step_space
from rubble.sheet import spring_force
from rubble.water import apply_water


class Calls:
    """Addresses of what the compiled loop calls, and the C structs that it hands over (kept alive here)."""

    def __init__(self, space: Any, get: batch.Buffer, fields: Any, put: batch.Buffer, put_fields: Any) -> None:
        self._kept = [self._struct(get, fields), self._struct(put, put_fields)]
        float_num, int_num = ffi.offsetof("pmFloatArray", "num"), ffi.offsetof("pmIntArray", "num")
        functions = [ffi.addressof(lib, n) for n in (
            "cpSpaceStep", "cpSpaceEachBody", "pmSpaceBodyGetIteratorFuncBatched", "pmSpaceBodySetIteratorFuncBatched")]
        numbers = [address(get._float_arr) + float_num, address(get._int_arr) + int_num,
                   address(put._float_arr) + float_num]
        kept = map(address, self._kept)
        self.table = np.array([*map(address, functions), address(space._space), *kept, *numbers], np.int64)

    @staticmethod
    def _struct(buffer: batch.Buffer, fields: Any) -> Any:
        data = ffi.new("pmBatchedData *")
        data.fields, data.floatArray, data.intArray = fields.value, buffer._float_arr, buffer._int_arr
        return data


@njit("int64(int64, float64, int64[::1], int64[::1], float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], "
      "int64[::1], float64[:, ::1], float64[::1], float64[::1], float64[::1], int64, float64[::1], float64[::1], "
      "int64[:, ::1], float64[:, ::1], int64[::1], int64[::1], float64[::1], float64[:, ::1], float64[::1], "
      "float64[::1], float64[:, ::1], float64[:, ::1], float64[:, ::1])", cache=True, nogil=True)
def run(n: int, dt: float, calls: IntArray, header: IntArray, state: Array, force: Array, row: IntArray, edges: Array,
        offset: IntArray, dead: Array, water: Array, flooded: Array, losses: Array, sheet_row: int, spring: Array,
        driver: Array, bodies: IntArray, values: Array, addresses: IntArray, slots: IntArray, law: Array, side: Array,
        limit: Array, sheet: Array, sums: Array, nodes: Array, heavy: Array) -> int:
    """Do up to ``n`` sub-steps and returns how many; fewer when the table of contacts (``header``) is half full.

    ``state`` is the memory that the batch interface fills: valid before the call and after every step. -1: a contact
    did not fit any more; -2: one with a body that is no block, sheet or structure.
    """
    get_floats, get_ints = carray(pointer(calls[7]), 1, np.int32), carray(pointer(calls[8]), 1, np.int32)
    put_floats = carray(pointer(calls[9]), 1, np.int32)
    for k in range(n):
        apply_water(edges, offset, dead, water, flooded, row, state, force, losses)
        if sheet_row >= 0:
            spring_force(spring, dt, driver, state[sheet_row], force[sheet_row])
        header[0] = put_floats[0] = 0
        for_each(calls[1], calls[4], calls[3], calls[6])
        step_space(calls[0], calls[4], dt)
        get_floats[0] = get_ints[0] = 0
        for_each(calls[1], calls[4], calls[2], calls[5])
        if sheet_row >= 0:
            sheet[0], sheet[1] = state[sheet_row, 0], state[sheet_row, 1]
            sheet[2], sheet[3] = state[sheet_row, 3], state[sheet_row, 4]
        if header[0] > header[1]:
            return -1
        if header[0] > 0 and accumulate(header[0], bodies, values, addresses, slots, row, state, law, side, limit,
                                        sheet, sums, nodes, heavy) > 0:
            return -2
        if 2 * header[0] > header[1]:
            return k + 1
    return n
