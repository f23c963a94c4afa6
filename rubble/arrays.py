"""Arrays of this package: their types, and tables of records with named fields.

A table that kernels share is an array of records: one row per body, edge or contact, every number under its name. All
numbers of a row stand side by side in memory, as pymunk's callbacks need it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from rubble.team import LINE, at_a_line

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Records = NDArray[np.void]  #: (n,) rows with named fields; the name of the dtype says which
Table = TypeVar("Table", bound=tuple[Any, ...])  #: columns of one length, by name
Record = Any  #: one row: `numpy.void` in Python, a pointer to the row in a kernel


def record(*names: str, integers: tuple[str, ...] = ()) -> np.dtype[np.void]:
    """A row of float64 fields, followed by int64 fields; numba reads it without padding."""
    return np.dtype([*((n, np.float64) for n in names), *((n, np.int64) for n in integers)], align=True)


def whole_lines(*names: str) -> np.dtype[np.void]:
    """A row of float64 fields that fills cache lines: what follows the named ones is not used.

    For rows that are written over and over, in no order: none lies in two lines, and no two threads write to one.
    """
    return record(*names, *(f"unused_{k}" for k in range(-len(names) % LINE)))


def zeros_at_a_line(count: int, dtype: np.dtype[np.void]) -> Records:
    """Rows (count,) of zeros, of which the first begins a cache line."""
    return at_a_line(count * dtype.itemsize // 8, np.float64).view(dtype)


def rows(records: Records, first: str | None = None, count: int | None = None) -> Array:
    """``count`` float64 fields side by side from ``first`` on, as a view (n, count); without them all fields."""
    dtype = records.dtype
    if first is None and dtype.itemsize == records.strides[0] and len(records):
        return records.view(np.float64).reshape(len(records), -1)
    names = dtype.names or ()
    start = 0 if first is None else names.index(first)
    width = len(names) if count is None else count
    offset = int(dtype.fields[names[start]][1]) if dtype.fields else 0
    shape, strides = (len(records), width), (records.strides[0], 8)
    return np.ndarray(shape, np.float64, records, offset, strides) if len(records) else np.zeros(shape)


def gathered(tables: Iterable[Records], dtype: np.dtype[np.void]) -> Array:
    """The numbers (n, fields) of tables of float64 fields, one below the other."""
    return np.concatenate([np.zeros((0, len(dtype.names or ()))), *(rows(t) for t in tables)])


def filled(dtype: np.dtype[np.void], data: object) -> Records:
    """Records (n,) from their numbers (n, fields)."""
    plain = np.array(data, dtype=np.float64).reshape(-1, len(dtype.names or ()))
    out = np.zeros(len(plain), dtype)
    rows(out)[:] = plain
    return out


def filled_room(room: Callable[[int], Table], count: int, fill: Callable[[Table], int]) -> Table:
    """A table of columns that ``fill`` fills, as long as what it finds.

    ``fill`` returns how many rows it found, more than there is room for if so; it is then asked again with room for
    twice as many. ``count`` rows to begin with.
    """
    while True:
        table = room(count)
        found = fill(table)
        if found <= count:
            return type(table)(*(column[:found] for column in table))
        count = 2 * found


class Known(NamedTuple):
    """Rows that are remembered by number."""

    ids: IntArray  #: (n,) ascending
    values: Array  #: (n, ...)

    def of(self, ids: IntArray, missing: float) -> Array:
        """The rows of some numbers (m, ...), filled with ``missing`` where one is not known."""
        out = np.full((len(ids), *self.values.shape[1:]), missing)
        if len(self.ids):
            at = np.minimum(np.searchsorted(self.ids, ids), len(self.ids) - 1)
            hit = self.ids[at] == ids
            out[hit] = self.values[at[hit]]
        return out
