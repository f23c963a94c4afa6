"""What the rubble has to say after a window."""

from __future__ import annotations

from collections.abc import Mapping
from math import floor
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rubble import table
from rubble.arrays import Array, IntArray
from rubble.piece import Plate
from rubble.sections import SectionTable
from rubble.store import Store
from rubble.window import Runner


class Readings:
    """Tables, loads and sums of a layer."""

    store: Store
    runner: Runner
    table_of_sections: SectionTable
    pitch: float
    origin: float
    parting: Array

    def key_at(self, y: float) -> int:
        """Number of the section that holds y."""
        return floor((y - self.origin) / self.pitch + 0.5)

    def keys_at(self, y: Array) -> IntArray:
        """The same of several places (n,)."""
        return np.floor((y - self.origin) / self.pitch + 0.5).astype(np.int64)

    @property
    def blocks(self) -> list[Plate]:
        """All plates in the order of their numbers."""
        return self.store.list

    @property
    def corners(self) -> Array:
        """Corners of the prisms of all plates, those of one side and then those of the other (c, 3) [m]."""
        plates, pieces = self.store.plates, self.store.tables.pieces
        piece = np.repeat(np.arange(len(pieces.plate)), np.diff(pieces.offset))
        k, (x, z) = pieces.plate[piece], pieces.corners.T
        own = [np.column_stack((x, pieces.y[piece] + 0.5 * side * pieces.width[piece], z)) for side in (-1.0, 1.0)]
        return np.concatenate([plates.position[k] + np.einsum("nij,nj->ni", plates.rotation[k], b) for b in own])

    @property
    def rear(self) -> float:
        """X of the rearmost corner of all plates; inf if there are none [m]."""
        plates, pieces = self.store.plates, self.store.tables.pieces
        piece = np.repeat(np.arange(len(pieces.plate)), np.diff(pieces.offset))
        k, half = pieces.plate[piece], 0.5 * pieces.width[piece]
        to_x, (x, z) = plates.rotation[k, 0], pieces.corners.T
        back = to_x[:, 0] * x + to_x[:, 1] * pieces.y[piece] + to_x[:, 2] * z - np.abs(to_x[:, 1]) * half
        return float((plates.position[k, 0] + back).min(initial=np.inf))

    def columns(self) -> dict[str, NDArray[Any]]:
        """All plates as arrays by name, in the order of their numbers; see `table.columns`."""
        return table.columns(self.store, self.keys_at, self.runner.window)

    def table(self) -> SimpleNamespace:
        """The same with dots."""
        return SimpleNamespace(**self.columns())

    @property
    def load_on_structure(self) -> Array:
        """Mean force of each plate on the structure over the last window (n, 3), in the order of the table [N]."""
        return table.loads(self.store, self.runner.window)

    def load_of(self, *, sliding: bool) -> Array:
        """Sum of the mean forces of the plates that slide, or of those that rotate (3,) [N].

        Those that have left at the end of the window were there in it.
        """
        phase = table.sliding(self.store) == sliding
        return np.asarray(self.load_on_structure[phase].sum(axis=0) + self.parting[int(sliding)])

    @property
    def wrench_on_structure(self) -> Array:
        """Mean load of all plates over the last window, and its moment about the structure's waterline point (6,)."""
        return self.runner.moving.wrench / max(self.runner.window, 1e-300)

    def contact_centres(self) -> Array:
        """Where each plate presses on the structure: mean x, y and z (n, 3) of its contacts, weighted with impulse.

        Over the last window, in the order of the table; nan without contact [m].
        """
        return table.contact_centres(self.store)

    def sheet_forces(self, section: int) -> Array:
        """Mean force of the rubble on the sheet's nodes in a section over the last window (m, 3) [N]."""
        found = self.table_of_sections.by_key.get(section)
        if found is None or found.sheet is None:
            return np.zeros((0, 3))
        window = self.runner.window
        return found.sheet.impulse / window if window else np.zeros_like(found.sheet.impulse)

    @property
    def power_on_sheet(self) -> float:
        """Mean power of the plates' forces on the moving edges of the sheet over the last window [W]."""
        return self.runner.power_on_sheet

    @property
    def budget(self) -> Mapping[str, Array]:
        """What carries the plates, mean forces (x, z) over the last window [N]; see `window.Runner.budget`."""
        return self.runner.budget

    @property
    def mass(self) -> float:
        """True mass of all plates that are followed [kg]."""
        return float(self.store.tables.mass.sum())

    @property
    def momentum(self) -> Array:
        """True mass times velocity of all plates (3,) [N s]."""
        return sum((p.momentum for p in self.blocks), np.zeros(3))
