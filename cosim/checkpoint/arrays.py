"""Arrays of a checkpoint: pieces of memory, and how each array looks at one.

Two arrays that share memory still do when they are read back, and each lies in memory as it did: order of its axes,
gaps and place in a cache line. Sums go through memory in its order, so that their bits may depend on all of these.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.lib.array_utils import byte_bounds
from numpy.typing import NDArray

LINE = 64  #: bytes of a cache line
KINDS = "biuf"  #: of plain numbers, as numpy names them: no objects


class Memory:
    """Pieces of memory by the array that owns them, each kept once."""

    def __init__(self) -> None:
        self.pieces: list[tuple[int, bytes]] = []  #: place in a cache line, content
        self._number: dict[int, int] = {}
        self._owners: list[Any] = []  # kept, so that no other object takes over their identity

    def look(self, array: NDArray[Any]) -> list[Any]:
        """How an array looks at its memory: piece, offset, shape, strides, dtype, whether it may be written to."""
        shape, kind = list(array.shape), written(array.dtype)
        if array.size == 0:
            return [-1, 0, shape, [], kind, bool(array.flags.writeable)]
        owner = array
        while isinstance(owner.base, np.ndarray):
            owner = owner.base
        low, high = byte_bounds(owner)
        if id(owner) not in self._number:
            self._number[id(owner)] = len(self.pieces)
            self._owners.append(owner)
            self.pieces.append((low % LINE, ctypes.string_at(low, high - low)))
        at = array.__array_interface__["data"][0] - low
        return [self._number[id(owner)], at, shape, list(array.strides), kind, bool(array.flags.writeable)]


def placed(place: int, content: bytes | memoryview) -> NDArray[np.uint8]:
    """A piece of memory that begins at this place of a cache line."""
    raw = np.empty(len(content) + LINE, np.uint8)
    start = (place - raw.ctypes.data) % LINE
    piece = np.frombuffer(raw.data[start : start + len(content)], np.uint8)  # owner of all that looks at it
    piece[:] = np.frombuffer(content, np.uint8)
    return piece


def seen(pieces: Sequence[NDArray[np.uint8]], look: Sequence[Any]) -> NDArray[Any]:
    """The array of a `Memory.look`; ValueError where it would look beside its memory."""
    number, at, shape, strides, kind, writeable = look
    dtype = read(kind)
    if number < 0:
        return np.ndarray(tuple(shape), dtype)
    array: NDArray[Any] = np.ndarray(tuple(shape), dtype, pieces[number], at, tuple(strides))
    array.flags.writeable = bool(writeable)
    return array


def written(dtype: np.dtype[Any]) -> Any:
    """A dtype as text, or the places of its fields. ValueError for one that holds more than numbers."""
    if dtype.names is not None and dtype.fields is not None:
        fields = [[name, written(dtype.fields[name][0]), dtype.fields[name][1]] for name in dtype.names]
        return {"fields": fields, "size": dtype.itemsize, "aligned": dtype.isalignedstruct}
    if dtype.kind not in KINDS:
        raise ValueError(f"an array of {dtype}")
    return dtype.str


def read(kind: Any) -> np.dtype[Any]:
    """The dtype that was `written`."""
    if isinstance(kind, Mapping):
        names, formats, offsets = zip(*kind["fields"], strict=True)
        table: Any = {
            "names": list(names),
            "formats": [read(f) for f in formats],
            "offsets": list(offsets),
            "itemsize": kind["size"],
        }
        record: np.dtype[Any] = np.dtype(table, align=bool(kind["aligned"]))
        return record
    dtype = np.dtype(str(kind))
    if dtype.kind not in KINDS:
        raise ValueError(f"an array of {dtype}")
    return dtype
