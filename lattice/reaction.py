"""What carries the sheet: the sum over its nodes of the forces that are neither contact nor springs.

Springs cancel in the sum over all nodes, so that for the contact f_c and other external forces f_e

    -sum f_c = sum f_e - sum (k_f w + C w' + M a) + R,

with R the reaction of held nodes in x. Means over a window follow from the scheme without further error: a step of
SDIRK2 has the weights b of its stages for k_f w and R, and x_1 - x_0 and v_1 - v_0 for C w' and M a, because it is
stiffly accurate. A window that is read off the interpolation of a long step has the exact means of the interpolation,
while its contact is the mean of its two ends: the sum is then off by the error of the long step.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array, BoolArray, IntArray
from lattice.implicit.engine import Engine
from lattice.implicit.step import GAMMA, Step
from lattice.loads import Loads
from lattice.springs import spring_force
from lattice.state import State

Pair = tuple[float, float]  #: along x and z [N]


class Mean(NamedTuple):
    """Mean of a displacement over a window: weighted states, plus ``slope`` [s] times velocity of a minus that of b."""

    a: State
    b: State
    weight_a: float
    weight_b: float
    slope: float = 0.0


class Coefficients(NamedTuple):
    """Of the equation of motion, on every degree of freedom."""

    k_f: Array  #: (3 n,) foundation [N/m]
    C_q: Array  #: (3 n,) hydrodynamic damping [N s/m]
    M_q: Array  #: (3 n,) [kg], [kg m2]
    M_u: Array  #: (2 n,) [kg]


class Applied(NamedTuple):
    """Sums of external forces."""

    by_name: dict[str, Pair]  #: of each `NodeLoad`
    held: float = 0.0  #: the part along x that acts on held nodes, which pass it on at once [N]


@dataclass
class Reaction:
    """Mean forces on the sheet over a window in x and z [N]."""

    foundation: Pair = (0.0, 0.0)  #: of the water under the deflection, -k_f w
    drag: Pair = (0.0, 0.0)  #: hydrodynamic damping
    inertia: Pair = (0.0, 0.0)  #: minus mass times acceleration
    held: Pair = (0.0, 0.0)  #: of the supports, on the sheet
    applied: dict[str, Pair] = field(default_factory=dict)  #: of the other external forces, by name of `NodeLoad`


class Support:
    """The nodes that are held along x, and the cells around them."""

    def __init__(self, engine: Engine):
        grid = engine.grid
        self.engine = engine
        self.held = np.ascontiguousarray(engine.held[:, 0])
        self._cells: IntArray = np.flatnonzero(self.held[grid.cell_nodes].any(axis=1))
        self._around, local = np.unique(grid.cell_nodes[self._cells], return_inverse=True)  # nodes of these cells
        local = local.reshape(-1, 4)
        dof = (2 * local[:, :, None] + np.arange(2)).reshape(len(local), 8)
        self._springs = engine.springs_u.of_cells(self._cells, dof)
        self._reacts = np.flatnonzero(self.held[self._around])
        self.coefficients = Coefficients(engine.k_f, engine.C_q, engine.inertia_q, engine.inertia_u)

    def applied(self, loads: Loads) -> Applied:
        """Sums of constant loads."""
        sums = {load.name: (float(load.force_u[:, 0].sum()), float(load.force_q[:, 0].sum())) for load in loads}
        return Applied(sums, sum(float(load.force_u[self.held, 0].sum()) for load in loads))

    def force(self, mean: Mean, a: State, b: State, dt: float, live: BoolArray) -> float:
        """Mean force along x on the sheet, from a to b in ``dt`` [s], with elastic and material damping [N]."""
        if not len(self._reacts):
            return 0.0
        n, e = self._around, self.engine
        x = mean.weight_a * mean.a.u[n] + mean.weight_b * mean.b.u[n]
        if mean.slope:
            x += mean.slope * (mean.a.u_dot[n] - mean.b.u_dot[n])
        if e.alpha:
            x += e.alpha / dt * (b.u[n] - a.u[n])
        return float(spring_force(self._springs, live[self._cells], x.ravel())[2 * self._reacts].sum())


@compiled()
def _sums(
    mean: Mean, start: State, end: State, of: Coefficients, present: BoolArray
) -> tuple[float, float, float, float]:
    """Over the nodes that are present: k_f w, C times the path of w, mass times the gain of velocity in z and x."""
    lift = brake = up = ahead = 0.0
    a, b = mean.a, mean.b
    for n in range(len(present)):
        if present[n]:
            w = mean.weight_a * a.q[n, 0] + mean.weight_b * b.q[n, 0] + mean.slope * (a.q_dot[n, 0] - b.q_dot[n, 0])
            lift += of.k_f[3 * n] * w
            brake += of.C_q[3 * n] * (end.q[n, 0] - start.q[n, 0])
            up += of.M_q[3 * n] * (end.q_dot[n, 0] - start.q_dot[n, 0])
            ahead += of.M_u[2 * n] * (end.u_dot[n, 0] - start.u_dot[n, 0])
    return lift, brake, up, ahead


def between(
    support: Support,
    a: State,
    b: State,
    dt: float,
    mean: Mean,
    held: float,
    present: BoolArray,
    by_name: dict[str, Pair],
) -> Reaction:
    """Means over a time ``dt`` [s] in which ``present`` nodes go from a to b.

    ``held`` is the mean force of the supports along x [N], ``by_name`` are the means of the other external forces.
    """
    rows = Mean(mean.a.in_rows(), mean.b.in_rows(), mean.weight_a, mean.weight_b, mean.slope)
    lift, brake, up, ahead = _sums(rows, a.in_rows(), b.in_rows(), support.coefficients, present)
    return Reaction((0.0, -lift), (0.0, -brake / dt), (-ahead / dt, -up / dt), (held, 0.0), by_name)


def of_step(step: Step) -> Mean:
    """Mean over a step as its scheme weights it."""
    first, second = (stage.state for stage in step.stages)
    return Mean(first, second, 1.0 - float(GAMMA), float(GAMMA))


def of_cubic(a: State, b: State, dt: float) -> Mean:
    """Mean of the cubic through two states ``dt`` apart."""
    return Mean(a, b, 0.5, 0.5, dt / 12.0)
