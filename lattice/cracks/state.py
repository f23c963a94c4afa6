"""The layered cells of a sheet as one object that grows, shrinks and is copied."""

from __future__ import annotations

import numpy as np

from lattice.cracks.cells import LOSSES, WEIGHTS, Cracks, Plate, room_for
from lattice.cracks.law import CrackLaw
from lattice.cracks.motion import Layered
from lattice.grid import Array, BoolArray, IntArray


class LayeredCells:
    """Layered cells in the order in which they began."""

    def __init__(self, law: CrackLaw, plate: Plate, room: int = 64):
        self.law, self.plate, self.count, self._cracks = law, plate, 0, room_for(room)

    def __copy__(self) -> LayeredCells:
        """A copy with arrays of its own, see `memory.remember`."""
        new = object.__new__(LayeredCells)
        new.__dict__.update(vars(self))
        new._cracks = Cracks._make(a.copy() for a in self._cracks)
        return new

    def view(self) -> Layered:
        """What the compiled loops take; changes of the arrays are seen here."""
        return Layered(self.count, self._cracks, self.plate, self.law)

    def add(self, cell: int, corner: int, angle: float) -> int:
        """A cell begins to crack across the direction ``angle`` [rad]; returns its place. ``corner`` as in `Cracks`."""
        if self.count == len(self._cracks.cell):
            self._grow()
        k, c = self.count, self._cracks
        for array in c[:-1]:  # all but the losses
            array[(k,) if array.shape[0] == len(c.cell) else (slice(None), k)] = 0
        c.cell[k], c.corner[k], c.axis[:, k] = cell, corner, (np.cos(angle), np.sin(angle))
        self.count += 1
        return k

    def _grow(self) -> None:
        old, new = self._cracks, room_for(2 * len(self._cracks.cell))
        for a, b in zip(old, new, strict=True):
            b[tuple(slice(0, n) for n in a.shape)] = a
        self._cracks = new

    def drop(self, gone: BoolArray) -> None:
        """Forgets the cells marked in ``gone`` (count,); the others keep their order."""
        stay, m = np.flatnonzero(~gone), len(self._cracks.cell)
        for a in self._cracks[:-1]:
            if a.shape[0] == m:
                a[: len(stay)] = a[stay]
            else:
                a[:, : len(stay)] = a[:, stay]
        self.count = len(stay)

    # ---- what the cells are like ------------------------------------------------------------------------------

    @property
    def cell(self) -> IntArray:
        """Their numbers, (count,)."""
        return self._cracks.cell[: self.count]

    @property
    def damage(self) -> Array:
        """Larger damage of the two directions in each layer, (count, LAYERS)."""
        largest: Array = self._cracks.damage[: self.count].max(axis=2)
        return largest

    @property
    def depth(self) -> Array:
        """Share of the thickness that is cracked through, across n, (count,)."""
        return np.asarray((self._cracks.damage[: self.count, :, 0] >= 1.0) @ np.array(WEIGHTS))

    @property
    def thrust(self) -> Array:
        """Compression across n and t, (count, 2) [N/m]."""
        return self._cracks.thrust[: self.count]

    @property
    def angle(self) -> Array:
        """Direction n from the x axis, (count,) [rad]."""
        c, s = self._cracks.axis[:, : self.count]
        return np.asarray(np.arctan2(s, c))

    def parting(self, d: float) -> tuple[BoolArray, Array, Array]:
        """Across n and t, (count, 2) each: cracked through; opening of the middle and slip [m] of cells of size d."""
        c, n = self._cracks, self.count
        through = np.asarray((c.damage[:n] >= 1.0).all(axis=1))
        cos, sin = c.axis[:, :n]
        e11, e22, g12 = c.seen[:3, :n]
        opening = np.stack(
            (cos**2 * e11 + sin**2 * e22 + cos * sin * g12, sin**2 * e11 + cos**2 * e22 - cos * sin * g12), axis=1
        )
        slip = np.maximum(d * np.abs(c.slip[:n]).max(axis=1), np.abs(c.shear_slip[:n]).max(axis=1))
        return through, d * opening, np.stack((slip, slip), axis=1)

    @property
    def losses(self) -> dict[str, float]:
        """What cracking, crushing, rubbing and the switching of tangents have taken [J]."""
        return dict(zip(LOSSES, self._cracks.losses.tolist(), strict=True))
