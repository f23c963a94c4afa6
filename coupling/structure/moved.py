"""A structure that is not where it was built: points into its frame, and the contact back.

The rotation is that of the vector (roll, pitch, yaw); the point of the frame is the waterline point.
"""

from __future__ import annotations

import numpy as np

from coupling.interface.structure import Structure
from coupling.interface.units import Array


def turned(rotation: Array) -> Array:
    """Matrix (3, 3) of a rotation vector (3,) [rad]: Rodrigues' formula."""
    angle = float(np.linalg.norm(rotation))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = rotation / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross))


def overlap(structure: Structure, place: Array, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
    """As `Structure.overlap` of a structure displaced by ``place`` (6,).

    Of one that is turned it is exact where the face is plane: along x it reaches as deep as the normal says.
    """
    if not place[3:].any():
        return structure.overlap(x - place[0], y - place[1], z - place[2])
    turn, shape = turned(place[3:]), y.shape
    at = np.stack([np.broadcast_to(a, shape) for a in (x[:, None], y, z[:, None])], axis=-1) - place[:3]
    own = (at @ turn).reshape(-1, 3)  # the inverse of a rotation is its transpose
    depth, normal = structure.overlap(own[:, 0].copy(), own[:, 1:2].copy(), own[:, 2].copy())
    out = normal[:, 0] @ turn.T
    depth[:, 0] *= normal[:, 0, 0] / np.minimum(out[:, 0], -1e-9)
    return depth.reshape(shape), out.reshape(*shape, 3)


def speed(path_velocity: Array, arm: Array) -> Array:
    """Velocity (..., 3) of points at arms (..., 3) from the waterline point of a structure that moves with (6,)."""
    return np.asarray(path_velocity[:3] + np.cross(path_velocity[3:], arm))


def wrench(force: Array, arm: Array) -> Array:
    """Sum of forces (k, 3) at arms (k, 3), and of their moments: (6,)."""
    return np.concatenate((force.sum(axis=0), np.cross(arm, force).sum(axis=0)))
