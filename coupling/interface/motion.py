"""How a structure moves: what a model of its motion has to give, and the path that ice sees in a window.

A motion is that of the structure's waterline point, which lies at the origin when the structure rests: displacement
(6,) = surge, sway, heave [m] and roll, pitch, yaw [rad] along and about x, y, z (right-handed; a positive pitch moves
what is above water along +x), and its velocity (6,). Loads are forces of the ice [N] and their moments about the
waterline point where it is [N m], (6,).

In a window the ice meets the structure on a straight `Path` from where it is to where it is expected; at its end the
mean load of the window tells where it has got to (`coupling.moving`).
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from coupling.interface.exchange import Restore
from coupling.interface.units import Array

#: names of the degrees of freedom, in their order
FREEDOMS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


class Path:
    """Where the structure is in the window under way; every participant that meets it reads the same one."""

    def __init__(self) -> None:
        self.begin = 0.0  #: of the window [s]
        self.start, self.velocity = np.zeros(6), np.zeros(6)  #: displacement then, and velocity over the window

    def go(self, t: float, start: Array, end: Array, window: float) -> None:
        """The window from ``t`` on, so long [s], leads from ``start`` (6,) to ``end`` (6,)."""
        self.begin, self.start, self.velocity = t, start.copy(), (end - start) / window

    def at(self, t: float) -> Array:
        """Displacement at time t [s], (6,)."""
        return self.start + self.velocity * (t - self.begin)


class Motion(Protocol):
    """A model of the structure's motion; `coupling.structure` has some. Windows come one after the other."""

    @property
    def displacement(self) -> Array:
        """Now, (6,). Not to be written to."""
        ...

    @property
    def velocity(self) -> Array:
        """Now, (6,) [m/s], [rad/s]. Not to be written to."""
        ...

    @property
    def energy(self) -> dict[str, float]:
        """Books since the start [J]: ``structure_kinetic``, ``structure_elastic`` and ``structure_damping_loss``.

        Where something drives the structure, also ``structure_drive_work``, what that puts in. Empty: it keeps none.
        """
        ...

    def after(self, t: float, window: float, load: Array) -> Array:
        """Displacement (6,) after a window of so many seconds from t on under a constant load (6,); nothing moves."""
        ...

    def advance(self, t: float, window: float, load: Array) -> None:
        """Moves on by this window."""
        ...

    def save(self) -> Restore:
        """The motion between two windows; see `Restore`."""
        ...
