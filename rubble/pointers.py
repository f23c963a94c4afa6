"""Memory of the installed pymunk as arrays inside compiled code: offsets that cffi reports, addresses of functions."""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray
from pymunk._chipmunk_cffi import ffi

IntArray = NDArray[np.int64]

#: fields of an arbiter and of a contact point that are read or set, in the order of `offsets`
ARBITER = ("body_a", "body_b", "count", "contacts", "n", "state", "u")
CONTACT = ("r1", "r2", "jnAcc", "jtAcc")
OFFSETS = len(ARBITER) + len(CONTACT) + 1


def offsets() -> IntArray:
    """Where arbiter and contact keep these fields, and the size of a contact [bytes]."""
    arbiter, contact = ffi.typeof("cpArbiter"), ffi.typeof("struct cpContact")
    fields = [ffi.offsetof(arbiter, n) for n in ARBITER] + [ffi.offsetof(contact, n) for n in CONTACT]
    return np.array([*fields, ffi.sizeof(contact)], dtype=np.int64)


def address(pointer: Any) -> int:
    """A cffi pointer as a number."""
    return int(ffi.cast("intptr_t", pointer))


def _as_pointer(typingctx: Any, number: Any) -> Any:
    """An int64 address as a pointer that `carray` accepts."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), codegen


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


pointer: Any = intrinsic(_as_pointer)
step_space: Any = intrinsic(_call_step)
for_each: Any = intrinsic(_call_each)
