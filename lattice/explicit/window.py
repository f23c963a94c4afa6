"""Integrals over the blocks of sub-steps of one window."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.explicit.forces import PointForces
from lattice.explicit.layout import U_X, W
from lattice.grid import Array, BoolArray, IntArray
from lattice.loads import Loads
from lattice.reaction import Applied
from lattice.state import State


@dataclass
class Window:
    """Running integrals over time."""

    start: State
    names: tuple[str, ...]  #: of the loads
    impulse: Array  #: (n, 3) of the contact [N s]
    u: Array  #: (n, 2) of the displacement [m s]
    q: Array  #: (n, 3) [m s], [rad s]
    push: Array  #: (loads, 2) impulse of each load along x and z [N s]
    held: float = 0.0  #: part of the impulse along x that acts on held nodes [N s]

    @classmethod
    def empty(cls, start: State, loads: Loads) -> Window:
        """A window that begins with this state."""
        nothing = np.zeros((len(start.q), 3)), np.zeros_like(start.u), np.zeros_like(start.q)
        return cls(start, tuple(load.name for load in loads), *nothing, np.zeros((len(loads), 2)))

    def note(
        self,
        time: float,
        before: tuple[Array, Array],
        after: tuple[Array, Array],
        load: PointForces,
        columns: int,
        held: BoolArray,
    ) -> None:
        """Adds some sub-steps that last ``time`` [s], by the trapezoidal rule; ``held`` (nodes,) along x."""
        for total, old, new in zip((self.u, self.q), before, after, strict=True):
            total += 0.5 * time * (old + new)
        on_held = held[load.row * columns + load.column]
        for k in range(len(self.names)):
            of = slice(load.first[k], load.first[k + 1])
            self.push[k] += time * np.array((load.force[of, U_X].sum(), load.force[of, W].sum()))
        self.held += time * float(load.force[on_held, U_X].sum())

    def mean(self, dt: float) -> State:
        """Mean displacement over a window of ``dt`` [s], with the velocities of its start."""
        return State(self.u / dt, self.q / dt, self.start.u_dot, self.start.q_dot)

    def contact_mean(self, dt: float, nodes: IntArray) -> tuple[Array, IntArray]:
        """Mean contact force (m, 3) [N] and its nodes (m,): these of the edge, then others that have had any."""
        mean = self.impulse / dt
        left = np.setdiff1d(np.flatnonzero(mean.any(axis=1)), nodes)
        touched = np.concatenate((nodes, left))
        return np.asarray(mean[touched]), touched

    def applied(self, dt: float) -> Applied:
        """Mean loads."""
        pairs = (self.push / dt).tolist()
        return Applied({n: (x, z) for n, (x, z) in zip(self.names, pairs, strict=True)}, float(self.held / dt))
