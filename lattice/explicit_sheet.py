"""The sheet on the explicit engine: dynamic crack propagation.

A cell fails in the sub-step in which its utilisation reaches 1, the time of which is interpolated. Nothing is solved
again: what the cell carried goes out as waves, and the next cell fails when they have loaded it. Loose pieces leave
in the same sub-step.

A tensile criterion (`screen.SCREENED`, of several the first) is looked at in every sub-step, inside the compiled loop.
Other criteria are judged at the end of each block of sub-steps between two evaluations of the contact
(`ExplicitSheet.block`, at most `CONTACT_TIME`): a cell then fails up to that much late.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from lattice.contact import EdgeContact, edge_displacement, lever_of
from lattice.criteria.judge import EVERY, Standing
from lattice.criteria.table import THESIS, Criterion
from lattice.explicit.booking import BookedFloe
from lattice.explicit.easing import Easing
from lattice.explicit.engine import ExplicitEngine, Marched
from lattice.explicit.forces import touch_at
from lattice.explicit.screen import SCREENED
from lattice.explicit.window import Window
from lattice.floe import LOOSE, Floe, Release
from lattice.grid import Array, IntArray
from lattice.loads import Loads, Partner, keep
from lattice.outcome import Outcome
from lattice.reaction import Mean, between
from lattice.state import State

#: longest time between two evaluations of the contact law, linear in between, in units of (h / g)^(1/2): 2 ms for ice
#: of 3 m, where a test finds 1e-4 of the displacements against one evaluation in every sub-step [-]
CONTACT_TIME = 3.617e-3
LIVELY = 2e-7  #: change of the loss of a block, as share of the stored energy, from which each sub-step is booked


class ExplicitSheet(BookedFloe):
    """`Floe` with waves and the inertia of the crack."""

    _written = (*Floe._written, "failure_times", "failed_cells", "_easing")
    lively = LIVELY

    def __init__(
        self,
        engine: ExplicitEngine,
        *,
        share: float = LOOSE,
        contact_time: float = CONTACT_TIME,
        criteria: tuple[Criterion, ...] = THESIS,
    ):
        """As `Floe`, with the windows of the engine; ``contact_time`` as `CONTACT_TIME` [-]."""
        super().__init__(engine, engine.window, share=share, criteria=criteria)
        self._contact_time = contact_time * math.sqrt(engine.ice.h / engine.ice.g)
        self.block = max(1, int(self._contact_time / engine.dt))  #: sub-steps between two evaluations of the contact
        screened = [c.judge for c in criteria if c.judge in SCREENED][:1]
        self._screened = bool(screened)  #: the loop stops at an overloaded cell
        self._others = len(criteria) > len(screened)  #: blocks are judged at their end
        for judge in screened:
            engine.watch(judge)
        self._lively, self._loss_rate = True, 0.0
        self._easing = Easing(engine.grid.cells, engine.ice.sigma_t)
        self._partner: Partner | None = None
        self.failure_times: list[float] = []  #: of all cells that failed, in order [s]
        self.failed_cells: list[int] = []  #: which they were

    def let_go(self, t: float, contact: EdgeContact, out: Outcome, release: Release) -> None:
        """Lets pieces go that have come loose without a new failure; nothing here."""

    def set_window(self, dt: float) -> None:
        """As `Floe.set_window`; the sub-steps are cut anew."""
        if dt != self.dt:
            self._cut_window(dt)

    def join(self, partner: Partner) -> None:
        """From now on this partner is met; its load is to be among those of every window."""
        self._partner = partner
        self._cut_window(self.dt)

    def _cut_window(self, dt: float) -> None:
        self.dt = dt
        if self._partner is not None:
            self.engine.parts = max(1, round(dt / self._partner.every))
        self.engine.set_window(dt)
        self.block = max(1, int(self._contact_time / self.engine.dt))

    def _meet(self, w: Window, done: int) -> int:
        """Sub-steps to the next meeting with the partner, which is met where one is due."""
        if self._partner is None:
            return self.engine.sub_steps
        part = self.engine.sub_steps // self.engine.parts
        if done % part == 0:
            self.state = self.engine.moving(self.state, self.present)
            self._partner.meet(w.t + done * self.engine.dt)
            w.renew(self._partner.load, self.present)
        return part - done % part

    def _advance(self, t: float, loads: Loads, contact: EdgeContact, release: Release) -> Outcome:
        """As `Floe._advance`; `release` is called with the state of that instant.

        The mean contact force has a row for each node of the contact, then one for each node that left with force.
        """
        keep(loads, self.present)
        start, present, out = self.state, self.present.copy(), Outcome()
        self.let_go(t, contact, out, release)
        keep(loads, self.present)
        window = Window.begin(t, start, loads, contact, self.grid.ny, self.held)
        self._begin(window)
        done = 0
        while done < self.engine.sub_steps:
            marched = self._march(window, done)
            done += marched.steps
            if marched.failed or self._others:
                self._break(window, done, out, release)
            if self._easing.any and not marched.failed:
                self._ease()
        self._end(window, out)
        mean, applied = window.mean(self.dt), window.applied(self.dt)
        whole = Mean(mean, mean, 1.0, 0.0)
        held = window.hold / self.dt
        out.reaction = between(self.support, start, self.state, self.dt, whole, held, present, applied)
        return out

    def _begin(self, w: Window) -> None:
        e, contact = self.engine, w.contact
        self._set_cells()
        touch = touch_at(w.t, contact, edge_displacement(self.state, contact.nodes, lever_of(contact)), self.grid.ny)
        forces = w.load, touch.at_once()
        e.start(self.state, self.present, forces)
        e.look_ahead(forces)
        self.energy.scheme -= self._lead(self.present)
        self._book_half(-0.5, w, touch)
        self._ease()

    def _march(self, w: Window, done: int) -> Marched:
        """Sub-steps to the next evaluation of the contact, or to a failure."""
        e, contact = self.engine, w.contact
        steps = min(self.block, e.sub_steps - done, self._meet(w, done))
        touch = e.touch(w.t + (done + 0.5 * steps) * e.dt, contact)
        e.deflections(w.before)
        out = e.march(steps, w.load, touch, self._lively)
        time = out.steps * e.dt
        e.add_path(time, w.before, w.q)
        w.impulse[contact.nodes] += time * out.contact
        self._book(w, out, touch)
        self._hold(w, time, out.hold - self.energy.on_held(contact.nodes, out.contact))
        rate, self._loss_rate = self._loss_rate, out.loss / time
        change = abs(self._loss_rate - rate) * self.block * e.dt
        self._lively = out.failed or change > self.lively * self.energy.stored
        return out

    def _end(self, w: Window, out: Outcome) -> None:
        touch = self.engine.touch(w.t + self.dt, w.contact)
        self.state = self.engine.state(self.state, self.present, (w.load, touch.at_once()))
        self._book_half(0.5, w, touch)
        self.utilisation = self._utilisation(self.state)
        self.energy.measure(self.state, self.live_cells, self.present)
        self.energy.scheme += self._lead(self.present)
        out.contact_mean, out.contact_nodes = w.contact_mean(self.dt)
        out.contact_end, out.parts = touch.force, self.parts

    # ---- failure -----------------------------------------------------------------------------------------------

    def _break(self, w: Window, done: int, out: Outcome, release: Release) -> None:
        """Takes out the cells that reached their limit in the last sub-step, in the order in which they did."""
        e, now = self.engine, w.t + done * self.engine.dt
        cells, share = self._overloaded()
        if not len(cells):
            return
        touch, ended, half = e.touch(now, w.contact), self._at(0.0), self._at(0.5)
        if out.failure is None:
            out.failure = (now - (1.0 - share[0]) * e.dt, touch.force)
        causes = self.judge.causes(ended.u, ended.q, self._eased(), cells)
        self.failed_cells += cells.tolist()
        self.failure_times += (now - (1.0 - share) * e.dt).tolist()
        self.fail(cells.tolist(), causes, half, out)
        self.energy.fracture -= self._swing(cells)
        self._set_cells()
        self.state, before = e.state(self.state, self.present, (w.load, touch.at_once())), self.present.copy()
        self._release_loose(out, release)
        self._book_left(before & ~self.present, w, touch)
        w.keep(self.present)
        self._ease()

    def _overloaded(self) -> tuple[IntArray, Array]:
        """Cells at or past their limit, and the part of the last sub-step at which each reached it.

        Of neighbours only the first: what it does to the others shows in the next sub-step. Two equal cells beside
        the axis of a symmetric floe would otherwise open two cracks with a row of loose nodes in between.
        """
        now = self._utilisation(self._at(0.0))
        cells = np.flatnonzero(now >= 1.0)
        part = self._reached(cells, now[cells])
        order = np.lexsort((-now[cells], part))
        order = order[_apart(cells[order], self.grid.ny - 1)]
        return cells[order], part[order]

    def _reached(self, cells: IntArray, now: Array) -> Array:
        """Part of the last sub-step at which cells came to their limit, of which the utilisation is known ``now``."""
        before = self._utilisation(self._at(1.0), cells)
        return np.clip((1.0 - before) / np.maximum(now - before, 1e-300), 0.0, 1.0)

    def _ease(self) -> None:
        """Keeps cells that have come to lie beside a crack tip from failing under what they carried before."""
        self._easing.look(self.judge.tensile_stress(*self.engine.displacement()), self.standing.limit)
        self._set_cells()

    def _set_cells(self) -> None:
        limits = self._eased().limit if self._screened else np.full(self.grid.cells, np.inf)
        self.engine.set_cells(self.live_cells, limits, self.present)

    def _eased(self) -> Standing:
        return replace(self.standing, limit=self._easing.limits(self.standing.limit))

    def _utilisation(self, state: State, cells: IntArray | slice = EVERY) -> Array:
        return self.judge.utilisation(state.u, state.q, self._eased(), cells)

    def _at(self, ago: float) -> State:
        u, q = self.engine.displacement(ago)
        return State(u, q, self.state.u_dot, self.state.q_dot)


def _apart(cells: IntArray, columns: int) -> IntArray:
    """Places of those cells that do not touch an earlier one of the list."""
    row, column = np.divmod(cells, columns)
    kept: list[int] = []
    for k in range(len(cells)):
        if all(max(abs(row[k] - row[m]), abs(column[k] - column[m])) > 1 for m in kept):
            kept.append(k)
    return np.array(kept, np.int64)
