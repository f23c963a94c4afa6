"""One step of the implicit engine: its two stages, what follows from them, and the state inside it.

Scheme: SDIRK2 of Alexander (SIAM J. Numer. Anal. 14, 1977), gamma = 1 - 1/sqrt(2): second order, L-stable, one-step,
and it never evaluates the forces at the start of a step. A sheet that has just lost a cell is out of equilibrium
there; the scheme ignores fast waves and finds the new equilibrium of all motions shorter than the step, which is what
"quasi-static" crack propagation means here. Both stages are backward Euler steps of length a = gamma dt, so one
factorisation of M/a^2 + C/a + K serves them both.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.contact import Lever
from lattice.grid import Array
from lattice.state import State

GAMMA = 1.0 - np.sqrt(0.5)


@dataclass(frozen=True)
class Stage:
    """One stage of a step: state, acceleration and contact force (m, 3) at its time."""

    state: State
    u_acc: Array  #: (n, 2) [m/s2]
    q_acc: Array  #: (n, 3) [m/s2], [rad/s2]
    contact: Array  #: (m, 3) [N]


@dataclass(frozen=True)
class Step:
    """Result of one step of length dt [s]."""

    dt: float
    start: State
    stages: tuple[Stage, Stage]
    lever: Lever  #: at the end of which the contact acts

    @property
    def state(self) -> State:
        """State at the end: the scheme is stiffly accurate."""
        return self.stages[1].state

    @property
    def contact_mean(self) -> Array:
        """Contact force, mean over the step, (m, 3) [N]."""
        return np.asarray((1.0 - GAMMA) * self.stages[0].contact + GAMMA * self.stages[1].contact)

    @property
    def contact_end(self) -> Array:
        """Contact force at the end of the step, (m, 3) [N]."""
        return self.stages[1].contact

    @property
    def error(self) -> float:
        """Estimate of the largest local error of a displacement [m].

        The error of the scheme is 0.040 dt^3 times the third derivative (error constant 1/6 - sum b_i a_ij c_j), and
        that comes from the accelerations of the stages, (1 - gamma) dt apart.
        """
        a, b = self.stages
        jump = max(float(np.abs(b.u_acc - a.u_acc).max()), float(np.abs(b.q_acc[:, 0] - a.q_acc[:, 0]).max()))
        return float(0.040 * self.dt**2 * jump / (1.0 - GAMMA))

    def at(self, part: float) -> State:
        """State after this part of the step, 0 to 1, by cubic Hermite interpolation."""
        if part >= 1.0:
            return self.state
        s, r, dt, a, b = part, 1.0 - part, self.dt, self.start, self.state

        def blend(x0: Array, v0: Array, x1: Array, v1: Array) -> tuple[Array, Array]:
            x = r * r * (1 + 2 * s) * x0 + s * s * (3 - 2 * s) * x1 + dt * s * r * (r * v0 - s * v1)
            return x, 6 * s * r * (x1 - x0) / dt + r * (1 - 3 * s) * v0 + s * (3 * s - 2) * v1

        u, u_dot = blend(a.u, a.u_dot, b.u, b.u_dot)
        q, q_dot = blend(a.q, a.q_dot, b.q, b.q_dot)
        return State(u, q, u_dot, q_dot)
