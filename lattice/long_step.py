"""Steps that span several windows, which are then read off their interpolation.

While nothing but the structure loads the sheet and no cell fails, one long step is taken ahead. A step is refused when
its error estimate exceeds `LONG_STEP_ERROR`; the next try is half as long, and after an accepted one twice as long.
"""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field, replace

import numpy as np

from lattice.contact import EdgeContact, edge_displacement, lever_of
from lattice.energy import EnergyBooks
from lattice.grid import Array, BoolArray
from lattice.implicit.engine import Engine
from lattice.implicit.step import Step
from lattice.loads import total
from lattice.state import State, StepError
from lattice.stock import Served

#: largest estimated error of a displacement in a long step, as a share of the thickness, 0.6 mm for 3 m of ice: there
#: halving the longest step moves the first failure of the 165 m floe by less than 1e-5 and the peak load by 0.3 %
LONG_STEP_ERROR = 2e-4
#: windows without a failure before the next long step, which would not follow the waves of a crack: in eight windows of
#: 25 ms an in-plane wave (3.4 km/s) crosses a floe of 165 m four times; a long step taken too early is refused anyway
QUIET = 8


@dataclass
class LongStep:
    """A step over several windows, served window by window; its contact keeps its levers throughout."""

    step: Step
    dt: float  #: of a window [s]
    windows: int
    served: int = 0
    contact: Array = field(default_factory=lambda: np.empty((0, 3)))  #: force at the last window's end
    done: Served = field(default_factory=Served)  #: of the contact in the windows served, by the trapezoidal rule

    def at(self, window: int) -> State:
        """State at the end of the window of this number, counted from 1; 0 is the start."""
        return self.step.at(window / self.windows)

    def serve(self, energy: EnergyBooks, old: State, end: Array, force: Array, contact: EdgeContact) -> Array:
        """Takes one more window as done, to whose end the edge has come to ``end`` (m, 3); mean contact force (m, 3).

        ``force`` (m, 3) is that of the contact at the end, ``old`` the state at the start of the window.
        """
        mean = 0.5 * (self.contact + force)
        path = end - edge_displacement(old, contact.nodes, self.step.lever)
        self.done.touch.add(self.dt, mean, path / self.dt)
        self.done.hold -= self.dt * energy.on_held(contact.nodes, mean)
        self.done.rub.add(self.dt, energy.friction_of(end, mean), path / self.dt)
        self.contact, self.served = force, self.served + 1
        return mean


class LongSteps:
    """The long step under way, and how long the next one may be."""

    def __init__(self, longest: int, dt: float):
        """At most ``longest`` windows of ``dt`` [s] in one step; 0: never more than one, whatever their length."""
        self._longest, self._windows, self._wait = longest, min(2, longest), 0
        self._longest_time = longest * dt
        self.under_way: LongStep | None = None

    def __copy__(self) -> LongSteps:
        """A copy with books of its own, see `memory.remember`."""
        new = object.__new__(LongSteps)
        new.__dict__.update(vars(self))
        if self.under_way is not None:
            new.under_way = replace(self.under_way, done=deepcopy(self.under_way.done))
        return new

    def set_window(self, dt: float) -> None:
        """Windows last ``dt`` [s] from now on; the longest step lasts as long as before."""
        self._longest = max(1, round(self._longest_time / dt))
        self._windows = min(2, self._longest)

    def interrupt(self) -> None:
        """After a failure: first windows of their own, then short steps."""
        self._wait, self._windows = QUIET, min(2, self._longest)

    def take(self, engine: Engine, t: float, dt: float, state: State, contact: EdgeContact) -> LongStep | None:
        """A new step from time t, unless it is not yet time for one or the step is refused."""
        if self._wait > 0 or self._longest <= 1:
            self._wait -= 1
            return None
        step = self._tried(engine, t, dt, state, contact)
        if step is None or step.error > LONG_STEP_ERROR * engine.ice.h:
            self._wait, self._windows = self._windows, max(self._windows // 2, 2)
            return None
        start = contact.evaluate(t, edge_displacement(state, contact.nodes, lever_of(contact)))[0]
        self.under_way = LongStep(step, dt, self._windows, contact=start)
        self._windows = min(2 * self._windows, self._longest)
        return self.under_way

    def _tried(self, engine: Engine, t: float, dt: float, state: State, contact: EdgeContact) -> Step | None:
        """The step, if its contact finds an equilibrium."""
        try:
            return engine.step(t, self._windows * dt, state, *total((), engine.grid.nodes), contact)
        except StepError:
            return None

    def drop(self, energy: EnergyBooks, dt: float, state: State, live: BoolArray, present: BoolArray) -> None:
        """Gives up the rest of a step: the sheet goes on from the last window served, whose end is ``state``."""
        if (plan := self.under_way) is None:
            return
        states = [plan.at(k) for k in range(plan.served + 1)]
        loss = [energy.loss_rate(s, live, present) for s in states]
        hold = [energy.holding(s.u, s.u_dot, np.zeros_like(s.u), live) for s in states]
        plan.done.damping = dt * (sum(loss) - 0.5 * (loss[0] + loss[-1]))
        plan.done.hold += dt * (sum(hold) - 0.5 * (hold[0] + hold[-1]))
        energy.book_served(plan.done, state, live, present)
        self.under_way, self._windows = None, min(2, self._longest)
