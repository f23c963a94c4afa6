"""Coupling schemes by name: who sees whose newest data.

A scheme runs one window: it is called with the scheduler and returns what the sheet did. Blocks are born with the state
that their ice had at the start of the window and are moved through it by the rubble, in every scheme: no time is lost
or counted twice.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from coupling.interface import (
    NS,
    Fragment,
    IntArray,
    Restore,
    SheetEdge,
    SheetForces,
    SheetReport,
    SimulationError,
)
from coupling.relaxation import Aitken, change, combined
from coupling.scheduler import Scheduler, Scheme

NEWEST = 0.2  #: share of the newest force in the running mean
GIVEN = 0.5  #: share of what swings about the mean that the sheet is given


@dataclass(frozen=True)
class Iteration:
    """How an implicit scheme iterates."""

    tolerance: float = 1e-3  #: change of the interface forces that counts as none, relative
    max_iterations: int = 30
    relaxation: float = 1.0  #: omega before there are two residuals
    floor: float = 1e4  #: forces below which the change is set against this instead [N]
    stop: bool = True  #: a window that does not converge ends the run; else it is counted


class SerialExplicit:
    """First the sheet under the rubble's forces of the last window, then the rubble against the way it has gone.

    An edge that is pressed on answers to a force one window late. Where rubble is jammed this is an oscillator without
    damping, about six windows long: the rubble stops the edge, the sheet learns of it when it has gone on. What swings
    about the running mean of the forces is therefore given to the sheet by half; the mean itself is given whole, so
    that no impulse is lost in the long run.
    """

    def __init__(self) -> None:
        self._mean = SheetForces.none()

    def save(self) -> Restore:
        """The running mean between two windows."""
        return partial(setattr, self, "_mean", self._mean)

    def __call__(self, s: Scheduler) -> SheetReport:
        """One window."""
        force = s.rubble.forces_on_sheet()
        self._mean = combined(1.0 - NEWEST, self._mean, NEWEST, force) if s.t_ns > 0 else force
        given = combined(GIVEN, force, 1.0 - GIVEN, self._mean)
        report = s.move_sheet(given)
        s.move_rubble(s.sheet.path(s.rubble.sections_in_use()), given)
        return report


class Lockstep:
    """Sheet and rubble meet in every sub-step of the rubble: each knows where the other is and with what it presses.

    The sheet's nodes are bodies of the contact solver (`coupling.sheet_port.meeting`); what stops them there acts on
    the lattice in the same sub-step. Pieces that leave the lattice become plates when the window begins, those that
    leave within it when it ends.
    """

    def __call__(self, s: Scheduler) -> SheetReport:
        """One window."""
        nodes: list[IntArray] = []

        def answer(fragments: list[Fragment]) -> SheetForces:
            if not nodes:
                for fragment in fragments:
                    s.hand_over(fragment)
                edges = s.sheet.edges(s.rubble.sections_in_use())
                s.rubble.begin(edges)
                nodes.append(np.concatenate([np.zeros(0, np.int64), *(e.nodes for e in edges.values())]))
            force = s.rubble.meet(s.sheet.nodes(nodes[0]))
            on = force.any(axis=1)
            return SheetForces(nodes[0][on], force[on])

        report = s.sheet.advance(s.t_ns, s.window_ns, s.rubble.forces_on_sheet(), s.rubble_load(), answer)
        s.rubble.end()
        for fragment in report.fragments:
            s.hand_over(fragment)
        return report


class ParallelExplicit:
    """Both at once, each with the other's data of the last window (Jacobi).

    What the rubble meets is the sheet at the start of the window, which answers to the forces of the window before.
    Blocks cannot be moved before they are born: a window with a hand-over, and the first one, run one after the other.
    """

    def __init__(self) -> None:
        self._carried = SheetForces.none()

    def __call__(self, s: Scheduler) -> SheetReport:
        """One window."""
        force, edges = s.rubble.forces_on_sheet(), self._edges(s)
        report = s.move_sheet(force)
        if edges is None or report.fragments:
            s.move_rubble(s.sheet.path(s.rubble.sections_in_use()), force)
        else:
            s.move_rubble(edges, self._carried)
        self._carried = force
        return report

    def _edges(self, s: Scheduler) -> dict[int, SheetEdge] | None:
        """The sheet before it moves; None if no window has gone before."""
        return s.sheet.edges(s.rubble.sections_in_use()) if s.t_ns > 0 else None


class SerialImplicit:
    """The window is repeated until the forces under which the sheet moves are those with which the rubble answers.

    The rubble meets the sheet on the way that it has just gone (`path`). Its edge is there a body on springs that
    already carry the forces of this iteration, so the springs answer to the change alone; when there is none, they are
    at rest and the edge of the rubble goes the way of the lattice, whatever the stiffness of the springs.

    Forces are predicted by a straight line through the last two windows. The iteration ends with the pass in which a
    piece breaks off: under the push of the blocks that it becomes it would not have broken, and then nothing pushes, so
    there is no answer to converge to. Such a window is as good as an explicit one and says so by its residual. In the
    next window the sheet is another function of the forces: prediction and relaxation start anew. Any other window
    that does not converge ends the run, or is counted in the balances.
    """

    def __init__(self, iteration: Iteration):
        self._limits, self._aitken = iteration, Aitken(iteration.relaxation)
        self._before: tuple[int, SheetForces] | None = None  #: length and answer of the window before the last
        self._last: tuple[int, SheetForces] | None = None
        self._unconverged = 0

    def __call__(self, s: Scheduler) -> SheetReport:
        """One window, as often as it takes."""
        force, restore = self._first_guess(s), s.save()
        for k in range(1, self._limits.max_iterations + 1):
            if k > 1:
                restore()
            report = s.move_sheet(force)
            s.move_rubble(s.sheet.path(s.rubble.sections_in_use()), force)
            answer = s.rubble.forces_on_sheet()
            residual = change(force, answer, self._limits.floor)
            if residual <= self._limits.tolerance or report.fragments:
                break
            force = self._aitken.next(force, answer)
        else:
            self._give_up(s, residual)
        self._before, self._last = self._last, (s.window_ns, answer)
        s.notes = {
            "iterations": float(k),
            "interface_residual": residual,
            "unconverged_windows": float(self._unconverged),
        }
        return report

    def _first_guess(self, s: Scheduler) -> SheetForces:
        """The forces in the middle of the coming window, on the line through the middles of the last two."""
        if s.jump:
            self._before = self._last = None
            self._aitken.drop()
        self._aitken.begin()
        if self._before is None or self._last is None:
            return s.rubble.forces_on_sheet()
        (older, f), (newer, g) = self._before, self._last
        ahead = (s.window_ns + newer) / (newer + older)
        return combined(1.0 + ahead, g, -ahead, f)

    def _give_up(self, s: Scheduler, residual: float) -> None:
        self._unconverged += 1
        if self._limits.stop:
            raise SimulationError(
                f"t = {s.t_ns / NS:.3f} s: the forces between sheet and rubble still change by {residual:.2g} of "
                f"themselves after {self._limits.max_iterations} iterations of the window of {s.window_ns / 1e6:g} ms "
                f"(tolerance {self._limits.tolerance:g}): shorten coupling.window, raise coupling.max_iterations or "
                "coupling.tolerance, or let such windows be counted with coupling.unconverged = 'count'"
            )


SCHEMES: dict[str, Callable[[Iteration], Scheme]] = {
    "lockstep": lambda _: Lockstep(),
    "serial-explicit": lambda _: SerialExplicit(),
    "parallel-explicit": lambda _: ParallelExplicit(),
    "serial-implicit": SerialImplicit,
}
