"""What a thread of the card computes: forces and limits of single nodes and cells.

The law is not written twice: elongations, weights and the criterion are the Python sources of the loops of
`lattice.explicit`, compiled once more for the card. What differs is who asks: the loops go along rows and hand forces
on from node to node; here a thread gathers all of its own node, so that no two threads write to one place. Places
beside the sheet have zeros, -1 included, which is the last row or column of the padding.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import cuda

from lattice.explicit import kernels, screen
from lattice.explicit.kernels import Five
from lattice.explicit.layout import PHI_X, HalfSprings, Intact, Motion, W
from lattice.grid import Array

Four = tuple[float, float, float, float]


def on_card(function: Callable[..., Any]) -> Any:
    """A function that kernels of the card call."""
    return cuda.jit(device=True)(function)


at_node, weights, stretches = (on_card(f.py_func) for f in (kernels.at_node, kernels.weights, kernels.stretches))
membrane_sums, reached = (on_card(f.py_func) for f in (screen.membrane_sums, screen.reached))


@on_card
def pulls(i: int, j: int, y: Array, intact: Intact, springs: HalfSprings) -> tuple[Five, Five, Four]:
    """Forces of the connections that `stretches` gives for (i, j); as `explicit.kernels.connections`."""
    kn, ks, ko, gr, gt = springs.K_n, springs.K_s, springs.K_out, springs.G_r, springs.G_t
    kd, gd = springs.K_n_dia, springs.G_dia
    (x, bx), (z, bz), (cell, bent) = weights(i, j, intact)
    a, b = at_node(i, j, y), at_node(i + 1, j, y)
    u, v, c = stretches(a, b, at_node(i, j + 1, y), at_node(i + 1, j + 1, y), springs.lever)
    return (
        (kn * x * u[0], ks * x * u[1], ko * x * u[2], gr * bx * u[3], gt * bx * u[4]),
        (kn * z * v[0], ks * z * v[1], ko * z * v[2], gr * bz * v[3], gt * bz * v[4]),
        (kd * cell * c[0], kd * cell * c[1], gd * bent * c[2], gd * bent * c[3]),
    )


@on_card
def force(i: int, j: int, y: Array, intact: Intact, springs: HalfSprings) -> Five:
    """Sum of the springs on node (i, j), [N] and [N m]; terms in the order of `explicit.kernels.gather`."""
    x, z, d = pulls(i, j, y, intact, springs)
    x_back, _, d_back = pulls(i - 1, j, y, intact, springs)
    _, z_side, d_side = pulls(i, j - 1, y, intact, springs)
    _, _, d_far = pulls(i - 1, j - 1, y, intact, springs)
    half = springs.lever
    return (
        -x_back[0] - d_far[0] - d_back[1] + x[0] + z[1] - z_side[1] + d[0] + d_side[1],
        -x_back[1] - d_far[0] + d_back[1] + x[1] + z[0] - z_side[0] + d[0] - d_side[1],
        -x_back[2] + x[2] + z[2] - z_side[2],
        -x_back[3] - d_far[2] - d_back[3] - half * x_back[2] + x[3] + z[4] - z_side[4] + d[2] + d_side[3] - half * x[2],
        -x_back[4] - d_far[2] + d_back[3] + x[4] + z[3] - z_side[3] + d[2] - d_side[3] - half * (z[2] + z_side[2]),
    )


@on_card
def halfway(i: int, j: int, y: Array, z: Array) -> Five:
    """As `explicit.kernels.halfway`."""
    (a, b, c, d, e), (f, g, h, k, m) = at_node(i, j, y), at_node(i, j, z)
    return 0.5 * (a + f), 0.5 * (b + g), 0.5 * (c + h), 0.5 * (d + k), 0.5 * (e + m)


@on_card
def power_of_springs(i: int, j: int, one: Array, two: Array, intact: Intact, springs: HalfSprings) -> float:
    """Share of (i, j) in one . K (one + two) / 2, two motions of the nodes."""
    x, z, d = pulls(i, j, one, intact, springs)
    a, b = halfway(i, j, one, two), halfway(i + 1, j, one, two)
    u, v, c = stretches(a, b, halfway(i, j + 1, one, two), halfway(i + 1, j + 1, one, two), springs.lever)
    along = x[0] * u[0] + x[1] * u[1] + x[2] * u[2] + x[3] * u[3] + x[4] * u[4]
    across = z[0] * v[0] + z[1] * v[1] + z[2] * v[2] + z[3] * v[3] + z[4] * v[4]
    power: float = along + across + d[0] * c[0] + d[1] * c[1] + d[2] * c[2] + d[3] * c[3]
    return power


@on_card
def moved(c: int, i: int, j: int, motion: Motion, ago: float) -> float:
    """A displacement of a node now, y - ago v."""
    now: float = motion.y[c, i, j] - ago * motion.v[c, i, j]
    return now


@on_card
def point(i: int, j: int, height: float, lead: float, motion: Motion, ago: float) -> tuple[float, float, float]:
    """Displacement of a point that a node carries, as `explicit.readings.points` [m]."""
    tilt, roll = moved(PHI_X, i, j, motion, ago), moved(PHI_X + 1, i, j, motion, ago)
    down = moved(W, i, j, motion, ago) - lead * tilt
    return moved(0, i, j, motion, ago) + height * tilt, moved(1, i, j, motion, ago) + height * roll, down
