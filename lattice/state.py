"""How the sheet lies and moves at one instant, and the errors of its engines."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.grid import Array


class StepError(RuntimeError):
    """A step that found no solution."""


class State(NamedTuple):
    """Displacements and velocities of all nodes, in the frame that drifts with the ice."""

    u: Array  #: (n, 2) u_x, u_y [m]
    q: Array  #: (n, 3) w [m], phi_x, phi_y [rad]
    u_dot: Array  #: (n, 2) [m/s]
    q_dot: Array  #: (n, 3) [m/s], [rad/s]

    @classmethod
    def rest(cls, nodes: int) -> State:
        """Undeformed and without motion."""
        return cls(np.zeros((nodes, 2)), np.zeros((nodes, 3)), np.zeros((nodes, 2)), np.zeros((nodes, 3)))

    def in_rows(self) -> State:
        """The same with every array in C order, as compiled loops take it."""
        return State(*(np.ascontiguousarray(a) for a in self))
