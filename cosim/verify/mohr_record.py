"""What the case `mohr-plane` keeps of a run: circles of all cells, and the states in which cells fail."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coupling.interface import NS, Event
from lattice.contact import EdgeContact
from lattice.criteria import judge
from lattice.criteria.laws import shear_fault
from lattice.criteria.mohr import Circle, faces, tensile_utilisation
from lattice.grid import Array, IntArray
from lattice.ice import Ice
from lattice.implicit.step import Step
from lattice.outcome import Outcome
from lattice.sheet import Sheet
from lattice.state import State
from lattice.strain import CellState

EVERY = 10  #: windows between two snapshots for the figure


@dataclass(frozen=True)
class Failure:
    """A cell that fails."""

    circle: Array  #: mean and radius at the top, then at the bottom (4,) [-]
    limit: float  #: its tensile limit then [Pa]
    located: bool  #: the first of its window; the others follow at the same instant


class Witness(Sheet):
    """A sheet that keeps the state in which each cell fails, which is the last one judged before."""

    failures: list[Failure]
    _judged: State
    _located: bool

    @classmethod
    def of(cls, sheet: Sheet) -> Witness:
        """The same sheet, its arrays shared."""
        new = cls.__new__(cls)
        vars(new).update(vars(sheet))
        new.failures, new._judged, new._located = [], sheet.state, False
        return new

    def circles(self, state: State) -> Array:
        """Mean and radius of all cells at the top and at the bottom, (cells, 4) [-]."""
        top, bottom = faces(CellState.of(self.grid, state.u, state.q).strains, self.ice)
        return np.column_stack((*top, *bottom))

    def limits(self) -> Array:
        """Tensile limit of all cells, (cells,) [Pa]."""
        return self.standing.limit

    def _utilisation(self, state: State, cells: IntArray | slice = judge.EVERY) -> Array:
        self._judged = state
        return super()._utilisation(state, cells)

    def _locate(self, t: float, step: Step, contact: EdgeContact) -> tuple[float, Array]:
        found = super()._locate(t, step, contact)
        self._located = True
        return found

    def fail(self, cells: Sequence[int], causes: Sequence[str], state: State, out: Outcome) -> None:
        """Keep the states of these cells, then let them go."""
        for cell in cells:
            failure = Failure(self.circles(self._judged)[cell], float(self.limits()[cell]), self._located)
            self.failures.append(failure)
            self._located = False
        super().fail(cells, causes, state, out)


class Record:
    """Running extremes and shares over all windows, and snapshots for the figure."""

    def __init__(self, ice: Ice):
        self.ice = ice
        self.inside = self.inside_tip = self.compression = 0.0  #: largest utilisation of live cells [-]
        self.snapshots: list[Array] = []  #: circles of live cells, (live, 4) [-]
        self.failures: list[Failure] = []
        self.force, self.time = np.zeros(3), 0.0  #: at the failure that ends the record [N], [s]
        self._count, self._windows = np.zeros(3), 0

    def see(self, sheet: Witness) -> None:
        """Takes in the end of a window."""
        live = sheet.live_cells
        circle, limit = sheet.circles(sheet.state)[live], sheet.limits()[live]
        use, tip = self.utilisation(circle, limit), limit != self.ice.sigma_t
        self.inside = max(self.inside, float(use[~tip].max(initial=0.0)))
        self.inside_tip = max(self.inside_tip, float(use[tip].max(initial=0.0)))
        self.compression = max(self.compression, float(self._shear(circle).max()))
        self._count += self.quadrants(circle)
        self._windows += 1
        if self._windows % EVERY == 0:
            self.snapshots.append(circle)
        self.failures = sheet.failures

    def close(self, event: Event) -> None:
        """The failure at which the record ends."""
        self.force, self.time = np.array(event.force), event.t_ns / NS

    def utilisation(self, circle: Array, limit: Array | float) -> Array:
        """(4.6) at the worse face."""
        top, bottom = (tensile_utilisation(Circle(*circle[:, k : k + 2].T), limit, self.ice) for k in (0, 2))
        return np.maximum(top, bottom)

    def _shear(self, circle: Array) -> Array:
        """(4.5) at the worse face."""
        return np.maximum(*(shear_fault(Circle(*circle[:, k : k + 2].T), self.ice) for k in (0, 2)))

    def quadrants(self, circle: Array) -> Array:
        """States in T-T, T-C and C-C, both faces counted, (3,)."""
        mean, radius = np.concatenate((circle[:, :2], circle[:, 2:])).T
        axis = mean * (1.0 + self.ice.nu) / (1.0 - self.ice.nu)  # R at which one principal stress is zero
        return np.array([(axis >= radius).sum(), (np.abs(axis) < radius).sum(), (-axis >= radius).sum()], float)

    @property
    def share(self) -> Array:
        """Share of all states, cells and windows, in T-T, T-C and C-C, (3,)."""
        return np.asarray(self._count / self._count.sum())

    def failing(self, located: bool) -> Array:
        """Utilisation of the failing cells against their own limits."""
        chosen = [f for f in self.failures if f.located == located]
        return np.array([float(self.utilisation(f.circle[None], f.limit)[0]) for f in chosen])

    def failing_circles(self, located: bool) -> Array:
        """Mean and radius times E of failing cells at their worse face, (k, 2) [Pa]."""
        circles = [f.circle.reshape(2, 2) for f in self.failures if f.located == located]
        use = [tensile_utilisation(Circle(*c.T), self.ice.sigma_t, self.ice) for c in circles]
        return np.array([c[np.argmax(u)] for c, u in zip(circles, use, strict=True)]).reshape(-1, 2) * self.ice.E
