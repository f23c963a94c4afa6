"""Utilisation of all cells of a sheet under the criteria that were chosen, the same for both engines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.criteria.crack_tips import beside_tips, tensile_limits
from lattice.criteria.table import Criterion, needed
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.strain import CellState
from lattice.varied import Varied

EVERY = slice(None)  #: cells


@dataclass(frozen=True)
class Standing:
    """Which cells are judged, and how."""

    live: BoolArray  #: (cells,) intact cells whose nodes are all in the lattice
    beside: BoolArray  #: (cells,) beside a crack tip
    limit: Array  #: (cells,) of the tensile criteria [Pa]
    lean: Array | None = None  #: (3, cells) as in `CellState`


class Judge:
    """Asks every chosen criterion; the largest utilisation counts."""

    def __init__(self, grid: Grid, ice: Ice, criteria: tuple[Criterion, ...], varied: Varied | None = None):
        """ValueError where a criterion needs a strength that the ice does not have."""
        self.grid, self.ice, self.criteria = grid, ice, criteria
        self.varied = Varied.uniform(grid.cells) if varied is None else varied
        for name in needed(criteria):
            if np.isinf(getattr(ice, name)):
                users = ", ".join(c.name for c in criteria if name in c.needs)
                raise ValueError(
                    f"strength {name} is missing: give it, or leave out the criterion that needs it: {users}"
                )

    def standing(self, live: BoolArray) -> Standing:
        """What holds until the next cell fails: `live` cells, crack tips and limits."""
        beside = beside_tips(self.grid, live)
        return Standing(live, beside, tensile_limits(self.grid, beside, self.ice))

    def utilisation(self, u: Array, q: Array, standing: Standing, cells: IntArray | slice = EVERY) -> Array:
        """Of these cells or all, (cells,); 0 for those that are not live. FloatingPointError if one is not a number."""
        lean, some = standing.lean, None if isinstance(cells, slice) else cells
        lean = None if lean is None else lean[:, cells]
        state = CellState.of(self.grid, u, q, some, standing.limit[cells], lean, self.varied.thickness[cells])
        worst = self._each(state, standing.beside[cells])
        utilisation = worst[0]
        for other in worst[1:]:
            utilisation = np.maximum(utilisation, other)
        utilisation = self.varied.weakness[cells] * utilisation
        if not np.isfinite(utilisation).all():
            raise FloatingPointError("the sheet's motion is not finite: use a shorter window (coupling.window)")
        return np.where(standing.live[cells], utilisation, 0.0)

    def causes(self, u: Array, q: Array, standing: Standing, cells: IntArray) -> list[str]:
        """Name of the criterion with the largest utilisation of each of these cells."""
        if len(self.criteria) == 1:
            return [self.criteria[0].name] * len(cells)
        lean = None if standing.lean is None else standing.lean[:, cells]
        state = CellState.of(self.grid, u, q, cells, standing.limit[cells], lean, self.varied.thickness[cells])
        worst = np.argmax(self._each(state, standing.beside[cells]), axis=0)
        return [self.criteria[k].name for k in worst]

    def tensile_stress(self, u: Array, q: Array) -> Array:
        """What is compared with `Standing.limit`, that of mean ice: 0 without such a criterion, (cells,) [Pa]."""
        stress, one = np.zeros(self.grid.cells), np.ones(self.grid.cells)
        state = CellState.of(self.grid, u, q, limit=one, thick=self.varied.thickness)
        for criterion in self.criteria:
            if criterion.limited:
                stress = np.maximum(stress, criterion.judge(state, self.ice))
        return np.asarray(self.varied.weakness * stress)

    def _each(self, state: CellState, beside: BoolArray) -> list[Array]:
        found = []
        for criterion in self.criteria:
            value = criterion.judge(state, self.ice)
            found.append(np.where(beside, value, 0.0) if criterion.at_tips else value)
        return found
