"""Which body is which: slots by the address of a body, in a hash table that compiled code reads."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import IntArray
from rubble.compiled import compiled

STRUCTURE_SLOT, SHEET_SLOT, UNKNOWN = -1, -2, -3  #: slots of the bodies that are no blocks; blocks count from 0
_SPREAD = 0x1E3779B97F4A7C15  #: addresses at regular distances do not fall together in the hash table


class Slots(NamedTuple):
    """Hash table with open addressing; its length is a power of two."""

    address: IntArray  #: (size,) of a body, 0 marks a free place
    slot: IntArray  #: (size,) number of a block, or one of the slots above


@compiled(nogil=True, inline="always")
def slot_of(body: int, address: IntArray, slot: IntArray) -> int:
    """Slot of the body at an address, in the two arrays of `Slots`."""
    mask = address.shape[0] - 1
    i = ((body * _SPREAD) >> 40) & mask
    while address[i] != body:
        if address[i] == 0:
            return UNKNOWN
        i = (i + 1) & mask
    found: int = slot[i]
    return found


def slot_table(bodies: list[int], slots: list[int]) -> Slots:
    """The table of bodies, given by their addresses."""
    size = 1 << (4 * len(bodies)).bit_length()
    table = Slots(np.zeros(size, np.int64), np.full(size, UNKNOWN, np.int64))
    for body, slot in zip(bodies, slots, strict=True):
        i = ((body * _SPREAD) >> 40) % size
        while table.address[i] != 0:
            i = (i + 1) % size
        table.address[i], table.slot[i] = body, slot
    return table
