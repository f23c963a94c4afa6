"""Forces of a contact from the overlap at its sample points: see `coupling.contact`."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from coupling.compiled import compiled
from coupling.interface import Array, IntArray


class Sampled(NamedTuple):
    """A contact at its sample points; (m, samples) each, and a third index for x, y, z where it has one."""

    L: Array  #: overlap along the drift [m]
    normal: Array  #: outward of the structure
    pressure: Array  #: [Pa]
    stiffness: Array  #: its derivative to L [Pa/m]
    grip: Array  #: friction along the slope over the pressure; negative where it pulls ice up


@compiled(nogil=True, error_model="numpy")
def forces_of(on: IntArray, at: Sampled, width: Array, h: float) -> tuple[Array, Array]:
    """Force on the ice (m, 3) [N] and tangent (m, 3, 3) [N/m].

    ``width`` (m,) [m] is that of all nodes, ``at`` has a row for each of those ``on``; h is the thickness [m].
    """
    force, tangent = np.zeros((len(width), 3)), np.zeros((len(width), 3, 3))
    samples = at.L.shape[1]
    for r in range(len(on)):
        m, part = on[r], width[on[r]] / samples
        for s in range(samples):
            L, n, p = at.L[r, s], at.normal[r, s], at.pressure[r, s]
            sin, cos = math.sqrt(1.0 - n[2] * n[2]), abs(n[2])
            whole, steep = h / sin, max(cos, 1e-12)
            growing = L > 0.0 and whole * cos > L
            length = L / steep if growing else whole if L > 0.0 else 0.0
            load, slope = p * length, at.stiffness[r, s] * length + (p / steep if growing else 0.0)
            for c in range(3):
                up = ((1.0 if c == 2 else 0.0) - n[2] * n[c]) / sin
                per_area = part * (n[c] + at.grip[r, s] * up)
                force[m, c] += per_area * load
                for k in range(3):  # dL/dy and dL/dw are -dx/dy and -dx/dz of the face
                    tangent[m, c, k] += per_area * slope * (n[k] / n[0])
    return force, tangent
