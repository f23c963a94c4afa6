"""Sub-steps of the explicit engine between two evaluations of the contact.

A lattice whose cells carry more than springs needs a loop of its own in place of `march`, made of the same parts: its
forces act between `sweep` and the first `push`, on nodes, like those of loads. See `ExplicitEngine.loop`.
"""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import Span, power_of_springs, pull_of_springs, push, sweep
from lattice.explicit.layout import PHI_X, Mesh, Motion, W
from lattice.explicit.screen import Screen, overloaded
from lattice.grid import Array, IntArray


@compiled(nogil=True)
def moved_point(touch: Touch, k: int, motion: Motion, alpha: float, x: Array) -> None:
    """How far the point of contact k is from ``at``, into x (3,) [m]."""
    y, v, lead, i, j = motion.y, motion.v, touch.lead[k], touch.row[k], touch.column[k]
    for b in range(3):
        x[b] = y[b, i, j] - alpha * v[b, i, j] - touch.at[k, b]
        if b == W and lead != 0.0:
            x[b] -= lead * (y[PHI_X, i, j] - alpha * v[PHI_X, i, j])
        if b < W:
            x[b] += touch.height[k] * (y[b + 3, i, j] - alpha * v[b + 3, i, j])


@compiled(nogil=True)
def add_moments(touch: Touch, k: int, now: Array) -> None:
    """Moments about its node of the force at the point of contact k, beside it into ``now`` (m, 5) [N m]."""
    for a in range(2):
        now[k, a + 3] = touch.height[k] * now[k, a]
    if touch.lead[k] != 0.0:
        now[k, PHI_X] -= touch.lead[k] * now[k, W]


@compiled(nogil=True)
def contact_force(touch: Touch, now: Array, motion: Motion, alpha: float) -> None:
    """Contact at the end of its levers, linear about the displacement ``at``: into ``now`` (m, 5) [N], [N m]."""
    x = np.empty(3)
    for k in range(len(touch.row)):
        moved_point(touch, k, motion, alpha, x)
        now[k, :3] = touch.force[k]
        for b in range(3):
            for a in range(3):
                now[k, a] += touch.tangent[k, a, b] * x[b]
        add_moments(touch, k, now)


@compiled(nogil=True, borrows=True)
def dissipated(span: Span, motion: Motion, mesh: Mesh, rows: Array) -> float:
    """Work that damping of springs and water took in a sub-step in some rows [J], exact for leapfrog.

    It acts on the velocities ``before`` and takes its force times the mean velocity.
    """
    mass, pace, before, v = mesh.mass, mesh.pace, mesh.before, motion.v
    ny = mass.shape[1]
    drag, taken = pace.drag + pace.alpha * pace.buoy, 0.0  # dt c / (rho h)
    for i in range(span[0], span[1]):
        row = 0.0
        for j in range(ny):
            row += mass[i, j] * before[W, i, j] * (0.5 * (before[W, i, j] + v[W, i, j]))
        taken += row
    springs: float = power_of_springs(span, before, v, mesh.intact, mesh.springs, rows)
    return drag * taken + (pace.go - pace.alpha) * pace.alpha * springs


@compiled(nogil=True, borrows=True)
def power(row: IntArray, column: IntArray, force: Array, v: Array, first: int, end: int) -> float:
    """Of the forces ``first`` to ``end`` of (k, 5) on single nodes [W]."""
    total = 0.0
    for k in range(first, end):
        for c in range(5):
            total += force[k, c] * v[c, row[k], column[k]]
    return total


@compiled(nogil=True, borrows=True)
def half_power(load: PointForces, touch: Touch, sums: Sums, v: Array) -> float:
    """Half the power of the contact [W]; that of each load is added to its sum."""
    for n in range(len(sums.work)):
        sums.work[n] += 0.5 * power(load.row, load.column, load.force, v, load.first[n], load.first[n + 1])
    of_contact: float = power(touch.row, touch.column, sums.now, v, 0, len(touch.row))
    return 0.5 * of_contact


@compiled(nogil=True)
def march(
    steps: int, stride: int, motion: Motion, mesh: Mesh, screen: Screen, load: PointForces, touch: Touch, sums: Sums
) -> Made:
    """Up to ``steps`` sub-steps; stops after the first one at whose end a cell is overloaded.

    Work is exact for leapfrog: a force times the mean of the velocities before and after. That of damping is taken in
    every ``stride``-th sub-step, which costs as much as a sub-step.
    """
    pace, contact_work, loss, hold = mesh.pace, 0.0, 0.0, 0.0
    every = (0, mesh.kick.u.shape[0])
    for step in range(steps):
        contact_force(touch, sums.now, motion, pace.alpha)
        sums.contact[:] += sums.now[:, :3]
        if step % stride == 0:
            mesh.before[:] = motion.v
        contact_work += half_power(load, touch, sums, motion.v)
        hold += pull_of_springs(every, motion, mesh.intact, mesh.held, mesh.springs)
        sweep(motion, mesh.intact, mesh.kick, mesh.springs, pace, mesh.rows)
        push(load.row, load.column, load.force, motion, mesh.kick, pace.go)
        push(touch.row, touch.column, sums.now, motion, mesh.kick, pace.go)
        contact_work += half_power(load, touch, sums, motion.v)
        if step % stride == 0:
            loss += dissipated(every, motion, mesh, mesh.rows)
        count = overloaded(motion, mesh.threshold, screen, pace.alpha)
        if count > 0:
            return Made(step + 1, count, contact_work, loss, hold)
    return Made(steps, 0, contact_work, loss, hold)
