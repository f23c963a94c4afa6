"""The macro step: who moves when, and what is exchanged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from coupling.interface import Array, BlockTable, Event, Fragment, Frame, Phase, SheetEdge, SheetForces, SheetView
from coupling.ledger import Ledger


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


class Report(Protocol):
    """What the sheet did in a window."""

    load: Array
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
    def advance(self, t_ns: int, window_ns: int, rubble: SheetForces, rubble_load: Array) -> Report: ...
    def edges(self, sections: Sequence[int]) -> dict[int, SheetEdge]: ...
    def view(self) -> SheetView: ...


class RubbleParticipant(Protocol):
    """The rubble, as `coupling.rubble_port.RubblePort`."""

    @property
    def mass(self) -> float: ...
    @property
    def cleared_mass(self) -> float: ...
    def add(self, fragment: Fragment) -> Balance: ...
    def sections_in_use(self) -> list[int]: ...
    def set_sheet(self, edges: dict[int, SheetEdge]) -> None: ...
    def advance(self, window_ns: int) -> None: ...
    def forces_on_sheet(self) -> SheetForces: ...
    def load(self) -> Array: ...
    def blocks(self) -> BlockTable: ...


class Scheduler:
    """Runs the participants window by window; time is an integer number of nanoseconds."""

    def __init__(self, sheet: SheetParticipant, rubble: RubbleParticipant, ledger: Ledger, window_ns: int,
                 scheme: Callable[[Scheduler], Report]):
        self.sheet, self.rubble, self.ledger, self.window_ns, self._scheme = sheet, rubble, ledger, window_ns, scheme
        self.t_ns, self.fragments = 0, 0

    def macro_step(self) -> Frame:
        """One window: exchange, balances, and the frame for observers."""
        report = self._scheme(self)
        self.t_ns += self.window_ns
        load = self.rubble.load()
        load[Phase.BREAKING] += report.load
        books = self.ledger.close_window(self.t_ns, self.sheet.mass, self.sheet.crushed, self.rubble.mass,
                                         self.rubble.cleared_mass, self.sheet.energy)
        return Frame(self.t_ns, self.sheet.view(), self.rubble.blocks(), load, tuple(report.events), books)

    def hand_over(self, fragment: Fragment) -> None:
        """A fragment leaves the sheet's books and becomes rubble."""
        moved = self.rubble.add(fragment)
        self.fragments += 1
        self.ledger.hand_over(self.t_ns, moved.mass, moved.trimmed, moved.momentum_error)

    def rubble_load(self) -> Array:
        """Total of the blocks' load on the structure in the last window, (3,) [N]."""
        return np.asarray(self.rubble.load().sum(axis=0))
