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
    return friction_at(structure, mu, face, level + y[:, 2], force)


def friction_at(structure: Structure, mu: Array | float, face: float, height: Array, force: Array) -> Array:
    """The same with the heights (m,) of the touching face [m], and a coefficient that may be that of each node (m,)."""
    part = np.zeros_like(force)
    on = np.flatnonzero(force.any(axis=1))
    if not len(on) or not np.any(mu):
        return part
    n_z = structure.normal_z(height[on])
    mu = mu[on] if isinstance(mu, np.ndarray) else mu
    s = np.sqrt(1.0 - n_z**2)
    normal = force[on, :3] / (1.0 - mu * face * n_z / s)[:, None]
    normal[:, 2] = n_z * force[on, 2] / (n_z + mu * face * s)
    part[on, :3] = force[on, :3] - normal
    return part
