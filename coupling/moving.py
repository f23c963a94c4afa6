"""A structure that answers: third participant of every scheme, window by window.

In a window the ice meets the structure on the straight way to where the load of the window before would bring it. The
mean load of the window then tells where it is. The structure's own motion is exact for that load, so no impulse comes
late. The way that the ice saw is off by dF T^2 / 2m at its end, dF the change of the load from window to window: the
scheme is of second order in T where the load is smooth. In the next window the ice sees it go on from there, so that to
the ice it never jumps.

The ice gives F . (way that it saw), the structure takes F . (way that it went). The difference is energy that the
coupling takes or makes, and is booked. ``repeats`` go through the window again, from its start, with the way that its
own load gives: each makes the difference smaller by k T^2 / 4m, k the stiffness of the contact, for every scheme. A
block that touches, or lets go, in another sub-step makes the load of a window jump with the way; two ways may then lead
to each other's load, and no repeat ends. What such a window misses, the next one makes up for.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy

import numpy as np

from coupling.interface import NS, Array, Motion, Path, Restore, SheetReport, SimulationError
from coupling.scheduler import Scheduler, Scheme

CLOSED = 1e-12  #: part of the way of a window by which it may be missed for no repeat to follow


class WithStructure:
    """A `Scheme` whose structure moves."""

    def __init__(self, scheme: Scheme, motion: Motion, path: Path, repeats: int = 0) -> None:
        """``path`` is the one that sheet and rubble know; ``repeats`` at most, of each window."""
        self._scheme, self.motion, self._path, self._repeats = scheme, motion, path, repeats
        self._load = np.zeros(6)  #: mean over the last window [N], [N m]
        self._ahead = np.zeros(6)  #: of the structure is the place where the ice sees it [m], [rad]
        self._lost, self._exchanged, self._received = 0.0, 0.0, 0.0  #: since the start [J]

    def __call__(self, s: Scheduler) -> SheetReport:
        """One window."""
        t, window = s.t_ns / NS, s.window_ns / NS
        start, expected = self.motion.displacement.copy(), self._load
        restore = self._save(s) if self._repeats else None
        for k in range(self._repeats + 1):
            if k > 0 and restore is not None:
                restore()
            end = self._after(t, window, expected)
            self._path.go(t, start + self._ahead, end, window)
            s.rubble.set_structure(self._path.start, self._path.velocity)
            report = self._scheme(s)
            expected = _load(s, report)
            missed = np.abs(self._after(t, window, expected) - end).max()
            if missed <= CLOSED * np.abs(end - start).max():
                break
        self._load = expected
        self.motion.advance(t, window, expected)
        self._ahead = end - self.motion.displacement
        self._close(s, self.motion.displacement - start, window, k)
        return report

    def _after(self, t: float, window: float, load: Array) -> Array:
        try:
            end = self.motion.after(t, window, load)
        except ValueError as error:
            raise SimulationError(f"t = {t:.3f} s: {error}") from error
        if not np.isfinite(end).all():
            raise SimulationError(f"t = {t:.3f} s: the motion of the structure is not finite; halve coupling.window")
        return end

    def _close(self, s: Scheduler, way: Array, window: float, repeats: int) -> None:
        """Books the window: power over the interface, energy of the structure."""
        given, taken = float(self._load @ self._path.velocity), float(self._load @ way) / window
        self._lost += (given - taken) * window
        self._exchanged += max(abs(given), abs(taken)) * window
        self._received += taken * window
        own = self.motion.energy
        books = {
            "structure_power_from_ice": given,
            "structure_power_taken": taken,
            "structure_interface_lost": self._lost,
            "structure_interface_exchanged": self._exchanged,
            "structure_received": self._received,
            "structure_repeats": float(repeats),
            **own,
        }
        if own:
            spent = own["structure_kinetic"] + own["structure_elastic"] + own["structure_damping_loss"]
            books["structure_energy_residual"] = self._received + own.get("structure_drive_work", 0.0) - spent
        s.notes = {**s.notes, **books}
        s.motion = np.array([self.motion.displacement, self.motion.velocity])

    def save(self) -> Restore:
        """The structure between two windows, and what this scheme and the one inside remember."""
        motion, own = self.motion.save(), (self._load, self._ahead, self._lost, self._exchanged, self._received)
        inner = deepcopy(getattr(self._scheme, "__dict__", {}))

        def back() -> None:
            motion()
            self._load, self._ahead, self._lost, self._exchanged, self._received = own
            if inner:
                vars(self._scheme).update(deepcopy(inner))

        return back

    def _save(self, s: Scheduler) -> Callable[[], None]:
        """Participants and scheme at the start of the window; the structure itself has not moved yet."""
        restore, own = s.save(), deepcopy(getattr(self._scheme, "__dict__", {}))

        def back() -> None:
            restore()
            if own:
                vars(self._scheme).update(deepcopy(own))

        return back


def _load(s: Scheduler, report: SheetReport) -> Array:
    """Mean load of the window (6,): of the sheet and of the blocks."""
    assert report.wrench is not None, "a sheet that meets a moving structure gives its moments"
    return np.asarray(report.wrench + s.rubble.on_structure)
