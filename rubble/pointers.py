"""Memory of the installed pymunk in compiled code: where its fields stand, how they are read, written and called."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pymunk
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from pymunk._chipmunk_cffi import ffi


class ArbiterLayout(NamedTuple):
    """Where an arbiter and its contact points keep what is read or set [bytes]; names as in the library."""

    body_a: int
    body_b: int
    points: int  #: how many contact points
    contacts: int
    n: int
    data: int  #: a place that the library leaves to its user
    r1: int
    r2: int
    hash: int
    size: int  #: of a contact point


class BodyLayout(NamedTuple):
    """Where a body keeps its place [bytes]."""

    x: int
    z: int
    angle: int


def arbiter_layout() -> ArbiterLayout:
    """Where arbiter and contact of the installed library keep their fields."""
    arbiter, contact = ffi.typeof("cpArbiter"), ffi.typeof("struct cpContact")
    own = {n: int(ffi.offsetof(arbiter, n)) for n in ("body_a", "body_b", "contacts", "n", "data")}
    point = {n: int(ffi.offsetof(contact, n)) for n in ("r1", "r2", "hash")}
    return ArbiterLayout(points=int(ffi.offsetof(arbiter, "count")), size=int(ffi.sizeof(contact)), **own, **point)


def body_layout() -> BodyLayout:
    """Where a body keeps its place; cffi does not know the struct, so it is looked up in one with known values."""
    known = BodyLayout(0.5, -1.25, 0.375)  # type: ignore[arg-type]
    body = pymunk.Body(16.0, 64.0)
    body.position, body.angle = (known.x, known.z), known.angle
    memory = np.frombuffer(ffi.buffer(ffi.cast("char *", body._body), 8 * 18), np.float64)
    found = [np.flatnonzero(memory == value) for value in known]
    if any(len(at) == 0 for at in found):
        raise RuntimeError(f"pymunk {pymunk.version} keeps its bodies in another way; install a version that is tested")
    return BodyLayout(*(8 * int(at[0]) for at in found))


def address(pointer: Any) -> int:
    """A cffi pointer as a number."""
    return int(ffi.cast("intptr_t", pointer))


def _number(_typing: Any, _pointer: Any) -> Any:
    """A void pointer as an int64 address."""

    def codegen(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.ptrtoint(args[0], ir.IntType(64))

    return types.int64(types.voidptr), codegen


def _as_pointer(_typing: Any, _number: Any) -> Any:
    """An int64 address as a pointer that `carray` accepts."""

    def codegen(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], cgutils.voidptr_t)

    return types.voidptr(types.int64), codegen


def _reader(kind: Any, memory: Any) -> Any:
    def intrinsic_of(_typing: Any, _number: Any) -> Any:
        def codegen(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
            value = builder.load(builder.inttoptr(args[0], memory.as_pointer()))
            return builder.sext(value, ir.IntType(64)) if memory == ir.IntType(32) else value

        return kind(types.int64), codegen

    return intrinsic_of


def _writer(kind: Any, memory: Any) -> Any:
    def intrinsic_of(_typing: Any, _number: Any, _value: Any) -> Any:
        def codegen(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
            builder.store(args[1], builder.inttoptr(args[0], memory.as_pointer()))
            return _context.get_dummy_value()

        return types.void(types.int64, kind), codegen

    return intrinsic_of


def _call_step(_typing: Any, _function: Any, _space: Any, _dt: Any) -> Any:
    """function(space, dt) at an address, as cpSpaceStep."""

    def codegen(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t, ir.DoubleType()])
        target = builder.inttoptr(args[0], kind.as_pointer())
        builder.call(target, [builder.inttoptr(args[1], cgutils.voidptr_t), args[2]])
        return _context.get_dummy_value()

    return types.void(types.int64, types.int64, types.float64), codegen


def _call_set_corners(_typing: Any, _function: Any, _shape: Any, _count: Any, _corners: Any) -> Any:
    """function(shape, count, corners) at an address, as cpPolyShapeSetVertsRaw."""

    def codegen(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.VoidType(), [cgutils.voidptr_t, ir.IntType(32), cgutils.voidptr_t])
        target = builder.inttoptr(args[0], kind.as_pointer())
        shape, corners = (builder.inttoptr(args[k], cgutils.voidptr_t) for k in (1, 3))
        builder.call(target, [shape, builder.trunc(args[2], ir.IntType(32)), corners])
        return _context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64, types.int64), codegen


number: Any = intrinsic(_number)
pointer: Any = intrinsic(_as_pointer)
step_space: Any = intrinsic(_call_step)
set_corners: Any = intrinsic(_call_set_corners)
#: value of an address
real: Any = intrinsic(_reader(types.float64, ir.DoubleType()))
integer: Any = intrinsic(_reader(types.int64, ir.IntType(64)))
short: Any = intrinsic(_reader(types.int64, ir.IntType(32)))
#: write a value to an address
set_real: Any = intrinsic(_writer(types.float64, ir.DoubleType()))
set_integer: Any = intrinsic(_writer(types.int64, ir.IntType(64)))
