"""The part of a contact's force on the sheet's edge that is friction: its work is booked apart from that of crushing.

A node's force is F_n + mu f (N z - n_z F_n) / s, with N the sum of the normal forces at its points, f the touching face
(+1 upper), s^2 = 1 - n_z^2; n_z depends on the height alone. So N = F_z / (n_z + mu f s), and in the horizontal
F_n = F / (1 - mu f n_z / s).
"""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, Structure


def friction_part(structure: Structure, mu: float, face: float, level: float, y: Array, force: Array) -> Array:
    """Friction in the force (m, >= 3) on nodes displaced by y (m, 3); the touching face rests at ``level`` [m]."""
    part = np.zeros_like(force)
    on = np.flatnonzero(force.any(axis=1))
    if not len(on) or mu == 0.0:
        return part
    n_z = structure.normal_z(level + y[on, 2])
    s = np.sqrt(1.0 - n_z**2)
    normal = force[on, :3] / (1.0 - mu * face * n_z / s)[:, None]
    normal[:, 2] = n_z * force[on, 2] / (n_z + mu * face * s)
    part[on, :3] = force[on, :3] - normal
    return part
