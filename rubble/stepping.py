"""The loop over the sub-steps of a window, compiled: forces, step, contacts, without Python in between.

A Python loop costs as much as the solver for a section of thirty blocks, and two threads gain nothing because each of
many short calls waits for the interpreter lock. Here one compiled call holds no lock for a whole window. It calls the
same library functions as `pymunk.Space.step` and `pymunk.batch`, by the addresses that cffi reports.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import carray, njit, types
from numba.core import cgutils
from numba.extending import intrinsic
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

from rubble.contacts import IntArray, _pointer, accumulate
from rubble.geometry import Array
from rubble.sheet import spring_force
from rubble.water import apply_water


def _call_step(typingctx: Any, function: Any, space: Any, dt: Any) -> Any:
    """function(space, dt) at an address, as cpSpaceStep."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t, ir.DoubleType()])
        target = builder.inttoptr(args[0], kind.as_pointer())
        builder.call(target, [builder.inttoptr(args[1], cgutils.voidptr_t), args[2]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.float64), codegen


def _call_each(typingctx: Any, function: Any, space: Any, callback: Any, data: Any) -> Any:
    """function(space, callback, data) at an address, as cpSpaceEachBody."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t] * 3)
        target = builder.inttoptr(args[0], kind.as_pointer())
        builder.call(target, [builder.inttoptr(a, cgutils.voidptr_t) for a in args[1:]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64, types.int64), codegen


step_space: Any = intrinsic(_call_step)
for_each: Any = intrinsic(_call_each)


class Calls:
    """Addresses of what the compiled loop calls, and the C structs that it hands over (kept alive here)."""

    def __init__(self, space: Any, get: batch.Buffer, fields: Any, put: batch.Buffer, put_fields: Any) -> None:
        self._kept = [self._struct(get, fields), self._struct(put, put_fields)]
        float_num, int_num = ffi.offsetof("pmFloatArray", "num"), ffi.offsetof("pmIntArray", "num")
        functions = [ffi.addressof(lib, n) for n in (
            "cpSpaceStep", "cpSpaceEachBody", "cpSpaceEachCachedArbiter", "pmSpaceBodyGetIteratorFuncBatched",
            "pmSpaceBodySetIteratorFuncBatched")]
        numbers = [_at(get._float_arr) + float_num, _at(get._int_arr) + int_num, _at(put._float_arr) + float_num]
        self.table = np.array([*map(_at, functions), _at(space._space), *map(_at, self._kept), *numbers], np.int64)

    @staticmethod
    def _struct(buffer: batch.Buffer, fields: Any) -> Any:
        data = ffi.new("pmBatchedData *")
        data.fields, data.floatArray, data.intArray = fields.value, buffer._float_arr, buffer._int_arr
        return data


def _at(pointer: Any) -> int:
    return int(ffi.cast("intptr_t", pointer))


@njit("int64(int64, float64, int64[::1], int64[::1], float64[:, ::1], float64[:, ::1], int64[::1], float64[:, ::1], "
      "int64[::1], float64[::1], float64[::1], float64[::1], int64, float64[::1], float64[::1], int64[:, ::1], "
      "float64[:, ::1], int64[::1], int64[::1], float64[::1], float64[:, ::1], float64[:, ::1])", cache=True,
      nogil=True)
def run(n: int, dt: float, calls: IntArray, header: IntArray, state: Array, force: Array, row: IntArray, edges: Array,
        offset: IntArray, weight: Array, water: Array, losses: Array, sheet_row: int, spring: Array, driver: Array,
        bodies: IntArray, values: Array, addresses: IntArray, slots: IntArray, sheet: Array, sums: Array,
        nodes: Array) -> int:
    """Do ``n`` sub-steps; returns how many contacts were summed (n), or the sub-step whose contacts did not fit.

    ``state`` is the memory that the batch interface fills: valid before the call and after every step. -1 - k means
    that sub-step k met a body that is no block, sheet or structure.
    """
    get_floats, get_ints = carray(_pointer(calls[8]), 1, np.int32), carray(_pointer(calls[9]), 1, np.int32)
    put_floats = carray(_pointer(calls[10]), 1, np.int32)
    for k in range(n):
        apply_water(edges, offset, weight, water, row, state, force, losses)
        if sheet_row >= 0:
            spring_force(spring, dt, driver, state[sheet_row], force[sheet_row])
        put_floats[0] = 0
        for_each(calls[1], calls[5], calls[4], calls[7])
        step_space(calls[0], calls[5], dt)
        get_floats[0] = get_ints[0] = 0
        for_each(calls[1], calls[5], calls[3], calls[6])
        if sheet_row >= 0:
            sheet[0], sheet[1] = state[sheet_row, 0], state[sheet_row, 1]
            sheet[2], sheet[3] = state[sheet_row, 3], state[sheet_row, 4]
        header[0] = 0
        for_each(calls[2], calls[5], header[15], header[16])
        if header[0] > header[1]:
            return k
        if header[0] > 0 and accumulate(header[0], bodies, values, addresses, slots, sheet, sums, nodes) > 0:
            return -1 - k
    return n
