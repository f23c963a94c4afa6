"""Layered cells that have come apart, and what of them still holds two nodes together."""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.cells import SEEN, Cracks, place
from lattice.cracks.law import N, T
from lattice.cracks.layers import D_N, D_T, LAYERS, SLIP
from lattice.explicit.layout import LANES
from lattice.grid import Array, BoolArray, IntArray


@compiled(inline="always")
def cuts_along_x(c: float, s: float) -> bool:
    """Whether a crack through the middle of a cell, across (c, s), cuts its edges 0-1 and 2-3; else 0-2 and 1-3."""
    return abs(c) >= abs(s)


@compiled(nogil=True)
def parted(count: int, d: float, thickness: Array, cracks: Cracks) -> BoolArray:
    """Cells of size d that are parted across n and across t, (count, 2).

    The crack is through, pressed by nothing, and open or slipped by h/2, or slipped by h. ``thickness`` h (count,) of
    their ice [m].
    """
    out, history, linear = np.zeros((count, 2), np.bool_), cracks.history, cracks.linear
    for k in range(count):
        slip = along_n = along_t = 0.0
        through, torn = [True, True], False
        for i in range(LAYERS):
            slip = max(slip, abs(history[k, SLIP + i]))
            through[N] = through[N] and history[k, D_N + i] >= 1.0
            through[T] = through[T] and history[k, D_T + i] >= 1.0
            torn = torn or history[k, D_T + i] > 0.0
        c, s, at = cracks.axis[0, k], cracks.axis[1, k], SEEN + place(k)
        for i in range(4):
            if (i < 2) == cuts_along_x(c, s):
                along_n = max(along_n, abs(cracks.shear_slip[k, i]))
            else:
                along_t = max(along_t, abs(cracks.shear_slip[k, i]))
        slipped = max(d * slip, along_n), max(d * slip, along_t) if torn else along_t
        e_x, e_y, e_s = linear[at], linear[at + LANES], linear[at + 2 * LANES]
        gap = d * (c * c * e_x + s * s * e_y + c * s * e_s), d * (s * s * e_x + c * c * e_y - c * s * e_s)
        for a in range(2):
            free = through[a] and cracks.thrust[k, a] <= 0.0
            out[k, a] = slipped[a] > thickness[k] or (free and max(gap[a], slipped[a]) > 0.5 * thickness[k])
    return out


def halves(nodes: IntArray, axis: Array, cut: BoolArray) -> IntArray:
    """Pairs of nodes that lie on one side of the only crack of a cell and are held together there, (m, 2).

    Cells with ``nodes`` (count, 4), ``axis`` (2, count) of their cracks, ``cut`` (count, 2) across n and t.
    """
    along_x = (np.abs(axis[0]) >= np.abs(axis[1])) == cut[:, N]  # which edges the one crack cuts
    one = cut[:, N] != cut[:, T]
    x, y = nodes[one & along_x], nodes[one & ~along_x]
    return np.concatenate((x[:, [0, 2]], x[:, [1, 3]], y[:, [0, 1]], y[:, [2, 3]]))
