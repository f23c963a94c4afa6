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
    cell_dof,
    foundation,
    in_plane_mass,
    in_plane_springs,
    out_of_plane_mass,
    out_of_plane_springs,
)
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.linear import CrackedSystem
from lattice.memory import Memory, remember
from lattice.springs import sparse_rows
from lattice.stiffness import Springs

GAMMA = 1.0 - np.sqrt(0.5)
LEVER = [1, 2, 0]  #: out-of-plane degrees of freedom that move a point above the node in x, y and z
CLOSED = 1e-12  #: displacement below which a contact that hardly touches counts as solved [m]


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
    height: Array  #: (m,) of the points of action above the middle of the sheet, constant within a window [m]

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:
        """Force at the point of action of each node and its derivative.

        ``y`` (m, 3) is the `point_displacement` [m]; returns the force (m, 3) [N] and the tangent (m, 3, 3) [N/m].
        """
        ...


class NoContact:
    """An edge that touches nothing."""

    nodes = np.empty(0, np.int64)
    height = np.empty(0)

    def evaluate(self, t: float, y: Array) -> tuple[Array, Array]:
        return np.empty((0, 3)), np.empty((0, 3, 3))


def point_displacement(u: Array, q: Array, nodes: IntArray, height: Array) -> Array:
    """u_x + z phi_x, u_y + z phi_y, w of the points of nodes at height z above the middle, (m, 3); also of velocities.

    A force F at such a point does work on these, so it acts on the node as F with the moments z F_x on phi_x and
    z F_y on phi_y.
    """
    y = np.column_stack((u[nodes], q[nodes, 0]))
    y[:, :2] += height[:, None] * q[nodes, 1:]
    return y


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
    height: Array  #: (m,) at which the contact acts [m]

    @property
    def state(self) -> State:
        """State at the end: the scheme is stiffly accurate."""
        return self.stages[1].state

    @property
    def contact_mean(self) -> Array:
        """Contact force, mean over the step, (m, 3) [N]."""
        return (1.0 - GAMMA) * self.stages[0].contact + GAMMA * self.stages[1].contact

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
        return 0.040 * self.dt**2 * jump / (1.0 - GAMMA)

    def at(self, share: float) -> State:
        """State inside the step by cubic Hermite interpolation, 0 <= share <= 1."""
        if share >= 1.0:
            return self.state
        s, r, dt, a, b = share, 1.0 - share, self.dt, self.start, self.state

        def blend(x0: Array, v0: Array, x1: Array, v1: Array) -> tuple[Array, Array]:
            x = r * r * (1 + 2 * s) * x0 + s * s * (3 - 2 * s) * x1 + dt * s * r * (r * v0 - s * v1)
            return x, 6 * s * r * (x1 - x0) / dt + r * (1 - 3 * s) * v0 + s * (3 * s - 2) * v1

        u, u_dot = blend(a.u, a.u_dot, b.u, b.u_dot)
        q, q_dot = blend(a.q, a.q_dot, b.q, b.q_dot)
        return State(u, q, u_dot, q_dot)


