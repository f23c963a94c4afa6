"""The edge of the sheet in one stage of a step: contact forces that agree with the displacements that they cause.

The lattice answers linearly, y = y_free + G f with G the compliance of the points of action, and Newton's iteration
finds the force f(y) of the contact law on them.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from lattice.contact import EdgeContact, Lever, point_displacement
from lattice.grid import Array, IntArray
from lattice.implicit.linear import CrackedSystem
from lattice.state import StepError

LEVER = [1, 2, 0]  #: out-of-plane degrees of freedom that move a point above the node in x, y and z
#: displacement below which a contact that hardly touches counts as solved, as share of the length of the sheet: what
#: double precision leaves of positions; for 165 m and 3 GN/m (E / d of the ice times the width of a cell) 3 mN [-]
CLOSED = 6e-15
SOLVED = 1e-10  #: largest residual, as a share of what the contact moves the edge [-]
NEWTON, HALVINGS = 100, 12  #: iterations before the step is given up; halvings of one that overshoots


class Edge:
    """Points at the end of levers on nodes (m,), in the two systems of a sheet."""

    def __init__(self, systems: tuple[CrackedSystem, CrackedSystem], nodes: IntArray, lever: Lever, length: float):
        """In the plane and out of it; ``length`` of the sheet [m]."""
        (self._in, self._out), self._lever, self._closed = systems, lever, CLOSED * length
        self._flat = lever.none
        self._u_dof = (2 * nodes[:, None] + np.arange(2)).ravel()
        self._q_dof = 3 * nodes if self._flat else (3 * nodes[:, None] + np.arange(3)).ravel()

    def force(self, t: float, free: Array, contact: EdgeContact) -> Array:
        """Contact force (m, 3) [N] at time t of points that would move by ``free`` (m, 3) [m] without it."""
        f, tangent = contact.evaluate(t, free)
        if not f.any() and not tangent.any():
            return f
        m, G = len(free), self.compliance()
        y, residual = free.copy(), -np.einsum("iajb,jb->ia", G, f)
        for _ in range(NEWTON):
            J = np.eye(3 * m) - np.einsum("iajb,jbc->iajc", G, tangent).reshape(3 * m, 3 * m)
            correction, old = -la.solve(J, residual.ravel()).reshape(m, 3), np.linalg.norm(residual)
            for halving in range(HALVINGS):  # a contact that opens or crushes makes the full step overshoot
                trial = y + 0.5**halving * correction
                f, tangent = contact.evaluate(t, trial)
                residual = trial - free - np.einsum("iajb,jb->ia", G, f)
                if np.linalg.norm(residual) < (1.0 - 0.1 * 0.5**halving) * old:
                    break
            y = trial
            if np.linalg.norm(residual) <= SOLVED * np.linalg.norm(y - free) + self._closed:
                return f
        raise StepError("the contact of the sheet's edge finds no equilibrium")

    def free(self, u: Array, q: Array) -> Array:
        """How the points move, (m, 3) [m], by half solutions of both systems."""
        u, q = self._in.at(self._u_dof, u).reshape(-1, 2), self._out.at(self._q_dof, q)
        if self._flat:
            return np.column_stack((u, q))
        return point_displacement(u, q.reshape(-1, 3), np.arange(len(u)), self._lever)

    def push(self, f: Array, u: Array, q: Array) -> None:
        """Adds forces (m, 3) at the points to half solutions of both systems."""
        self._in.add(self._u_dof, f[:, :2].ravel(), u)
        self._out.add(self._q_dof, f[:, 2] if self._flat else self._on_node(f).ravel(), q)

    def compliance(self) -> Array:
        """Of the points, (m, 3, m, 3) [m/N]: T C T^T with y = T x, of both systems."""
        z, lead = self._lever
        m = len(z)
        G = np.zeros((m, 3, m, 3))
        G[:, :2, :, :2] = self._in.compliance(self._u_dof).reshape(m, 2, m, 2)
        if self._flat:
            G[:, 2, :, 2] = self._out.compliance(self._q_dof)
            return G
        C = self._out.compliance(self._q_dof).reshape(m, 3, m, 3)[:, LEVER][:, :, :, LEVER]
        arm = np.column_stack((z, z, np.ones(m)))
        if not lead.any():
            return np.asarray(G + arm[:, :, None, None] * C * arm)
        T = arm[:, :, None] * np.eye(3)
        T[:, 2, 0] = -lead
        return np.asarray(G + np.einsum("iab,ibjc,jdc->iajd", T, C, T, optimize=True))

    def _on_node(self, f: Array) -> Array:
        """Forces (m, 3) at the points as they act on w, phi_x and phi_y of the nodes, (m, 3) [N], [N m]."""
        z, lead = self._lever
        out = np.column_stack((f[:, 2], z * f[:, 0], z * f[:, 1]))
        if lead.any():
            out[:, 1] -= lead * f[:, 2]
        return out
