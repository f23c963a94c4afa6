"""What is read off the motion between two marches: points of contact, deflections and their integral over time."""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.explicit.layout import PHI_X, U_X, Motion, W
from lattice.grid import Array, IntArray


class Path:
    """Integral over a window of the deflection and the rotations of all nodes, from block to block of sub-steps."""

    def __init__(self, nodes: int):
        self.before = np.zeros((nodes, 3))  #: when the present sub-steps began [m], [rad]
        self.sum = np.zeros((nodes, 3))  #: until then [m s], [rad s]

    def total(self) -> Array:
        """The integral, (nodes, 3) [m s], [rad s]."""
        return self.sum


@compiled(nogil=True)
def points(nodes: IntArray, columns: int, height: Array, lead: Array, motion: Motion, ago: float) -> Array:
    """`contact.point_displacement` of nodes now, y - ago v, with ``columns`` nodes across; (m, 3) [m]."""
    y, v, out = motion.y, motion.v, np.empty((nodes.shape[0], 3))
    for k in range(nodes.shape[0]):
        i, j = nodes[k] // columns, nodes[k] % columns
        for c in range(3):
            out[k, c] = y[U_X + c, i, j] - ago * v[U_X + c, i, j]
        for c in range(2):
            out[k, c] += height[k] * (y[PHI_X + c, i, j] - ago * v[PHI_X + c, i, j])
        if lead[k] != 0.0:
            out[k, 2] -= lead[k] * (y[PHI_X, i, j] - ago * v[PHI_X, i, j])
    return out


@compiled(nogil=True)
def deflections(motion: Motion, ago: float, columns: int, q: Array) -> None:
    """Writes deflection and rotations of all nodes now, y - ago v, into q (n, 3)."""
    y, v, q = motion.y, motion.v, q.reshape(q.shape[0] // columns, columns, 3)
    for i in range(q.shape[0]):
        for j in range(q.shape[1]):
            for c in range(3):
                q[i, j, c] = y[W + c, i, j] - ago * v[W + c, i, j]


@compiled(nogil=True)
def add_path(motion: Motion, ago: float, columns: int, half: float, before: Array, path: Array) -> None:
    """Adds ``half`` a time [s] of the deflections ``before`` and now to their integral, (n, 3) both."""
    y, v, shape = motion.y, motion.v, (path.shape[0] // columns, columns, 3)
    before, path = before.reshape(shape), path.reshape(shape)
    for i in range(path.shape[0]):
        for j in range(path.shape[1]):
            for c in range(3):
                path[i, j, c] += half * (before[i, j, c] + (y[W + c, i, j] - ago * v[W + c, i, j]))