class Engine:
    """Time integration of a sheet that loses cells. Factorisations are kept for every step length in use."""

    _written: tuple[str, ...] = ("_intact", "_systems")  #: see `memory.remember`

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        *,
        held_in_plane: np.ndarray,
        damping: float = 0.0,
        alpha: float = 0.0,
    ):
        """``held_in_plane`` (nodes,) nodes held in x and y, or (nodes, 2) each direction on its own.

        ``damping`` is the hydrodynamic damping per area [N s/m3], ``alpha`` the material damping [s] (2.27).
        """
        self.grid, self.ice, self.alpha = grid, ice, alpha
        self.M_u, self.M_q = in_plane_mass(grid, ice), out_of_plane_mass(grid, ice)
        self.C_q, self.k_f = foundation(grid, damping), foundation(grid, ice.k_f)
        self.rows_u, self.rows_q = in_plane_springs(springs), out_of_plane_springs(springs, grid.d)
        self.sparse_u, self.sparse_q = sparse_rows(self.rows_u), sparse_rows(self.rows_q)
        self.dof_u, self.dof_q = cell_dof(grid, 2), cell_dof(grid, 3)
        self._held = np.broadcast_to(held_in_plane.reshape(grid.nodes, -1), (grid.nodes, 2)).ravel()
        self._intact = np.ones(grid.cells, bool)
        self._systems: dict[float, tuple[CrackedSystem, CrackedSystem]] = {}

    @property
    def held_x(self) -> np.ndarray:
        """In-plane dof that are held along x, (2 nodes,)."""
        return np.asarray(self._held & (np.arange(2 * self.grid.nodes) % 2 == 0))

    def use(self, dt: float) -> None:
        """Makes the systems of this step length the present ones."""
        a = self._a = GAMMA * dt
        if dt not in self._systems:
            scale = 1.0 + self.alpha / a
            self._systems[dt] = (
                CrackedSystem(self.grid, self.rows_u, self._intact, self.M_u / a**2, scale, self._held),
                CrackedSystem(
                    self.grid,
                    self.rows_q,
                    self._intact,
                    self.M_q / a**2 + self.C_q / a + self.k_f,
                    scale,
                    np.zeros(3 * self.grid.nodes, bool),
                ),
            )
        self._in, self._out = self._systems[dt]

    def save(self) -> Memory:
        """What `memory.recall` sets back. A system that is first used later is made anew then."""
        systems = [s for pair in self._systems.values() for s in pair]
        return [*remember(self, *self._written), *(m for s in systems for m in s.save())]

    def remove(self, cells: IntArray) -> None:
        """Takes failed cells out of all systems (thesis 4.2.1: springs go, mass stays)."""
        self._intact[cells] = False
        for pair in self._systems.values():
            for system in pair:
                system.remove(cells)

    def equilibrium(self, force_u: Array, force_q: Array) -> State:
        """State of rest under constant forces (n, 2), (n, 3); a floe that nothing holds stays where it is in plane."""
        g, n = self.grid, self.grid.nodes
        supported = np.zeros(3 * n, bool)
        q = CrackedSystem(g, self.rows_q, self._intact, self.k_f, 1.0, supported).solve(force_q.ravel())
        u = np.zeros(2 * n)
        if self._held.any():
            u = CrackedSystem(g, self.rows_u, self._intact, np.zeros(2 * n), 1.0, self._held).solve(force_u.ravel())
        return State(u.reshape(n, 2), q.reshape(n, 3), np.zeros((n, 2)), np.zeros((n, 3)))

    def step(self, t: float, dt: float, state: State, force_u: Array, force_q: Array, contact: EdgeContact) -> Step:
        """One step from time t. ``force_u`` (n, 2) and ``force_q`` (n, 3) are constant external forces.

        Displacements are relative to the frame that drifts with the ice.
        """
        self.use(dt)
        first = self._euler(t + self._a, state, force_u, force_q, contact)
        back, s1 = (1.0 - GAMMA) * dt, first.state
        start = State(
            state.u + back * s1.u_dot,
            state.q + back * s1.q_dot,
            state.u_dot + back * first.u_acc,
            state.q_dot + back * first.q_acc,
        )
        return Step(dt, state, (first, self._euler(t + dt, start, force_u, force_q, contact)), contact.height)

    def _euler(self, t: float, s: State, force_u: Array, force_q: Array, contact: EdgeContact) -> Stage:
        """Backward Euler over a: (M/a^2 + C/a + K) x = f + M (x_0/a^2 + v_0/a) + C x_0 / a."""
        a, n = self._a, contact.nodes
        b_u = force_u.ravel() + self.M_u * (s.u.ravel() / a**2 + s.u_dot.ravel() / a)
        b_q = force_q.ravel() + self.M_q * (s.q.ravel() / a**2 + s.q_dot.ravel() / a) + self.C_q * s.q.ravel() / a
        if self.alpha:
            b_u = b_u + self.alpha / a * self._in.spring_force(s.u.ravel())
            b_q = b_q + self.alpha / a * self._out.spring_force(s.q.ravel())
        u, q = self._in.solve(b_u).reshape(-1, 2), self._out.solve(b_q).reshape(-1, 3)
        z = contact.height
        f = self._contact_force(t, point_displacement(u, q, n, z), contact) if len(n) else np.zeros((0, 3))
        if f.any():
            u = u + self._in.response(_dof_u(n), f[:, :2].ravel()).reshape(-1, 2)
            q = q + self._out.response(*_out_of_plane(n, z, f)).reshape(-1, 3)
        u_dot, q_dot = (u - s.u) / a, (q - s.q) / a
        return Stage(State(u, q, u_dot, q_dot), (u_dot - s.u_dot) / a, (q_dot - s.q_dot) / a, f)

    def _contact_force(self, t: float, free: Array, contact: EdgeContact) -> Array:
        """Newton iteration on the edge: y = y_free + G f(y) with G the compliance of the points of action."""
        f, tangent = contact.evaluate(t, free)
        if not f.any() and not tangent.any():
            return f
        m, G = len(free), self._compliance(contact.nodes, contact.height)
        y, residual = free.copy(), -np.einsum("iajb,jb->ia", G, f)
        for _ in range(100):
            J = np.eye(3 * m) - np.einsum("iajb,jbc->iajc", G, tangent).reshape(3 * m, 3 * m)
            way, old = -la.solve(J, residual.ravel()).reshape(m, 3), np.linalg.norm(residual)
            for halving in range(12):  # a contact that opens or crushes makes the full step overshoot
                trial = y + 0.5**halving * way
                f, tangent = contact.evaluate(t, trial)
                residual = trial - free - np.einsum("iajb,jb->ia", G, f)
                if np.linalg.norm(residual) < (1.0 - 0.1 * 0.5**halving) * old:
                    break
            y = trial
            if np.linalg.norm(residual) <= 1e-10 * np.linalg.norm(y - free) + CLOSED:
                return f
        raise StepError(f"contact of the sheet's edge found no equilibrium at t = {t:.4f} s: use a shorter window")

    def _compliance(self, n: IntArray, z: Array) -> Array:
        """Of the points at height z (m,) of nodes n (m,), (m, 3, m, 3) [m/N]: T C T^T with y = T x, of both systems."""
        m = len(n)
        G = np.zeros((m, 3, m, 3))
        G[:, :2, :, :2] = self._in.compliance(_dof_u(n)).reshape(m, 2, m, 2)
        if not z.any():
            G[:, 2, :, 2] = self._out.compliance(_dof_w(n))
            return G
        C = self._out.compliance(_dof_q(n)).reshape(m, 3, m, 3)[:, LEVER][:, :, :, LEVER]
        arm = np.column_stack((z, z, np.ones(m)))
        return G + arm[:, :, None, None] * C * arm


def _out_of_plane(n: IntArray, z: Array, f: Array) -> tuple[IntArray, Array]:
    """Out-of-plane degrees of freedom on which forces (m, 3) at height z act, and what acts on them [N], [N m]."""
    if not z.any():
        return _dof_w(n), f[:, 2]
    return _dof_q(n), np.column_stack((f[:, 2], z * f[:, 0], z * f[:, 1])).ravel()


def _dof_u(nodes: IntArray) -> IntArray:
    return (2 * nodes[:, None] + np.arange(2)).ravel()


def _dof_w(nodes: IntArray) -> IntArray:
    return 3 * nodes


def _dof_q(nodes: IntArray) -> IntArray:
    return (3 * nodes[:, None] + np.arange(3)).ravel()
