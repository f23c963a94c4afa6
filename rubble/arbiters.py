"""Pairs in contact of a pymunk space, noted by a compiled callback while the space is stepped.

pymunk finds contacts and solves none: its bodies stand where the plates put them, at rest, and its slop is larger than
any overlap, so that its own impulses are zero. The post-solve callback comes in the order in which pymunk goes through
the pairs, the same for every run, and keeps the address of the pair's arbiter, whose contacts stay as they are until
the next step. An arbiter lives as long as its pair touches; it keeps for us which rows its contacts had.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import carray  # type: ignore[attr-defined]  # numba exports it without saying so

from rubble.arrays import record
from rubble.compiled import callback
from rubble.pointers import number, pointer, set_integer

#: pairs counted in a sub-step, pairs that fit into the list, address of the list
LIST = record(integers=("count", "room", "address"))
COUNT, ROOM, ADDRESS = (8 * (LIST.names or ()).index(name) for name in ("count", "room", "address"))  #: bytes to them


@callback("void(voidptr, voidptr, voidptr)")
def note_pair(arbiter: Any, _space: Any, data: Any) -> None:
    """Post-solve callback: append the address of an arbiter to the `LIST` at ``data``."""
    found = carray(pointer(number(data)), 1, LIST)[0]
    count = found.count
    found.count = count + 1  # counted in any case, so that a loss is noticed
    if count < found.room:
        set_integer(found.address + 8 * count, number(arbiter))


class PairList:
    """List of the pairs in contact that the callback fills during a step."""

    def __init__(self, capacity: int = 256) -> None:
        self.list = np.zeros(1, LIST)
        self.reserve(capacity)

    @property
    def count(self) -> int:
        """Pairs in contact in the last sub-step."""
        return int(self.list["count"][0])

    @property
    def capacity(self) -> int:
        """Pairs that fit."""
        return len(self._arbiter)

    def reserve(self, capacity: int) -> None:
        """Make room for so many pairs."""
        self._arbiter = np.zeros(capacity, np.int64)
        self.list["room"], self.list["address"] = capacity, self._arbiter.ctypes.data
