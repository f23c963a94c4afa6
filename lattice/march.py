"""Sub-steps of the explicit engine between two evaluations of the contact."""

from __future__ import annotations

from numba import njit

from lattice.kernels import A1, A2, A3, I1, overloaded, push, sweep


@njit(f"void({I1}, {I1}, {A2}, {A2}, {A3}, {A2}, {A3}, {A3}, float64)", cache=True, nogil=True)
def contact_force(row, column, at, force, tangent, now, y, v, alpha):
    """Contact on u_x, u_y, w of its nodes, linear about the displacement ``at``: into ``now`` (m, 5) [N]."""
    for k in range(len(row)):
        i, j = row[k], column[k]
        for a in range(3):
            now[k, a] = force[k, a]
            for b in range(3):
                now[k, a] += tangent[k, a, b] * (y[b, i, j] - alpha * v[b, i, j] - at[k, b])


MARCH = (f"UniTuple(int64, 2)(int64, {A3}, {A3}, {A2}, {A3}, {A2}, {A1}, {A1}, {A1}, {A1}, {I1}, {I1}, {A2}, "
         f"{I1}, {I1}, {A2}, {A2}, {A3}, {A2}, {A2})")


@njit(MARCH, cache=True, nogil=True)
def march(steps, y, v, intact, kick, limit, spring, pace, crack, rows, row, column, force,
          touch_row, touch_column, at, touch, tangent, now, total):
    """Up to ``steps`` sub-steps; stops after the first one at whose end a cell is overloaded.

    ``force`` (k, 5) on the nodes (row, column) is constant; the contact is linear about ``at`` (m, 3) with the force
    ``touch`` (m, 3) and its ``tangent`` (m, 3, 3). Its forces, sub-step by sub-step, are added up in ``total`` (m, 3).
    Returns the sub-steps made and the number of overloaded faces.
    """
    alpha, go = pace[0], pace[1]
    for step in range(steps):
        contact_force(touch_row, touch_column, at, touch, tangent, now, y, v, alpha)
        total += now[:, :3]
        sweep(y, v, intact, kick, spring, pace, rows)
        push(row, column, force, y, v, kick, go)
        push(touch_row, touch_column, now, y, v, kick, go)
        count = overloaded(y, v, limit, crack, alpha)
        if count > 0:
            return step + 1, count
    return steps, 0
