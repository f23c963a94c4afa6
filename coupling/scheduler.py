"""The macro step: who moves when, and what is exchanged."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy

import numpy as np

from coupling.budget import force_budget
from coupling.interface import (
    NS,
    Array,
    Fragment,
    Frame,
    Phase,
    Restore,
    RubbleParticipant,
    SheetEdge,
    SheetForces,
    SheetParticipant,
    SheetReport,
)
from coupling.ledger import Ledger
from coupling.power import PowerBooks
from coupling.steering import Steering, fixed

CLOCK = ("t_ns", "window_ns", "_next", "power", "jump", "notes", "motion")  #: what changes from window to window


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
        self.motion: Array | None = None  #: (2, 6) of a structure that moves, see `Frame.motion`
        ledger.energy.open(sheet.energy, rubble.energy)

    def macro_step(self) -> Frame:
        """One window: exchange, balances, and the frame for observers."""
        self.window_ns = self._window()
        report = self._scheme(self)
        self.t_ns += self.window_ns
        load = self.rubble.load()
        load[Phase.BREAKING] += report.load
        if report.hinged is not None:
            load[Phase.BREAKING] -= report.hinged
            load[Phase.ROTATING] += report.hinged
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
        budget = force_budget(load.sum(axis=0), report.budget, self.rubble.budget, loads=report.loads)
        return Frame(
            self.t_ns,
            self.sheet.view(),
            self.rubble.blocks(),
            load,
            events=(*report.events, *self.rubble.events(self.t_ns, load.sum(axis=0))),
            ledger=books,
            budget=budget,
            contact=report.contact,
            motion=self.motion,
        )

    def _window(self) -> int:
        """The coming window, no longer than what is left of the run."""
        left = self._next if self._end is None else self._end - self.t_ns
        return left if 0 < left < self._next else self._next

    def move_sheet(self, force: SheetForces) -> SheetReport:
        """The sheet's window under forces of the rubble; what comes loose becomes rubble."""
        report = self.sheet.advance(self.t_ns, self.window_ns, force, self.rubble_load())
        for fragment in report.fragments:
            self.hand_over(fragment)
        return report

    def move_rubble(self, edges: dict[int, SheetEdge], carried: SheetForces) -> None:
        """The rubble's window against edges of the sheet that already answer to the forces ``carried``."""
        self.rubble.set_sheet(edges, carried, self.sheet.compliance(list(edges)))
        self.rubble.advance(self.window_ns)

    def save(self) -> Restore:
        """Participants and balances at the start of a window."""
        sheet, rubble, balances, fragments = (
            self.sheet.save(),
            self.rubble.save(),
            deepcopy(vars(self.ledger)),
            self.fragments,
        )

        def restore() -> None:
            self.fragments = fragments
            sheet()
            rubble()
            vars(self.ledger).update(deepcopy(balances))

        return restore

    def checkpoint(self) -> Restore:
        """The whole run between two windows, with its clock; for a scheme that has ``save``."""
        back, clock = self.save(), {name: deepcopy(getattr(self, name)) for name in CLOCK}
        scheme: Restore = self._scheme.save()  # type: ignore[attr-defined]

        def restore() -> None:
            back()
            scheme()
            vars(self).update(deepcopy(clock))

        return restore

    def hand_over(self, fragment: Fragment) -> None:
        """A fragment leaves the sheet's books and becomes rubble."""
        moved = self.rubble.add(fragment)
        self.fragments += 1
        self.ledger.hand_over(self.t_ns, moved)

    def rubble_load(self) -> Array:
        """Total of the blocks' load on the structure in the last window, (3,) [N]."""
        return np.asarray(self.rubble.load().sum(axis=0))


Scheme = Callable[[Scheduler], SheetReport]  #: one window; see `coupling.schemes`
