"""Sub-steps of the explicit engine between two evaluations of the contact."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array, IntArray
from lattice.kernels import A1, A2, A3, I1, overloaded, push, sweep


@dataclass
class NodeForces:
    """Forces on single nodes: constant (k, 5), or linear in the displacement where ``tangent`` is used."""

    row: IntArray  #: (k,)
    column: IntArray  #: (k,)
    force: Array  #: (k, 5) or, for a contact, (k, 3) [N], [N m]
    at: Array = field(default_factory=lambda: np.empty((0, 3)))  #: (k, 3) displacement that has this force [m]
    tangent: Array = field(default_factory=lambda: np.empty((0, 3, 3)))  #: (k, 3, 3) [N/m]
    height: Array = field(default_factory=lambda: np.empty(0))  #: (k,) of a contact above the middle [m]

    def padded(self) -> Array:
        """Forces on all five degrees of freedom, (k, 5): those of a contact with their moments about the middle."""
        if self.force.shape[1] == 5:
            return np.ascontiguousarray(self.force)
        return np.hstack((self.force, self.height[:, None] * self.force[:, :2]))


@dataclass(frozen=True)
class Marched:
    """Some sub-steps."""

    steps: int
    failed: bool  #: a cell is overloaded at the end of the last one
    contact: Array  #: mean force on the nodes of the contact, (m, 3) [N]
    contact_work: float  #: [J]
    work: float  #: of the other forces [J]
    loss: float  #: taken by hydrodynamic and material damping [J]


@compiled(f"void({I1}, {I1}, {A1}, {A2}, {A2}, {A3}, {A2}, {A3}, {A3}, float64)", nogil=True)
def contact_force(row, column, height, at, force, tangent, now, y, v, alpha):
    """Contact at ``height`` above its nodes, linear about the displacement ``at``: into ``now`` (m, 5) [N], [N m]."""
    for k in range(len(row)):
        i, j = row[k], column[k]
        now[k, :3] = force[k]
        for b in range(3):
            moved = y[b, i, j] - alpha * v[b, i, j] - at[k, b]
            if b < 2:
                moved += height[k] * (y[b + 3, i, j] - alpha * v[b + 3, i, j])
            for a in range(3):
                now[k, a] += tangent[k, a, b] * moved
        for a in range(2):
            now[k, a + 3] = height[k] * now[k, a]


@compiled(f"void({A3}, {A3}, {A3}, {A3}, {A2}, {A3}, {A1}, {A1}, {A1})", nogil=True)
def damped(v, before, y, after, intact, kick, spring, pace, rows):
    """Velocities ``after`` a sub-step in which nothing but damping acts; ``before`` becomes a copy of v."""
    before[:] = v
    after[:] = v
    y[:] = pace[0] * v
    water = pace.copy()
    water[0], water[1], water[2], water[3] = 0.0, 0.0, 0.0, pace[3] + pace[0] * pace[2]  # dt c / (rho h)
    sweep(y, after, intact, kick, spring, water, rows)


@compiled(f"float64({A3}, {A3}, {A3}, {A3})", nogil=True)
def dissipated(v, before, after, mass):
    """Work that damping took in a sub-step [J]: mass x loss of velocity x mean velocity, exact for leapfrog."""
    work = 0.0
    for i in range(mass.shape[1]):
        for j in range(mass.shape[2]):
            node = 0.0
            for c in range(5):
                part = mass[max(0, min(c - 1, 2)), i, j]
                node += part * (before[c, i, j] - after[c, i, j]) * (before[c, i, j] + v[c, i, j])
            work += 0.5 * node
    return work


@compiled(f"float64({I1}, {I1}, {A2}, {A3})", nogil=True)
def power(row, column, force, v):
    """Of forces (k, 5) on single nodes [W]."""
    total = 0.0
    for k in range(len(row)):
        for c in range(5):
            total += force[k, c] * v[c, row[k], column[k]]
    return total


MARCH = (
    f"UniTuple(int64, 2)(int64, int64, {A3}, {A3}, float64[:, :, :, ::1], {A2}, {A3}, {A3}, {A2}, {A1}, "
    f"{A1}, {A1}, {A1}, {I1}, {I1}, {A2}, {I1}, {I1}, {A1}, {A2}, {A2}, {A3}, {A2}, {A2}, {A1})"
)


@compiled(MARCH, nogil=True)
def march(
    steps,
    stride,
    y,
    v,
    scratch,
    intact,
    kick,
    mass,
    limit,
    spring,
    pace,
    crack,
    rows,
    row,
    column,
    force,
    touch_row,
    touch_column,
    height,
    at,
    touch,
    tangent,
    now,
    total,
    books,
):
    """Up to ``steps`` sub-steps; stops after the first one at whose end a cell is overloaded.

    ``force`` (k, 5) on the nodes (row, column) is constant; the contact, at ``height`` (m,), is linear about ``at``
    (m, 3) with the force ``touch`` (m, 3) and its ``tangent`` (m, 3, 3). Its forces, sub-step by sub-step, are added up
    in ``total`` (m, 3).
    Returns the sub-steps made and the number of overloaded faces. ``books`` (3,) takes the sums over the sub-steps of
    the power of the contact and of the forces [W], and of the work of damping [J] in every ``stride``-th
    one (which costs as much as a sub-step; ``scratch`` (3, 5, n_x+1, n_y+1) is for that), all exact for leapfrog.
    """
    alpha, go = pace[0], pace[1]
    for step in range(steps):
        contact_force(touch_row, touch_column, height, at, touch, tangent, now, y, v, alpha)
        total += now[:, :3]
        if step % stride == 0:
            damped(v, scratch[0], scratch[1], scratch[2], intact, kick, spring, pace, rows)
        books[0] += 0.5 * power(touch_row, touch_column, now, v)
        books[1] += 0.5 * power(row, column, force, v)
        sweep(y, v, intact, kick, spring, pace, rows)
        push(row, column, force, y, v, kick, go)
        push(touch_row, touch_column, now, y, v, kick, go)
        books[0] += 0.5 * power(touch_row, touch_column, now, v)
        books[1] += 0.5 * power(row, column, force, v)
        if step % stride == 0:
            books[2] += dissipated(v, scratch[0], scratch[2], mass)
        count = overloaded(y, v, limit, crack, alpha)
        if count > 0:
            return step + 1, count
    return steps, 0
