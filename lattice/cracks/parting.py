"""Layered cells that have come apart."""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.cells import SEEN, Cracks, place
from lattice.cracks.layers import D_N, D_T, LAYERS, SLIP
from lattice.explicit.layout import LANES
from lattice.grid import Array, BoolArray


@compiled(nogil=True)
def parted(count: int, d: float, thickness: Array, cracks: Cracks) -> BoolArray:
    """Cells of size d whose crack is through, pressed by nothing, and open or slipped by h/2, or slipped by h (count,).

    ``thickness`` h (count,) of their ice [m].
    """
    out, history, linear = np.zeros(count, np.bool_), cracks.history, cracks.linear
    for k in range(count):
        slip = slipped = 0.0
        across = along = True
        for i in range(LAYERS):
            slip = max(slip, abs(history[k, SLIP + i]))
            across, along = across and history[k, D_N + i] >= 1.0, along and history[k, D_T + i] >= 1.0
        for i in range(4):
            slipped = max(slipped, abs(cracks.shear_slip[k, i]))
        slipped = max(d * slip, slipped)
        c, s, at = cracks.axis[0, k], cracks.axis[1, k], SEEN + place(k)
        e_x, e_y, e_s = linear[at], linear[at + LANES], linear[at + 2 * LANES]
        open_n, open_t = d * (c * c * e_x + s * s * e_y + c * s * e_s), d * (s * s * e_x + c * c * e_y - c * s * e_s)
        loose = across and cracks.thrust[k, 0] <= 0.0 and max(open_n, slipped) > 0.5 * thickness[k]
        loose = loose or (along and cracks.thrust[k, 1] <= 0.0 and max(open_t, slipped) > 0.5 * thickness[k])
        out[k] = loose or slipped > thickness[k]
    return out
