"""The sheet on the implicit engine: the failures within one window.

A window of length dt is solved in one step. If a cell is overloaded at its end, the instant at which its utilisation
reached 1 is located on the step's interpolation, the cell is removed and the same window is solved again, until no
cell is overloaded (thesis 4.2.1; one cell at a time, so that the order of a cascade is that of the utilisation).
A step whose contact finds no equilibrium, or whose energy does not balance, is solved in halves, down to `SHORTEST`.

Quiet windows are read off a long step (`lattice.long_step`). The window of a failure is always solved on its own.
"""

from __future__ import annotations

from contextlib import suppress
from copy import copy

import numpy as np

from lattice.contact import EdgeContact, edge_displacement, lever_of
from lattice.criteria.table import THESIS, Criterion
from lattice.energy import EnergyBooks
from lattice.floe import LOOSE, Floe, Release
from lattice.grid import Array, IntArray
from lattice.implicit.engine import Engine
from lattice.implicit.step import Step
from lattice.loads import Loads, keep, total
from lattice.long_step import LongSteps
from lattice.outcome import TURNED_TOO_FAR, Outcome
from lattice.part_steps import BALANCED, NOTHING, SHORTEST, Parts
from lattice.reaction import Reaction, between, of_cubic, of_step
from lattice.state import StepError

LOCATION = 1e-4  #: part of a window to which a failure is located: 2.5 us of 25 ms, far below what the step resolves
#: energy that no term explains where a long step is given up, as a share of the work done so far: a tenth of what the
#: books of a run allow [-]
SERVED = 1e-4
TURNED = 0.1  #: rotation out of plane at which a hanging piece leaves: 1 - cos = 0.5 %, the lattice is linear [rad]


