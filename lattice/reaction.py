"""What carries the sheet: the sum over its nodes of the forces that are neither contact nor springs.

Springs cancel in the sum over all nodes, so that for the contact f_c and other external forces f_e

    -sum f_c = sum f_e - sum (k_f w + C w' + M a) + R,

with R the reaction of held nodes in x. Means over a window follow from the scheme without further error: a step of
SDIRK2 has the weights b of its stages for k_f w and R, and x_1 - x_0 and v_1 - v_0 for C w' and M a, because it is
stiffly accurate. A window that is read off the interpolation of a long step has the exact means of the interpolation,
while its contact is the mean of its two ends: the sum is then off by the error of the long step.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.engine import GAMMA, Engine, State, Step
from lattice.grid import Array, IntArray
from lattice.springs import spring_force


class Mean(NamedTuple):
    """Mean of a displacement over a window: weighted states, plus ``slope`` [s] times velocity of a minus that of b."""

    a: State
    b: State
    weight_a: float
    weight_b: float
    slope: float = 0.0


@dataclass
class Reaction:
    """Mean forces on the sheet over a window in x and z [N]."""

    foundation: tuple[float, float] = (0.0, 0.0)  #: of the water under the deflection, -k_f w
    drag: tuple[float, float] = (0.0, 0.0)  #: hydrodynamic damping
    inertia: tuple[float, float] = (0.0, 0.0)  #: minus mass times acceleration
    held: tuple[float, float] = (0.0, 0.0)  #: of the supports, on the sheet
    applied: tuple[float, float] = (0.0, 0.0)  #: of the other external forces (the rubble's)


class Support:
    """The nodes that are held along x, and the cells around them."""

    def __init__(self, engine: Engine, held: np.ndarray):
        """``held`` (nodes,), or (nodes, 2) each direction on its own."""
        grid = engine.grid
        self.engine = engine
        self.held = np.ascontiguousarray(held.reshape(grid.nodes, -1)[:, 0])
        self._cells: IntArray = np.flatnonzero(self.held[grid.cell_nodes].any(axis=1))
        self._around, local = np.unique(grid.cell_nodes[self._cells], return_inverse=True)  # nodes of these cells
        local = local.reshape(-1, 4)
        self._dof = (2 * local[:, :, None] + np.arange(2)).reshape(len(local), 8)
        self._reacts = np.flatnonzero(self.held[self._around])

    def applied(self, nodes: IntArray | slice, force_x: Array, force_z: Array) -> tuple[float, float, float]:
        """Sums of external forces on nodes (k,): x, z, and the part of x that held nodes pass on at once [N]."""
        return float(force_x.sum()), float(force_z.sum()), float(force_x[self.held[nodes]].sum())

    def force(self, mean: Mean, a: State, b: State, dt: float, live: np.ndarray) -> float:
        """Mean force along x on the sheet, from a to b in ``dt`` [s], with elastic and material damping [N]."""
        if not len(self._reacts):
            return 0.0
        n, e = self._around, self.engine
        x = mean.weight_a * mean.a.u[n] + mean.weight_b * mean.b.u[n]
        if mean.slope:
            x += mean.slope * (mean.a.u_dot[n] - mean.b.u_dot[n])
        if e.alpha:
            x += e.alpha / dt * (b.u[n] - a.u[n])
        return float(spring_force(self._dof, *e.sparse_u, live[self._cells], x.ravel())[2 * self._reacts].sum())


@compiled()
def _sums(mean_a, mean_b, mean_va, mean_vb, weights, q_0, q_1, v_0, v_1, u_0, u_1, k_f, C_q, M_q, M_u, present):
    """Sums over the nodes that are present: k_f w, C times the way of w, mass times the gain of velocity in z and x.

    ``mean_...`` (n, 3) and ``weights`` (3,) as in `Mean`; ``q``, v = q_dot (n, 3) and u = u_dot (n, 2) at the start and
    at the end of a window.
    """
    lift = brake = up = ahead = 0.0
    for n in range(len(present)):
        if present[n]:
            w = weights[0] * mean_a[n, 0] + weights[1] * mean_b[n, 0] + weights[2] * (mean_va[n, 0] - mean_vb[n, 0])
            lift += k_f[3 * n] * w
            brake += C_q[3 * n] * (q_1[n, 0] - q_0[n, 0])
            up += M_q[3 * n] * (v_1[n, 0] - v_0[n, 0])
            ahead += M_u[2 * n] * (u_1[n, 0] - u_0[n, 0])
    return lift, brake, up, ahead


def between(
    support: Support,
    a: State,
    b: State,
    dt: float,
    mean: Mean,
    live: np.ndarray,
    present: np.ndarray,
    applied: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Reaction:
    """Means over a time ``dt`` [s] in which ``present`` nodes go from a to b; ``applied`` as in `Support`."""
    e, weights = support.engine, (mean.weight_a, mean.weight_b, mean.slope)
    lift, brake, up, ahead = _sums(
        mean.a.q,
        mean.b.q,
        mean.a.q_dot,
        mean.b.q_dot,
        weights,
        a.q,
        b.q,
        a.q_dot,
        b.q_dot,
        a.u_dot,
        b.u_dot,
        e.k_f,
        e.C_q,
        e.M_q,
        e.M_u,
        present,
    )
    held = support.force(mean, a, b, dt, live)
    return Reaction((0.0, -lift), (0.0, -brake / dt), (-ahead / dt, -up / dt), (held - applied[2], 0.0), applied[:2])


def of_step(step: Step) -> Mean:
    """Mean over a step as its scheme weights it."""
    first, second = (stage.state for stage in step.stages)
    return Mean(first, second, 1.0 - float(GAMMA), float(GAMMA))


def of_cubic(a: State, b: State, dt: float) -> Mean:
    """Mean of the cubic through two states ``dt`` apart."""
    return Mean(a, b, 0.5, 0.5, dt / 12.0)
