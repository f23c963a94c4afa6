"""Memory of the installed pymunk in compiled code: where its fields stand, how they are read, written and called."""

from __future__ import annotations

from typing import Any

import numpy as np
import pymunk
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray
from pymunk._chipmunk_cffi import ffi, lib

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


def body_offsets() -> IntArray:
    """Where a body keeps x, z, angle, v_x, v_z, omega, force x, z, torque, 1 / mass, 1 / moment of inertia [bytes].

    cffi does not know the struct, so they are looked up in a body with known values.
    """
    known = np.array([0.5, -1.25, 0.375, 2.75, -3.5, 4.125, -5.25, 6.625, 7.875, 0.0625, 0.015625])
    body = pymunk.Body(16.0, 64.0)
    body.position, body.angle, body.velocity = (known[0], known[1]), known[2], (known[3], known[4])
    body.angular_velocity, body.torque = known[5], known[8]
    lib.cpBodySetForce(body._body, (known[6], known[7]))
    memory = np.frombuffer(ffi.buffer(ffi.cast("char *", body._body), 8 * 18), np.float64)
    found = [np.flatnonzero(memory == value) for value in known]
    if any(len(at) == 0 for at in found):
        raise RuntimeError(f"pymunk {pymunk.version} keeps its bodies in another way; install a version that is tested")
    return np.array([8 * at[0] for at in found], dtype=np.int64)


def address(pointer: Any) -> int:
    """A cffi pointer as a number."""
    return int(ffi.cast("intptr_t", pointer))


def _number(typingctx: Any, pointer: Any) -> Any:
    """A void pointer as an int64 address."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.ptrtoint(args[0], ir.IntType(64))

    return types.int64(types.voidptr), codegen


def _as_pointer(typingctx: Any, number: Any) -> Any:
    """An int64 address as a pointer that `carray` accepts."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), codegen


def _reader(kind: Any, memory: Any) -> Any:
    def intrinsic_of(typingctx: Any, number: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            value = builder.load(builder.inttoptr(args[0], memory.as_pointer()))
            return builder.sext(value, ir.IntType(64)) if memory == ir.IntType(32) else value

        return kind(types.int64), codegen

    return intrinsic_of


def _writer(kind: Any, memory: Any) -> Any:
    def intrinsic_of(typingctx: Any, number: Any, value: Any) -> Any:
        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            builder.store(args[1], builder.inttoptr(args[0], memory.as_pointer()))
            return context.get_dummy_value()

        return types.void(types.int64, kind), codegen

    return intrinsic_of


def _call_step(typingctx: Any, function: Any, space: Any, dt: Any) -> Any:
    """function(space, dt) at an address, as cpSpaceStep."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t, ir.DoubleType()])
        target = builder.inttoptr(args[0], kind.as_pointer())
        builder.call(target, [builder.inttoptr(args[1], cgutils.voidptr_t), args[2]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.float64), codegen


number: Any = intrinsic(_number)
pointer: Any = intrinsic(_as_pointer)
step_space: Any = intrinsic(_call_step)
#: value of an address
real: Any = intrinsic(_reader(types.float64, ir.DoubleType()))
integer: Any = intrinsic(_reader(types.int64, ir.IntType(64)))
short: Any = intrinsic(_reader(types.int64, ir.IntType(32)))
#: write a value to an address
set_real: Any = intrinsic(_writer(types.float64, ir.DoubleType()))
set_integer: Any = intrinsic(_writer(types.int64, ir.IntType(64)))
