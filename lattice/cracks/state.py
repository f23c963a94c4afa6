"""The layered cells of a sheet as one object that grows, shrinks and is copied."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lattice.cracks.cells import BLOCK, LOSSES, Cracks, Plate, room_for
from lattice.cracks.law import CrackLaw, Local, N
from lattice.cracks.layers import WEIGHTS
from lattice.cracks.motion import Layered
from lattice.cracks.parting import parted
from lattice.cracks.slopes import Lean, level, on_nodes
from lattice.explicit.layout import LANES, copied
from lattice.grid import Array, BoolArray, IntArray


class LayeredCells:
    """Layered cells in the order in which they began."""

    def __init__(self, law: CrackLaw, plate: Plate, local: Local, room: int = 64):
        """``local`` has a place for each of a padded row-by-row array of all nodes."""
        self.law, self.plate, self.local, self.count, self._cracks = law, plate, local, 0, room_for(room)
        self.lean, self.leans, self.nodes = level(local.E.size), True, on_nodes(local.E.size)

    def __copy__(self) -> LayeredCells:
        """A copy with arrays of its own, see `memory.remember`."""
        new = object.__new__(LayeredCells)
        new.__dict__.update(vars(self))
        new._cracks = Cracks._make(map(copied, self._cracks))
        new.lean = Lean._make(map(copied, self.lean))
        return new

    def view(self) -> Layered:
        """What the compiled loops take; changes of the arrays are seen here."""
        c = self._cracks
        return Layered(self.count, c, self.plate, self.law, self.lean, self.leans, self.local, nodes=self.nodes)

    def add(self, cell: int, corner: int, angle: float) -> int:
        """A cell begins to crack across the direction ``angle`` [rad]; returns its place. ``corner`` as in `Cracks`."""
        if self.count == len(self._cracks.cell):
            self._grow()
        k, c = self.count, self._cracks
        for array in self._by_cell():
            array[k] = 0
        self._lines()[k // LANES, :, k % LANES] = 0.0
        c.cell[k], c.corner[k], c.axis[:, k] = cell, corner, (np.cos(angle), np.sin(angle))
        self.count += 1
        return k

    def _grow(self) -> None:
        old, new = self._cracks, room_for(2 * len(self._cracks.cell))
        for a, b in zip(old, new, strict=True):
            b[tuple(slice(0, n) for n in a.shape)] = a
        self._cracks = new

    def _by_cell(self) -> Iterator[NDArray[Any]]:
        """All arrays of the cells but ``linear``, with the cell as first index."""
        c = self._cracks
        yield from (c.cell, c.corner, c.axis.T, c.history, c.shear_slip, c.thrust, c.constant)

    def _lines(self) -> Array:
        """The lines of ``linear``, (blocks, lines, LANES)."""
        return self._cracks.linear.reshape(-1, BLOCK // LANES, LANES)

    def drop(self, gone: BoolArray) -> None:
        """Forgets the cells marked in ``gone`` (count,); the others keep their order."""
        stay = np.flatnonzero(~gone)
        for array in self._by_cell():
            array[: len(stay)] = array[stay]
        lines, to = self._lines(), np.arange(len(stay))
        lines[to // LANES, :, to % LANES] = lines[stay // LANES, :, stay % LANES]
        self.count = len(stay)

    # ---- what the cells are like ------------------------------------------------------------------------------

    @property
    def cell(self) -> IntArray:
        """Their numbers, (count,)."""
        return self._cracks.cell[: self.count]

    @property
    def corner(self) -> IntArray:
        """Places of their nodes 0, (count,)."""
        return self._cracks.corner[: self.count]

    @property
    def damage(self) -> Array:
        """Larger damage of the two directions in each layer, (count, LAYERS)."""
        largest: Array = self._cracks.damage[: self.count].max(axis=2)
        return largest

    @property
    def depth(self) -> Array:
        """Share of the thickness that is cracked through, across n, (count,)."""
        return np.asarray((self._cracks.damage[: self.count, :, N] >= 1.0) @ np.array(WEIGHTS))

    @property
    def angle(self) -> Array:
        """Of the direction n of each from the x axis, (count,) [rad]."""
        cos, sin = self._cracks.axis[:, : self.count]
        return np.asarray(np.arctan2(sin, cos))

    def crack_through(self, k: int) -> None:
        """Cell k has lost all its tensile strength across n."""
        self._cracks.damage[k, :, N] = 1.0

    @property
    def thrust(self) -> Array:
        """Compression across n and t, (count, 2) [N/m]."""
        thrust: Array = self._cracks.thrust[: self.count]
        return thrust

    def parted(self, d: float, thickness: Array) -> BoolArray:
        """Which have come apart, (count,): see `parting.parted`."""
        found: BoolArray = parted(self.count, d, thickness, self._cracks)
        return found

    @property
    def losses(self) -> dict[str, float]:
        """What cracking, crushing, rubbing and the switching of tangents have taken [J]."""
        return dict(zip(LOSSES, self._cracks.losses.sum(axis=0).tolist(), strict=False))
