"""A structure that goes its own way, whatever the ice does: a ship, the carriage of a basin, a measured motion."""

from __future__ import annotations

from functools import partial

import numpy as np

from coupling.interface.exchange import Restore
from coupling.interface.units import Array


class Prescribed:
    """Displacements at times, straight lines in between; who moves the structure puts in what the ice takes."""

    def __init__(self, time: Array, displacement: Array) -> None:
        """``time`` (k,) ascending from 0 [s], ``displacement`` (k, 6), none at first. ValueError if it is no motion."""
        self._t, self._d = np.array(time, np.float64), np.array(displacement, np.float64)
        if self._t.ndim != 1 or len(self._t) < 2 or self._d.shape != (len(self._t), 6):
            raise ValueError("a prescribed motion needs two or more times, and six displacements at each")
        if not (np.isfinite(self._t).all() and np.isfinite(self._d).all()):
            raise ValueError("a prescribed motion has values that are not finite")
        if self._t[0] != 0.0 or (np.diff(self._t) <= 0.0).any():
            raise ValueError("times of a prescribed motion begin with 0 s and ascend")
        if self._d[0].any():
            raise ValueError(f"a prescribed motion begins with zeros, not with {self._d[0].tolist()}")
        self._now, self._velocity, self._driven = np.zeros(6), self._rate(0.0), 0.0

    @classmethod
    def steady(cls, velocity: Array, duration: float) -> Prescribed:
        """Constant velocity (6,) for so many seconds."""
        time = np.array([0.0, duration])
        return cls(time, np.outer(time, velocity))

    @property
    def displacement(self) -> Array:
        """As `Motion.displacement`."""
        return self._now

    @property
    def velocity(self) -> Array:
        """As `Motion.velocity`; at a corner that of the piece that begins."""
        return self._velocity

    @property
    def energy(self) -> dict[str, float]:
        """As `Motion.energy`: it stores nothing, and its drive does what the ice takes."""
        return {
            "structure_kinetic": 0.0,
            "structure_elastic": 0.0,
            "structure_damping_loss": 0.0,
            "structure_drive_work": self._driven,
        }

    def after(self, t: float, window: float, load: Array) -> Array:  # noqa: ARG002 - it gives way to nothing
        """As `Motion.after`."""
        end = t + window
        if end > self._t[-1] * (1.0 + 1e-9):
            raise ValueError(f"the prescribed motion of the structure ends at {self._t[-1]:g} s; lengthen its series")
        return np.array([np.interp(end, self._t, column) for column in self._d.T])

    def advance(self, t: float, window: float, load: Array) -> None:
        """As `Motion.advance`."""
        new = self.after(t, window, load)
        self._driven -= float(load @ (new - self._now))
        self._now, self._velocity = new, self._rate(t + window)

    def save(self) -> Restore:
        """As `Motion.save`."""
        return partial(self._restore, self._now, self._velocity, self._driven)

    def _restore(self, now: Array, velocity: Array, driven: float) -> None:
        self._now, self._velocity, self._driven = now, velocity, driven

    def _rate(self, t: float) -> Array:
        piece = int(np.clip(np.searchsorted(self._t, t, side="right") - 1, 0, len(self._t) - 2))
        return np.asarray((self._d[piece + 1] - self._d[piece]) / (self._t[piece + 1] - self._t[piece]))
