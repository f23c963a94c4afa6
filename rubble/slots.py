"""Which body is which: numbers by the address of a body, in a hash table that compiled code reads."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import IntArray
from rubble.compiled import compiled

STRUCTURE_SLOT, SHEET_SLOT, UNKNOWN = -1, -2, -3  #: of the bodies that are no slices; slices count from 0
#: of the sea bed, and of a body of revolution, which are no bodies of pymunk; joints have -4, slices that are gone -5
BED_SLOT, ROUND_SLOT = -6, -7
_SPREAD = 0x1E3779B97F4A7C15  #: addresses at regular distances do not fall together in the hash table


class Slots(NamedTuple):
    """Hash table with open addressing; its length is a power of two."""

    address: IntArray  #: (size,) of a body, 0 marks a free place
    slot: IntArray  #: (size,) number of a slice, or one of the slots above


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


@compiled(nogil=True)
def _enter(address: IntArray, slot: IntArray, bodies: IntArray, numbers: IntArray) -> None:
    mask = address.shape[0] - 1
    for k in range(bodies.shape[0]):
        i = ((bodies[k] * _SPREAD) >> 40) & mask
        while address[i] != 0:
            i = (i + 1) & mask
        address[i], slot[i] = bodies[k], numbers[k]


def slot_table(bodies: IntArray, slots: IntArray) -> Slots:
    """The table of bodies, given by their addresses."""
    size = 1 << (4 * max(len(bodies), 1)).bit_length()
    table = Slots(np.zeros(size, np.int64), np.full(size, UNKNOWN, np.int64))
    _enter(table.address, table.slot, bodies, slots)
    return table
