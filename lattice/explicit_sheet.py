"""The sheet on the explicit engine: dynamic crack propagation.

A cell fails in the sub-step in which its utilisation reaches 1, the time of which is interpolated. Nothing is solved
again: what the cell carried goes out as waves, and the next cell fails when they have loaded it. Loose pieces leave
in the same sub-step.

The combined tensile criterion is looked at in every sub-step, inside the compiled loop. Other criteria are judged at
the end of each block of sub-steps between two evaluations of the contact (`ExplicitSheet.block`, at most
`CONTACT_TIME`): a cell then fails up to that much late.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lattice.contact import EdgeContact, edge_displacement, lever_of
from lattice.criteria.judge import Standing
from lattice.criteria.laws import combined_tension
from lattice.criteria.table import THESIS, Criterion
from lattice.explicit.easing import Easing
from lattice.explicit.engine import ExplicitEngine, Marched
from lattice.explicit.forces import PointForces, Touch, point_forces, touch_at
from lattice.explicit.layout import U_X
from lattice.explicit.window import Window
from lattice.floe import LOOSE, Floe, Release
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.loads import Loads, keep
from lattice.outcome import Outcome
from lattice.reaction import Mean, between
from lattice.state import State
from lattice.stiffness import Springs

#: longest time between two evaluations of the contact law, linear in between: a test finds 1e-4 of the displacements
#: against one evaluation in every sub-step [s]
CONTACT_TIME = 2e-3
LIVELY = 2e-7  #: change of the loss of a block, as share of the stored energy, from which each sub-step is booked


class ExplicitSheet(Floe):
    """`Floe` with waves and the inertia of the crack."""

    _written = (*Floe._written, "failure_times", "failed_cells", "_easing")
    engine: ExplicitEngine

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        dt: float,
        *,
        held: BoolArray,
        damping: float = 0.0,
        alpha: float = 0.0,
        share: float = LOOSE,
        step: float | None = None,
        contact_time: float = CONTACT_TIME,
        criteria: tuple[Criterion, ...] = THESIS,
    ):
        """As `Sheet`; ``step`` is the largest sub-step [s] (default: a share of the critical one)."""
        engine = ExplicitEngine(grid, ice, springs, dt, held_in_plane=held, damping=damping, alpha=alpha, step=step)
        super().__init__(engine, dt, held=held, share=share, criteria=criteria)
        self._contact_time = contact_time
        self.block = max(1, int(contact_time / engine.dt))  #: sub-steps between two evaluations of the contact
        self._screened = any(c.judge is combined_tension for c in criteria)  #: the loop stops at an overloaded cell
        self._others = any(c.judge is not combined_tension for c in criteria)  #: blocks are judged at their end
        self._lively, self._loss_rate = True, 0.0
        self._easing = Easing(grid.cells, ice.sigma_t)
        self.failure_times: list[float] = []  #: of all cells that failed, in order [s]
        self.failed_cells: list[int] = []  #: which they were

    def set_window(self, dt: float) -> None:
        """As `Floe.set_window`; the sub-steps are cut anew."""
        if dt != self.dt:
            self.dt = dt
            self.engine.set_window(dt)
            self.block = max(1, int(self._contact_time / self.engine.dt))

    def advance(self, t: float, loads: Loads, contact: EdgeContact, release: Release) -> Outcome:
        """As `Floe.advance`; `release` is called with the state of that instant.

        The mean contact force has a row for each node of the contact, then one for each node that left with force.
        """
        keep(loads, self.present)
        start, present, out = self.state, self.present.copy(), Outcome()
        window = Window.empty(start, loads)
        self._begin(t, loads, contact)
        done = 0
        while done < self.engine.sub_steps:
            marched = self._march(t, done, loads, contact, window)
            done += marched.steps
            if marched.failed or self._others:
                self._break(t, done, loads, contact, out, release)
            if self._easing.any and not marched.failed:
                self._ease()
        self._end(t + self.dt, loads, contact, out)
        out.contact_mean, out.contact_nodes = window.contact_mean(self.dt, contact.nodes)
        mean, applied = window.mean(self.dt), window.applied(self.dt)
        whole = Mean(mean, mean, 1.0, 0.0)
        out.reaction = between(self.support, start, self.state, self.dt, whole, self.live_cells, present, applied)
        return out

    def _begin(self, t: float, loads: Loads, contact: EdgeContact) -> None:
        e = self.engine
        self._set_cells()
        touch = touch_at(t, contact, edge_displacement(self.state, contact.nodes, lever_of(contact)), self.grid.ny)
        load = point_forces(loads, self.grid.ny)
        e.start(self.state, self.present, (load, touch.at_once()))
        self._book_half(-0.5, loads, load, touch)
        self._ease()

    def _march(self, t: float, done: int, loads: Loads, contact: EdgeContact, window: Window) -> Marched:
        """Sub-steps to the next evaluation of the contact, or to a failure."""
        e, load = self.engine, point_forces(loads, self.grid.ny)
        steps = min(self.block, e.sub_steps - done)
        touch = e.touch(t + (done + 0.5 * steps) * e.dt, contact)
        before = e.displacement()
        holding, at = self._holding(), e.touching(contact)
        out = e.march(steps, load, touch, self._lively)
        time = out.steps * e.dt
        window.note(time, before, e.displacement(), load, self.grid.ny, self.support.held)
        window.impulse[contact.nodes] += time * out.contact
        self._book(out, loads, load, contact, at)
        self.energy.hold += 0.5 * time * (holding + self._holding())
        rate, self._loss_rate = self._loss_rate, out.loss / time
        change = abs(self._loss_rate - rate) * self.block * e.dt
        self._lively = out.failed or change > LIVELY * self.energy.stored
        return out

    def _end(self, t: float, loads: Loads, contact: EdgeContact, out: Outcome) -> None:
        touch, load = self.engine.touch(t, contact), point_forces(loads, self.grid.ny)
        self.state = self.engine.state(self.state, self.present, (load, touch.at_once()))
        self._book_half(0.5, loads, load, touch)
        self.utilisation = self._utilisation(self.state)
        self.energy.measure(self.state, self.live_cells, self.present)
        self.energy.scheme = -self.engine.ripple
        out.contact_end, out.parts = touch.force, self.parts

    # ---- failure -----------------------------------------------------------------------------------------------

    def _break(self, t: float, done: int, loads: Loads, contact: EdgeContact, out: Outcome, release: Release) -> None:
        """Takes out the cells that reached their limit in the last sub-step, in the order in which they did."""
        e, now = self.engine, t + done * self.engine.dt
        cells, share = self._overloaded()
        if not len(cells):
            return
        touch, load = e.touch(now, contact), point_forces(loads, self.grid.ny)
        ended, half = self._at(0.0), self._at(0.5)
        self.state = e.state(self.state, self.present, (load, touch.at_once()))
        if out.failure is None:
            out.failure = (now - (1.0 - share[0]) * e.dt, touch.force)
        causes = self.judge.causes(ended.u, ended.q, self._eased(), cells)
        self.failed_cells += cells.tolist()
        self.failure_times += (now - (1.0 - share) * e.dt).tolist()
        self.fail(cells.tolist(), causes, half, out)  # with x(n) . K x(n-1) / 2, what leapfrog loses
        self._release_loose(out, release)
        keep(loads, self.present)
        self._ease()

    def _overloaded(self) -> tuple[IntArray, Array]:
        """Cells at or past their limit, and the part of the last sub-step at which each reached it.

        Of neighbours only the first: what it does to the others shows in the next sub-step. Two equal cells beside
        the axis of a symmetric floe would otherwise open two cracks with a row of loose nodes in between.
        """
        now, before = (self._utilisation(self._at(ago)) for ago in (0.0, 1.0))
        cells = np.flatnonzero(now >= 1.0)
        rise = np.maximum(now[cells] - before[cells], 1e-300)
        part = np.clip((1.0 - before[cells]) / rise, 0.0, 1.0)
        order = np.lexsort((-now[cells], part))
        order = order[_apart(cells[order], self.grid.ny - 1)]
        return cells[order], part[order]

    def _ease(self) -> None:
        """Keeps cells that have come to lie beside a crack tip from failing under what they carried before."""
        self._easing.look(self.judge.tensile_stress(*self.engine.displacement()), self.standing.limit)
        self._set_cells()

    def _set_cells(self) -> None:
        limits = self._eased().limit if self._screened else np.full(self.grid.cells, np.inf)
        self.engine.set_cells(self.live_cells, limits, self.present)

    def _eased(self) -> Standing:
        return replace(self.standing, limit=self._easing.limits(self.standing.limit))

    def _utilisation(self, state: State) -> Array:
        return self.judge.utilisation(state.u, state.q, self._eased())

    def _at(self, ago: float) -> State:
        u, q = self.engine.displacement(ago)
        return State(u, q, self.state.u_dot, self.state.q_dot)

    # ---- energy ------------------------------------------------------------------------------------------------

    def _holding(self) -> float:
        """Force along x at the held edge now [N]."""
        u, _ = self.engine.displacement(-self.engine.alpha / self.engine.dt)  # x + alpha v
        return self.energy.holding(u, np.zeros_like(u), np.zeros_like(u), self.live_cells)

    def _book(self, out: Marched, loads: Loads, load: PointForces, contact: EdgeContact, at: Array) -> None:
        """Books sub-steps before which the points of the contact were ``at`` (m, 3) [m]."""
        books, time = self.energy, out.steps * self.engine.dt
        after = self.engine.touching(contact)
        books.touch.work += out.contact_work
        books.touch.push += time * float(out.contact[:, 0].sum())
        books.rub.add(time, books.friction_of(after, out.contact), (after - at) / time)
        for k, each in enumerate(loads):
            of = slice(load.first[k], load.first[k + 1])
            book = books.load(each.name)
            book.work += float(out.work[k])
            book.push += time * float(load.force[of, U_X].sum())
        books.damping += out.loss

    def _book_half(self, part: float, loads: Loads, load: PointForces, touch: Touch) -> None:
        """Work in the half sub-step by which the velocities of the march lie before the ends of a window."""
        v, time = np.hstack((self.state.u_dot, self.state.q_dot)), part * self.engine.dt
        f = touch.at_once()
        self.energy.touch.add(time, f.force, v[f.row * self.grid.ny + f.column])
        nodes = load.row * self.grid.ny + load.column
        for k, each in enumerate(loads):
            of = slice(load.first[k], load.first[k + 1])
            self.energy.load(each.name).add(time, load.force[of], v[nodes[of]])


def _apart(cells: IntArray, columns: int) -> IntArray:
    """Places of those cells that do not touch an earlier one of the list."""
    row, column = np.divmod(cells, columns)
    kept: list[int] = []
    for k in range(len(cells)):
        if all(max(abs(row[k] - row[m]), abs(column[k] - column[m])) > 1 for m in kept):
            kept.append(k)
    return np.array(kept, np.int64)