class Sheet(Floe):
    """`Floe` in implicit steps: quasi-static propagation of cracks."""

    _written = (*Floe._written, "ahead")

    def __init__(
        self,
        engine: Engine,
        dt: float,
        *,
        share: float = LOOSE,
        long_step: int = 1,
        criteria: tuple[Criterion, ...] = THESIS,
    ):
        """As `Floe`; ``long_step`` is the largest number of windows in one step."""
        engine.use(dt)
        super().__init__(engine, dt, share=share, criteria=criteria)
        self.ahead = LongSteps(long_step, dt)
        self._booked = self.energy  #: as they are after the step that is tried

    def set_window(self, dt: float) -> None:
        """As `Floe.set_window`; a long step, which is cut into equal windows, is given up."""
        if dt != self.dt:
            self._drop_long_step()
            self.ahead.set_window(dt)
            self.dt = dt

    def window_by_window(self) -> None:
        """As `Floe.window_by_window`."""
        self._drop_long_step()
        self.ahead = LongSteps(0, self.dt)

    def retire(self, nodes: IntArray) -> None:
        """As `Floe.retire`; a long step is given up."""
        self._drop_long_step()
        super().retire(nodes)

    def _advance(self, t: float, loads: Loads, contact: EdgeContact, release: Release) -> Outcome:
        """As `Floe._advance`; pieces leave with their state at the start of the window."""
        keep(loads, self.present)
        if any(load.acts for load in loads) or self._rotation().max() > TURNED:
            self._drop_long_step(t, contact)
        else:
            out = self._from_long_step(t, contact)
            if out is not None:
                return out
        return self._solve_window(t, loads, contact, release)

    # ---- one window -------------------------------------------------------------------------------------------

    def _solve_window(self, t: float, loads: Loads, contact: EdgeContact, release: Release) -> Outcome:
        out, parts = Outcome(), Parts(self.grid.nodes)
        if self._rotation().max() > TURNED:
            self._tear_off(t, contact, out, release)
            keep(loads, self.present)
        done, share = 0.0, 1.0  # of the window; sums of powers of two are exact
        while done < 1.0:
            try:
                step = self._settle(t + done * self.dt, share * self.dt, loads, contact, out, release)
            except StepError as error:
                share = _halved(share, self.dt, error)
                continue
            parts.add(share, step, contact.nodes, self._accept(step, loads, contact))
            done += share
        out.contact_mean, out.contact_nodes = parts.contact(contact.nodes)
        out.contact_end, out.reaction, out.parts = step.contact_end, parts.reaction(), self.parts
        if out.failed:
            self.ahead.interrupt()
        return out

    def _settle(self, t: float, dt: float, loads: Loads, contact: EdgeContact, out: Outcome, release: Release) -> Step:
        """A step over ``dt`` at whose end no cell is overloaded: cells fail, worst first, until it is one.

        StepError where the contact finds no equilibrium, or the energy does not balance.
        """
        while True:
            step = self.engine.step(t, dt, self.state, *total(loads, self.grid.nodes), contact)
            self._booked = self._balanced(step, loads, contact)
            self.utilisation = self._utilisation(step.state)
            worst = int(np.argmax(self.utilisation))
            if self.utilisation[worst] < 1.0:
                return step
            if out.failure is None:
                out.failure = self._locate(t, step, contact)
            causes = self.judge.causes(step.state.u, step.state.q, self.standing, np.array([worst]))
            self.fail([worst], causes, self.state, out)
            self._release_loose(out, release)
            keep(loads, self.present)

    def _balanced(self, step: Step, loads: Loads, contact: EdgeContact) -> EnergyBooks:
        """The books after a step; StepError if its energy does not balance."""
        books, live, present = copy(self.energy), self.live_cells, self.present
        books.measure(self.state, live, present)
        before, stored = books.residual, books.stored
        books.book_step(step, loads, contact.nodes, live, present)
        error, scale = abs(books.residual - before), max(abs(books.contact), abs(books.received), books.stored, stored)
        if not error <= BALANCED * (scale + NOTHING * self.ice.E * self.ice.h**3):
            raise StepError(f"the energy of a step of the sheet is off by {error:.3g} J of {scale:.3g} J")
        return books

    def _accept(self, step: Step, loads: Loads, contact: EdgeContact) -> Reaction:
        """Takes the end of a step as the new state, with its energy; what has carried the sheet."""
        live, present, applied = self.live_cells, self.present, self.support.applied(loads)
        a, b, mean = self.state, step.state, of_step(step)
        at_once = applied.held + self.energy.on_held(contact.nodes, step.contact_mean)
        held = self.support.force(mean, a, b, step.dt, live) - at_once
        self.state, self.energy = step.state, self._booked
        return between(self.support, a, b, step.dt, mean, held, present, applied.by_name)

    def _locate(self, t: float, step: Step, contact: EdgeContact) -> tuple[float, Array]:
        """Instant at which the first utilisation reaches 1, by bisection, and the contact force then."""
        low, high = 0.0, 1.0
        while high - low > LOCATION:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self._utilisation(step.at(middle)).max() >= 1.0 else (middle, high)
        time = t + high * step.dt
        return time, contact.evaluate(time, edge_displacement(step.at(high), contact.nodes, step.lever))[0]

    # ---- long steps -------------------------------------------------------------------------------------------

    def _from_long_step(self, t: float, contact: EdgeContact) -> Outcome | None:
        """The window read off a long step, taken if there is none under way; None where it must be solved."""
        plan = self.ahead.under_way or self.ahead.take(self.engine, t, self.dt, self.state, contact)
        if plan is None:
            return None
        state = plan.at(plan.served + 1)
        utilisation = self._utilisation(state)
        if utilisation.max() >= 1.0:
            self._drop_long_step(t, contact)
            return None
        live, present, old = self.live_cells, self.present, self.state
        end = edge_displacement(state, contact.nodes, plan.step.lever)
        force = contact.evaluate(t + self.dt, end)[0]
        mean = plan.serve(self.energy, old, end, force, contact)
        out = Outcome(mean, contact.nodes, force, parts=self.parts)
        cubic = of_cubic(old, state, self.dt)
        held = self.support.force(cubic, old, state, self.dt, live) - self.energy.on_held(contact.nodes, mean)
        out.reaction = between(self.support, old, state, self.dt, cubic, held, present, {})
        self.state, self.utilisation = state, utilisation
        if plan.served == plan.windows:
            self.energy.book_step(plan.step, (), contact.nodes, live, present)
            self.ahead.under_way = None
        return out

    def _drop_long_step(self, t: float = 0.0, contact: EdgeContact | None = None) -> None:
        """Goes on from the last window served, at whose end ``t`` it is.

        What was served of a step is no step, so its energy balances as well as the interpolation is good. Where that
        is too little, for a contact that has just begun, the windows served are solved as a step of their own.
        """
        plan, before = self.ahead.under_way, copy(self.energy)
        self.ahead.drop(self.energy, self.dt, self.state, self.live_cells, self.present)
        if plan is None or contact is None or not plan.served:
            return
        if abs(self.energy.residual) <= SERVED * max(abs(self.energy.contact), abs(self.energy.received)):
            return
        time, none = plan.served * self.dt, total((), self.grid.nodes)
        with suppress(StepError):  # then the books stay as they are, and the run judges them
            step = self.engine.step(t - time, time, plan.step.start, *none, contact)
            before.book_step(step, (), contact.nodes, self.live_cells, self.present)
            self.state, self.energy = step.state, before

    # ---- pieces that have turned too far ----------------------------------------------------------------------

    def _rotation(self) -> Array:
        """Larger of the two rotations of each node that is present, (nodes,) [rad]."""
        q = np.abs(self.state.q)
        return np.where(self.present, np.maximum(q[:, 1], q[:, 2]), 0.0)

    def _tear_off(self, t: float, contact: EdgeContact, out: Outcome, release: Release) -> None:
        """Parts a piece that has turned out of the range of small rotations, with what has gone half as far.

        A part that has turned as a whole leaves too, whatever its size and wherever it is held in the plane.
        """
        turned = self._rotation() > 0.5 * TURNED
        corners = turned[self.grid.cell_nodes]
        cells = np.flatnonzero(self.live_cells & corners.any(axis=1) & ~corners.all(axis=1)).tolist()
        force = contact.evaluate(t, edge_displacement(self.state, contact.nodes, lever_of(contact)))[0]
        self.fail(cells, [TURNED_TOO_FAR] * len(cells), self.state, out)
        self._release_loose(out, release, turned)
        if cells or out.pieces:
            out.failure = t, force


def _halved(share: float, window: float, error: StepError) -> float:
    """Half the share of a window of so many seconds; the error if that is too short."""
    if 0.5 * share < SHORTEST:
        shortest = f"{share * window * 1e3:.3g} ms, 1/{1.0 / share:.0f} of the window"
        raise StepError(f"{error}, even in steps of {shortest}; shorten coupling.window") from error
    return 0.5 * share
