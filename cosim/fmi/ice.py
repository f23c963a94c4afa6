"""The ice as a participant of other simulations: it is given the motion of the structure, and gives the load."""

from __future__ import annotations

from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.fmi.names import BY_PHASE, LOAD
from cosim.scenario.scenario import Scenario
from coupling.attack import point_forces
from coupling.interface import NS, Array, Frame, Restore, SimulationError


class Given:
    """A motion that is given from outside, a `coupling.interface.Motion`: over a step it goes on as it is told."""

    def __init__(self) -> None:
        self.displacement, self.velocity = np.zeros(6), np.zeros(6)
        self.energy: dict[str, float] = {}

    def after(self, t: float, window: float, load: Array) -> Array:  # noqa: ARG002 - it answers to nobody here
        """As `Motion.after`."""
        return np.asarray(self.displacement + window * self.velocity)

    def advance(self, t: float, window: float, load: Array) -> None:
        """As `Motion.advance`."""
        self.displacement = self.after(t, window, load)

    def save(self) -> Restore:
        """As `Motion.save`."""
        return partial(self._set, self.displacement, self.velocity)

    def _set(self, displacement: Array, velocity: Array) -> None:
        self.displacement, self.velocity = displacement, velocity


class Refused(SimulationError):
    """A step that cannot be done and has left everything as it was."""


class Ice:
    """A case of which others move the structure, in steps of whole time windows."""

    def __init__(self, scenario: Scenario) -> None:
        """SimulationError or InputError if the case cannot be built."""
        self.given, self.window_ns = Given(), scenario.window_ns
        with threadpool_limits(1):
            self._scheduler = build(scenario, self.given)
        self._end_ns = scenario.duration_ns
        self.loads = dict.fromkeys((*LOAD, *BY_PHASE), 0.0)  #: means over the last step, by name [N], [N m]

    @property
    def t(self) -> float:
        """Now [s]."""
        return self._scheduler.t_ns / NS

    def step(self, t: float, length: float, displacement: Array, velocity: Array) -> None:
        """From ``t`` on so long [s]; the structure starts at ``displacement`` (6,) and goes with ``velocity`` (6,).

        Refused if the step is not one of whole windows from now on, SimulationError if the run cannot go on.
        """
        if not np.isfinite([t, length]).all():
            raise Refused(f"a step from {t:g} s of {length:g} s")
        windows, rest = divmod(round(length * NS), self.window_ns)
        if rest or windows < 1:
            raise Refused(f"a step of {length:g} s is no whole number of windows of {self.window_ns / NS:g} s")
        if round(t * NS) != self._scheduler.t_ns:
            raise Refused(f"a step from {t:g} s, but the ice is at {self.t:g} s: go on from there")
        if self._scheduler.t_ns + round(length * NS) > self._end_ns:
            raise Refused(f"the case ends at {self._end_ns / NS:g} s: raise scenario.duration")
        if not (np.isfinite(displacement).all() and np.isfinite(velocity).all()):
            raise Refused(f"t = {t:g} s: the motion of the structure is not finite")
        self.given._set(np.array(displacement, np.float64), np.array(velocity, np.float64))
        total = np.zeros((3, 6))
        with threadpool_limits(1):
            for _ in range(windows):
                total += _loads(self._scheduler.macro_step()) / windows
        self.loads = dict(zip(LOAD, total.sum(axis=0).tolist(), strict=True))
        self.loads |= dict(zip(BY_PHASE, total.ravel().tolist(), strict=True))

    def save(self) -> Restore:
        """The case between two steps; see `Restore`."""
        back, loads = self._scheduler.checkpoint(), self.loads

        def restore() -> None:
            back()
            self.loads = loads

        return restore


def _loads(frame: Frame) -> Array:
    """Forces and moments of a window (3, 6): rows by `Phase`."""
    assert frame.motion is not None
    forces = point_forces(frame.contact, frame.blocks)
    return np.hstack((frame.load, forces.moments(frame.motion[0, :3])))
