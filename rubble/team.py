"""Threads that go through the sub-steps of one kernel together, and wait for each other between its parts.

A kernel that is worked on by a team is called once per thread. Its work is cut into `TILES` parts whatever the size of
the team: each part has sums of its own and writes what no other part writes, so that one thread that does all parts
has the same bits as two that do one each.

The last thread to come to `together` is waited for in a busy loop, which costs a few hundred nanoseconds where each
thread has a core; where it has none, the waiting one gives its own core away.

The same file stands in every package whose kernels are worked on so, because packages of solvers do not import each
other; a test keeps the copies equal but for the name of their package.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Lock
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from rubble.compiled import compiled

LINE = 8  #: numbers in a cache line
TILES = 2  #: parts of the work, and the most threads that a team has
PATIENCE = 4000  #: looks at the others, some microseconds, after which a thread that waits gives its core away


class Team(NamedTuple):
    """What one thread of a team knows."""

    member: int  #: which it is
    size: int  #: threads in all
    arrived: NDArray[np.int64]  #: (TILES * LINE,) how often each has come to `together`, on a cache line of its own
    yielding: int  #: address of a function without arguments that gives the core away
    given: NDArray[np.float64]  #: room for what parts leave to each other; none where there is one thread


def at_a_line(count: int, kind: type[np.generic]) -> NDArray[Any]:
    """So many zeros, of 8 bytes each, of which the first is the first of a cache line."""
    raw = np.zeros(count + LINE, kind)
    start = -raw.ctypes.data // 8 % LINE
    return raw[start : start + count]


def _address() -> int:
    """Of the system's function that lets another thread have the core."""
    library: Any = ctypes.windll.kernel32 if os.name == "nt" else ctypes.CDLL(None)  # type: ignore[attr-defined,unused-ignore]
    function = library.SwitchToThread if os.name == "nt" else library.sched_yield
    return int(ctypes.cast(function, ctypes.c_void_p).value or 0)


def _seen(_typing: Any, _numbers: Any, _at: Any) -> Any:
    """A number that another thread may have written, and all that this wrote before."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load_atomic(_place(context, builder, signature, args), "acquire", 8)

    return types.int64(_numbers, types.intp), codegen


def _shown(_typing: Any, _numbers: Any, _at: Any, _value: Any) -> Any:
    """Writes a number that others may see, after all that was written before."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store_atomic(args[2], _place(context, builder, signature, args), "release", 8)
        return context.get_dummy_value()

    return types.void(_numbers, types.intp, types.int64), codegen


def _place(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    array = context.make_array(signature.args[0])(context, builder, args[0])
    return builder.gep(array.data, [args[1]])


def _called(_typing: Any, _function: Any) -> Any:
    """Calls a function without arguments at an address."""

    def codegen(context: Any, builder: Any, _signature: Any, args: Any) -> Any:
        kind = ir.FunctionType(ir.IntType(32), [])
        builder.call(builder.inttoptr(args[0], kind.as_pointer()), [])
        return context.get_dummy_value()

    return types.void(types.int64), codegen


seen: Any = intrinsic(_seen)
shown: Any = intrinsic(_shown)
called: Any = intrinsic(_called)


@compiled(nogil=True, borrows=True)
def together(team: Team) -> None:
    """Goes on when all threads of the team have come here, and sees what they have written."""
    if team.size == 1:
        return
    own = team.arrived[team.member * LINE] + 1
    shown(team.arrived, team.member * LINE, own)
    for other in range(team.size):
        looks = 0
        while seen(team.arrived, other * LINE) < own:
            looks += 1
            if looks > PATIENCE:
                looks = 0
                called(team.yielding)


NONE, NO_ROOM = np.zeros(TILES * LINE, np.int64), at_a_line(LINE, np.float64)
ALONE = Team(0, 1, NONE, 0, NO_ROOM)  #: one thread that does all


class Crew:
    """The other threads of this process, which sleep between two calls."""

    def __init__(self) -> None:
        self._lock, self._yielding = Lock(), _address()
        self._begin()

    def _begin(self) -> None:
        self._pool, self._room, self._process = ThreadPoolExecutor(TILES - 1, "brash-team"), NO_ROOM, os.getpid()

    def run(self, kernel: Callable[[Team], Any], size: int, room: int) -> Any:
        """What ``kernel`` returns to the first of ``size`` threads that all call it.

        ``room`` is that of `Team.given`, whose content is lost. The kernel must not fail in one of them alone.
        """
        with self._lock:
            if self._process != os.getpid():  # threads do not come along into a process that was forked
                self._begin()
            if len(self._room) < room:
                self._room = at_a_line(room, np.float64)
            arrived = at_a_line(TILES * LINE, np.int64)
            teams = [Team(k, size, arrived, self._yielding, self._room) for k in range(size)]
            others = [self._pool.submit(kernel, team) for team in teams[1:]]
            first = kernel(teams[0])
            for other in others:
                other.result()
            return first


CREW = Crew()
