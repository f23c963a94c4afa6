"""The macro step: who moves when, and what is exchanged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import deepcopy
from typing import Any, Protocol

import numpy as np

from coupling.budget import Pairs, force_budget
from coupling.interface import NS, Array, BlockTable, Event, Fragment, Frame, Phase, SheetEdge, SheetForces, SheetView
from coupling.ledger import Ledger
from coupling.power import PowerBooks
from coupling.steering import Steering, fixed


class Balance(Protocol):
    """What a hand-over moved."""

    @property
    def blocks(self) -> int: ...
    @property
    def mass(self) -> float: ...
    @property
    def trimmed(self) -> float: ...
    @property
    def momentum_error(self) -> float: ...
    @property
    def angular_momentum_error(self) -> float: ...
    @property
    def angular_momentum_change(self) -> float: ...


class Report(Protocol):
    """What the sheet did in a window."""

    load: Array
    budget: Pairs
    fragments: list[Fragment]
    events: list[Event]


class SheetParticipant(Protocol):
    """The sheet, as `coupling.sheet_port.SheetPort`."""

    @property
    def mass(self) -> float: ...
    @property
    def crushed(self) -> float: ...
    @property
    def energy(self) -> dict[str, float]: ...
    @property
    def power(self) -> float: ...
    def save(self) -> Any: ...
    def restore(self, saved: Any) -> None: ...
    def advance(self, t_ns: int, window_ns: int, rubble: SheetForces, rubble_load: Array) -> Report: ...
    def edges(self, sections: Sequence[int]) -> dict[int, SheetEdge]: ...
    def path(self, sections: Sequence[int]) -> dict[int, SheetEdge]: ...
    def view(self) -> SheetView: ...


class RubbleParticipant(Protocol):
    """The rubble, as `coupling.rubble_port.RubblePort`."""

    @property
    def mass(self) -> float: ...
    @property
    def cleared_mass(self) -> float: ...
    @property
    def budget(self) -> Pairs: ...
    @property
    def power(self) -> float: ...
    def save(self) -> Any: ...
    def restore(self, saved: Any) -> None: ...
    @property
    def energy(self) -> dict[str, float]: ...
    @property
    def momenta(self) -> dict[str, float]: ...
    def add(self, fragment: Fragment) -> Balance: ...
    def sections_in_use(self) -> list[int]: ...
    def set_sheet(self, edges: dict[int, SheetEdge], carried: SheetForces) -> None: ...
    def advance(self, window_ns: int) -> None: ...
    def forces_on_sheet(self) -> SheetForces: ...
    def load(self) -> Array: ...
    def blocks(self) -> BlockTable: ...


class Scheduler:
    """Runs the participants window by window; time is an integer number of nanoseconds."""

    def __init__(
        self,
        sheet: SheetParticipant,
        rubble: RubbleParticipant,
        ledger: Ledger,
        window_ns: int,
        scheme: Scheme,
        steering: Steering = fixed,
        end_ns: int | None = None,
    ):
        """``window_ns`` is the first window; ``end_ns`` the end of the run, at which the last one is cut off."""
        self.sheet, self.rubble, self.ledger, self.window_ns, self._scheme = sheet, rubble, ledger, window_ns, scheme
        self._steering, self._next, self._end = steering, window_ns, end_ns
        self.t_ns, self.fragments, self.power = 0, 0, PowerBooks()
        self.jump = True  #: no window has gone before, or blocks were born in it: nothing to predict from
        self.notes: dict[str, float] = {}  #: what a scheme has to say about the window
        ledger.energy.open(sheet.energy, rubble.energy)

    def macro_step(self) -> Frame:
        """One window: exchange, balances, and the frame for observers."""
        self.window_ns = self._window()
        report = self._scheme(self)
        self.t_ns += self.window_ns
        load = self.rubble.load()
        load[Phase.BREAKING] += report.load
        books = self.ledger.close_window(
            self.t_ns,
            self.sheet.mass,
            self.sheet.crushed,
            self.rubble.mass,
            self.rubble.cleared_mass,
            self.sheet.energy,
            self.rubble.energy,
        )
        books |= self.power.close_window(self.rubble.power, self.sheet.power, self.window_ns / NS) | self.notes
        books |= self.rubble.momenta
        self.jump = bool(report.fragments)
        self._next = self._steering(self._next, self.power, self.jump)
        budget = force_budget(load.sum(axis=0), report.budget, self.rubble.budget)
        return Frame(self.t_ns, self.sheet.view(), self.rubble.blocks(), load, tuple(report.events), books, budget)

    def _window(self) -> int:
        """The coming window, no longer than what is left of the run."""
        left = self._next if self._end is None else self._end - self.t_ns
        return left if 0 < left < self._next else self._next

    def move_sheet(self, force: SheetForces) -> Report:
        """The sheet's window under forces of the rubble; what comes loose becomes rubble."""
        report = self.sheet.advance(self.t_ns, self.window_ns, force, self.rubble_load())
        for fragment in report.fragments:
            self.hand_over(fragment)
        return report

    def move_rubble(self, edges: dict[int, SheetEdge], carried: SheetForces) -> None:
        """The rubble's window against edges of the sheet that already answer to the forces ``carried``."""
        self.rubble.set_sheet(edges, carried)
        self.rubble.advance(self.window_ns)

    def save(self) -> Any:
        """Participants and balances at the start of a window, for `restore`."""
        return self.sheet.save(), self.rubble.save(), deepcopy(vars(self.ledger)), self.fragments

    def restore(self, saved: Any) -> None:
        """Sets all back to the start of the window, as often as one likes."""
        sheet, rubble, books, self.fragments = saved
        self.sheet.restore(sheet)
        self.rubble.restore(rubble)
        vars(self.ledger).update(deepcopy(books))

    def hand_over(self, fragment: Fragment) -> None:
        """A fragment leaves the sheet's books and becomes rubble."""
        moved = self.rubble.add(fragment)
        self.fragments += 1
        self.ledger.hand_over(
            self.t_ns,
            moved.mass,
            moved.trimmed,
            moved.momentum_error,
            moved.angular_momentum_error,
            moved.angular_momentum_change,
        )

    def rubble_load(self) -> Array:
        """Total of the blocks' load on the structure in the last window, (3,) [N]."""
        return np.asarray(self.rubble.load().sum(axis=0))


Scheme = Callable[[Scheduler], Report]  #: one window; see `coupling.schemes`
