"""Implicit dynamics of the sheet between two failures.

The sheet obeys M a + C v + K x = f(t, x): lumped mass, hydrodynamic damping on w and stiffness-proportional material
damping (2.27)-(2.33), springs and Kelvin foundation, with external forces and the nonlinear contact of its edge.

Scheme: SDIRK2 of Alexander (SIAM J. Numer. Anal. 14, 1977), gamma = 1 - 1/sqrt(2): second order, L-stable, one-step,
and it never evaluates the forces at the start of a step. A sheet that has just lost a cell is out of equilibrium
there; the scheme ignores fast waves and finds the new equilibrium of all motions shorter than the step, which is what
"quasi-static" crack propagation means here. Both stages are backward Euler steps of length a = gamma dt, so one
factorisation of M/a^2 + C/a + K serves them both.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.linalg as la

from lattice.assembly import (
    foundation,
    in_plane_mass,
    in_plane_springs,
    out_of_plane_mass,
    out_of_plane_springs,
)
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.linear import CrackedSystem
from lattice.stiffness import Springs

GAMMA = 1.0 - np.sqrt(0.5)


class StepError(RuntimeError):
    """A step that found no solution."""


@dataclass
class State:
    """Displacements and velocities of all nodes."""

    u: Array  #: (n, 2) u_x, u_y [m]
    q: Array  #: (n, 3) w [m], phi_x, phi_y [rad]
    u_dot: Array  #: (n, 2) [m/s]
    q_dot: Array  #: (n, 3) [m/s], [rad/s]

    @classmethod
    def rest(cls, nodes: int) -> State:
        return cls(np.zeros((nodes, 2)), np.zeros((nodes, 3)), np.zeros((nodes, 2)), np.zeros((nodes, 3)))

    def copy(self) -> State:
        return State(self.u.copy(), self.q.copy(), self.u_dot.copy(), self.q_dot.copy())


class EdgeContact(Protocol):
    """Contact law of edge nodes with something outside the lattice."""

    nodes: IntArray  #: (m,) nodes that may touch

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:
        """Force on each node and its derivative.

        ``y`` (m, 3) holds u_x, u_y, w [m]; returns the force (m, 3) [N] and the tangent (m, 3, 3) [N/m].
        """
        ...


class NoContact:
    """An edge that touches nothing."""

    nodes = np.empty(0, np.int64)

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:
        return np.empty((0, 3)), np.empty((0, 3, 3))


@dataclass(frozen=True)
class Step:
    """Result of one step: the new state and the contact force, mean over the step and at its end, (m, 3) [N]."""

    state: State
    contact_mean: Array
    contact_end: Array


class Engine:
    """Time integration of a sheet that loses cells, with a constant step."""

    def __init__(self, grid: Grid, ice: Ice, springs: Springs, dt: float, *, intact: np.ndarray,
                 held_in_plane: np.ndarray, damping: float = 0.0, alpha: float = 0.0):
        """``damping`` is the hydrodynamic damping per area [N s/m3], ``alpha`` the material damping [s] (2.27)."""
        self.grid, self.ice, self.dt = grid, ice, dt
        self.M_u, self.M_q = in_plane_mass(grid, ice), out_of_plane_mass(grid, ice)
        self.C_q, self.k_f = foundation(grid, damping), foundation(grid, ice.k_f)
        self.rows_u, self.rows_q = in_plane_springs(springs), out_of_plane_springs(springs, grid.d)
        self.alpha, self._a = alpha, GAMMA * dt
        scale = 1.0 + alpha / self._a
        held_u = np.repeat(held_in_plane, 2)
        self._in = CrackedSystem(grid, self.rows_u, intact, self.M_u / self._a**2, scale, held_u)
        diagonal = self.M_q / self._a**2 + self.C_q / self._a + self.k_f
        self._out = CrackedSystem(grid, self.rows_q, intact, diagonal, scale, np.zeros(3 * grid.nodes, bool))

    def remove(self, cells: IntArray) -> None:
        """Takes failed cells out of both systems (thesis 4.2.1: springs go, mass stays)."""
        self._in.remove(cells)
        self._out.remove(cells)

    def point_stiffness(self, nodes: IntArray) -> list[tuple[float, float]]:
        """Force per displacement of single nodes in x and z, for motions of the length of a stage [N/m]."""
        x = np.diagonal(self._in.compliance(_dof_u(nodes)))[::2]
        z = np.diagonal(self._out.compliance(_dof_w(nodes)))
        return [(1.0 / max(float(a), 1e-15), 1.0 / float(b)) for a, b in zip(x, z, strict=True)]

    def step(self, t: float, state: State, force_u: Array, force_q: Array, contact: EdgeContact) -> Step:
        """One step from time t. ``force_u`` (n, 2) and ``force_q`` (n, 3) are constant external forces.

        Displacements are relative to the frame that drifts with the ice.
        """
        dt, a = self.dt, self._a
        s1, f1 = self._euler(t + a, state, force_u, force_q, contact)
        back = (1.0 - GAMMA) * dt
        start = State(state.u + back * s1.u_dot, state.q + back * s1.q_dot,
                      state.u_dot + back * (s1.u_dot - state.u_dot) / a,
                      state.q_dot + back * (s1.q_dot - state.q_dot) / a)
        s2, f2 = self._euler(t + dt, start, force_u, force_q, contact)
        return Step(s2, (1.0 - GAMMA) * f1 + GAMMA * f2, f2)

    def _euler(self, t: float, s: State, force_u: Array, force_q: Array, contact: EdgeContact) -> tuple[State, Array]:
        """Backward Euler over a: (M/a^2 + C/a + K) x = f + M (x_0/a^2 + v_0/a) + C x_0 / a."""
        a, n = self._a, contact.nodes
        b_u = force_u.ravel() + self.M_u * (s.u.ravel() / a**2 + s.u_dot.ravel() / a)
        b_q = force_q.ravel() + self.M_q * (s.q.ravel() / a**2 + s.q_dot.ravel() / a) + self.C_q * s.q.ravel() / a
        if self.alpha:
            b_u = b_u + self.alpha / a * self._in.spring_force(s.u.ravel())
            b_q = b_q + self.alpha / a * self._out.spring_force(s.q.ravel())
        u, q = self._in.solve(b_u).reshape(-1, 2), self._out.solve(b_q).reshape(-1, 3)
        f = self._contact_force(t, np.column_stack((u[n], q[n, 0])), contact) if len(n) else np.zeros((0, 3))
        if f.any():
            u = u + self._in.response(_dof_u(n), f[:, :2].ravel()).reshape(-1, 2)
            q = q + self._out.response(_dof_w(n), f[:, 2]).reshape(-1, 3)
        return State(u, q, (u - s.u) / a, (q - s.q) / a), f

    def _contact_force(self, t: float, free: Array, contact: EdgeContact) -> Array:
        """Newton iteration on the edge: y = y_free + G f(y) with G the compliance of the edge nodes."""
        f, tangent = contact.evaluate(t, free)
        if not f.any() and not tangent.any():
            return f
        m, n = len(free), contact.nodes
        G = np.zeros((m, 3, m, 3))
        G[:, :2, :, :2] = self._in.compliance(_dof_u(n)).reshape(m, 2, m, 2)
        G[:, 2, :, 2] = self._out.compliance(_dof_w(n))
        y = free.copy()
        for _ in range(50):
            residual = y - free - np.einsum("iajb,jb->ia", G, f)
            J = np.eye(3 * m) - np.einsum("iajb,jbc->iajc", G, tangent).reshape(3 * m, 3 * m)
            y = y - la.solve(J, residual.ravel()).reshape(m, 3)
            old, (f, tangent) = f, contact.evaluate(t, y)
            if np.abs(f - old).max() <= 1e-9 * max(np.abs(f).max(), 1.0):
                return f
        raise StepError(f"contact of the sheet's edge found no equilibrium at t = {t:.4f} s: use a shorter window")


def _dof_u(nodes: IntArray) -> IntArray:
    return (2 * nodes[:, None] + np.arange(2)).ravel()


def _dof_w(nodes: IntArray) -> IntArray:
    return 3 * nodes
