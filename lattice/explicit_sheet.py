"""The sheet on the explicit engine: dynamic crack propagation.

A cell fails in the sub-step in which its utilisation reaches 1, the time of which is interpolated. Nothing is solved
again: what the cell carried goes out as waves, and the next cell fails when they have loaded it. Loose pieces leave
in the same sub-step.

The limit beside a crack tip (4.31) belongs to the concentrated strain of a cell that the tip has loaded. When a cell
breaks, its neighbours on the flanks still carry the strain from before, which may exceed (4.31) until they have
unloaded: a few wave passages, and never less than alpha. Such a cell fails only if its load *rises*; as it falls, its
limit comes down with it to (4.31). Without that, both flanks of the first cell of every crack break off.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lattice.criteria import cell_strains, combined_utilisation
from lattice.energy import EnergyBooks
from lattice.engine import EdgeContact, State
from lattice.explicit import ExplicitEngine
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.march import Marched, NodeForces
from lattice.reaction import Mean, Support, between
from lattice.sheet import Outcome, Sheet, edge_displacement
from lattice.stiffness import Springs

CONTACT_TIME = 2e-3  #: longest time between two evaluations of the contact law, linear in between [s]
RISE = 1e-3  #: share by which a cell beside a new crack tip must be loaded further to fail
LIVELY = 2e-7  #: change of the loss of a block, as share of the stored energy, from which each sub-step is booked


class ExplicitSheet(Sheet):
    """`Sheet` with waves and the inertia of the crack."""

    _written = (*Sheet._written, "failure_times", "failed_cells")

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        dt: float,
        *,
        held: np.ndarray,
        damping: float = 0.0,
        alpha: float = 0.0,
        share: float = 0.2,
        step: float | None = None,
        contact_time: float = CONTACT_TIME,
    ):
        """As `Sheet`; ``step`` is the largest sub-step [s] (default: a share of the critical one)."""
        super().__init__(grid, ice, springs, dt, held=held, damping=damping, alpha=alpha, share=share)
        self.engine: ExplicitEngine = ExplicitEngine(
            grid, ice, springs, dt, held_in_plane=held, damping=damping, alpha=alpha, step=step
        )
        self.energy = EnergyBooks(self.engine)
        self._contact_time = contact_time
        self.support = Support(self.engine, held)
        self.block = max(1, int(contact_time / self.engine.dt))  #: sub-steps between two evaluations of the contact
        self._lively, self._loss_rate = True, 0.0
        self._eased = np.zeros(grid.cells)  #: limit of cells that a crack tip has just reached, else 0 [Pa]
        self._unconcentrated = np.full(grid.cells, ice.sigma_t)  #: limits before the last failure [Pa]
        self.failure_times: list[float] = []  #: of all cells that failed, in order [s]
        self.failed_cells: list[int] = []  #: which they were

    def set_window(self, dt: float) -> None:
        """As `Sheet.set_window`; the sub-steps are cut anew."""
        if dt != self.dt:
            super().set_window(dt)
            self.engine.set_window(dt)
            self.block = max(1, int(self._contact_time / self.engine.dt))

    def advance(
        self, t: float, force_u: Array, force_q: Array, contact: EdgeContact, release: Callable[[IntArray], None]
    ) -> Outcome:
        """One window from time t, as `Sheet.advance`; `release` is called with the state of that instant.

        The mean contact force has a row for each node of the contact, then one for each node that left with force.
        """
        out, impulse = Outcome(np.empty((0, 3)), np.empty((0, 3))), np.zeros((self.grid.nodes, 3))
        start, present = self.state, self.present.copy()
        self._begin(t, force_u, force_q, contact)
        self._u_sum, self._q_sum, self._applied = np.zeros_like(start.u), np.zeros_like(start.q), np.zeros(3)
        done = 0
        while done < self.engine.sub_steps:
            load = self._loads(force_u, force_q)
            marched = self._march(t, done, load, contact, impulse)
            done += marched.steps
            if marched.failed:
                self._break(t, done, (load,), contact, out, release)
            elif self._eased.any():
                self._ease()
        self._end(t + self.dt, self._loads(force_u, force_q), contact, out)
        self._means(out, impulse / self.dt, contact.nodes)
        mean = State(self._u_sum / self.dt, self._q_sum / self.dt, start.u_dot, start.q_dot)
        applied = tuple((self._applied / self.dt).tolist())
        out.reaction = between(
            self.support, start, self.state, self.dt, Mean(mean, mean, 1.0, 0.0), self.live_cells, present, applied
        )
        return out

    def _loads(self, force_u: Array, force_q: Array) -> NodeForces:
        force_u[~self.present], force_q[~self.present] = 0.0, 0.0
        return self.engine.constant(force_u, force_q)

    def _begin(self, t: float, force_u: Array, force_q: Array, contact: EdgeContact) -> None:
        e = self.engine
        e.set_cells(self.live_cells, self._limits(), self.present)
        touch = e.contact_at(t, contact, edge_displacement(self.state, contact.nodes, contact.height))
        load = self._loads(force_u, force_q)
        e.start(self.state, self.present, (load, touch))
        self._book_half(-0.5, load, touch)
        self._ease()

    def _march(self, t: float, done: int, load: NodeForces, contact: EdgeContact, impulse: Array) -> Marched:
        """Sub-steps to the next evaluation of the contact, or to a failure."""
        e = self.engine
        steps = min(self.block, e.sub_steps - done)
        patch = e.contact(t + (done + 0.5 * steps) * e.dt, contact)
        before = e.displacement()
        holding, at = self._holding(), e.touching(contact)
        out = e.march(steps, load, patch, self._lively)
        self._note(out.steps * e.dt, before, load)
        impulse[contact.nodes] += out.steps * e.dt * out.contact
        self._book(out, load, holding, at, contact)
        rate, self._loss_rate = self._loss_rate, out.loss / (out.steps * e.dt)
        change = abs(self._loss_rate - rate) * self.block * e.dt
        self._lively = out.failed or change > LIVELY * self.energy.stored
        return out

    def _note(self, time: float, before: tuple[Array, Array], load: NodeForces) -> None:
        """Adds some sub-steps to the integrals of displacement and applied force (trapezoidal rule)."""
        for total, old, new in zip((self._u_sum, self._q_sum), before, self.engine.displacement(), strict=True):
            total += 0.5 * time * (old + new)
        nodes = load.row * self.grid.ny + load.column
        self._applied += time * np.array(self.support.applied(nodes, load.force[:, 0], load.force[:, 2]))

    def _holding(self) -> float:
        """Force along x at the held edge now [N]."""
        u, _ = self.engine.displacement(-self.engine.alpha / self.engine.dt)  # x + alpha v
        return self.energy.holding(u, np.zeros_like(u), np.zeros_like(u), self.live_cells)

    def _book(self, out: Marched, load: NodeForces, holding: float, at: Array, contact: EdgeContact) -> None:
        """Books sub-steps before which the edge was held with ``holding`` [N] and its points were ``at`` (m, 3) [m]."""
        books, time = self.energy, out.steps * self.engine.dt
        after = self.engine.touching(contact)
        books.touch.work += out.contact_work
        books.touch.push += time * float(out.contact[:, 0].sum())
        books.rub.add(time, books.friction_of(after, out.contact), (after - at) / time)
        books.others.work += out.work
        books.others.push += time * float(load.force[:, 0].sum())
        books.hold += 0.5 * time * (holding + self._holding())
        books.damping += out.loss

    # ---- failure -----------------------------------------------------------------------------------------------

    def _break(
        self,
        t: float,
        done: int,
        loads: tuple[NodeForces, ...],
        contact: EdgeContact,
        out: Outcome,
        release: Callable[[IntArray], None],
    ) -> None:
        """Takes out the cells that reached their limit in the last sub-step, in the order in which they did."""
        e, now = self.engine, t + done * self.engine.dt
        cells, share = self._overloaded()
        if not len(cells):
            return
        patch = e.contact(now, contact)
        self.state, half = e.state(self.state, self.present, (*loads, patch)), self._at(0.5)
        if out.failure is None:
            out.failure = (now - (1.0 - share[0]) * e.dt, patch.force)
        for cell, s in zip(cells, share, strict=True):
            self.energy.book_failure(int(cell), half)  # with x(n) . K x(n-1) / 2, what leapfrog loses
            self.intact[cell] = False
            out.failed.append(int(cell))
            self.failed_cells.append(int(cell))
            self.failure_times.append(now - (1.0 - s) * e.dt)
        e.remove(cells)
        self._release_loose(out, release)
        self._ease()

    def _ease(self) -> None:
        """Keeps cells that have come to lie beside a crack tip from failing under what they carried before."""
        u, q = self.engine.displacement()
        strains = cell_strains(self.grid.cell_nodes, self.grid.d, u, q)
        stress, limit = combined_utilisation(strains, 1.0, self.ice), super()._limits()
        eased = np.where(limit < self._unconcentrated, np.inf, self._eased)
        self._eased = np.where((eased > 0.0) & (stress > limit), np.minimum(eased, (1.0 + RISE) * stress), 0.0)
        self._unconcentrated = limit
        self.engine.set_cells(self.live_cells, self._limits(), self.present)

    def _limits(self) -> Array:
        return np.maximum(super()._limits(), self._eased)

    def _overloaded(self) -> tuple[IntArray, Array]:
        """Cells at or past their limit, and the share of the last sub-step at which each reached it.

        Of neighbours only the first: what it does to the others shows in the next sub-step. Two equal cells beside
        the axis of a symmetric floe would otherwise open two cracks with a row of loose nodes in between.
        """
        now, before = (self._utilisation(self._at(ago)) for ago in (0.0, 1.0))
        cells = np.flatnonzero(now >= 1.0)
        rise = np.maximum(now[cells] - before[cells], 1e-300)
        share = np.clip((1.0 - before[cells]) / rise, 0.0, 1.0)
        order = np.lexsort((-now[cells], share))
        order = order[_apart(cells[order], self.grid.ny - 1)]
        return cells[order], share[order]

    def _at(self, ago: float) -> State:
        u, q = self.engine.displacement(ago)
        return State(u, q, self.state.u_dot, self.state.q_dot)

    # ---- end of a window ---------------------------------------------------------------------------------------

    def _end(self, t: float, load: NodeForces, contact: EdgeContact, out: Outcome) -> None:
        patch = self.engine.contact(t, contact)
        self.state = self.engine.state(self.state, self.present, (load, patch))
        self._book_half(0.5, load, patch)
        self.utilisation = self._utilisation(self.state)
        self.energy.measure(self.state, self.live_cells, self.present)
        self.energy.scheme = -self.engine.ripple
        out.contact_end, out.parts = patch.force, self.parts

    def _means(self, out: Outcome, mean: Array, nodes: IntArray) -> None:
        left = np.setdiff1d(np.flatnonzero(mean.any(axis=1)), nodes)
        out.contact_mean = mean[np.concatenate((nodes, left))]

    def _book_half(self, share: float, load: NodeForces, patch: NodeForces) -> None:
        """Work in the half sub-step by which the velocities of the march lie before the ends of a window."""
        v = np.hstack((self.state.u_dot, self.state.q_dot))
        for f, work in ((patch, self.energy.touch), (load, self.energy.others)):
            work.add(share * self.engine.dt, f.padded(), v[f.row * self.grid.ny + f.column])


def _apart(cells: IntArray, columns: int) -> IntArray:
    """Places of those cells that do not touch an earlier one of the list."""
    row, column = np.divmod(cells, columns)
    kept: list[int] = []
    for k in range(len(cells)):
        if all(max(abs(row[k] - row[m]), abs(column[k] - column[m])) > 1 for m in kept):
            kept.append(k)
    return np.array(kept, np.int64)
