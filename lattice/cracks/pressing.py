"""Contact of the edge at the end of a sub-step.

A contact that presses with E / d is stiff for the sub-steps of slow interaction, in which an edge that has come loose
goes farther than it takes to crush the ice. By the force at the start of a sub-step it would meet the structure for
nothing and be thrown back by what it then overlaps. So the force is the one at the end of the sub-step, under this
force itself (backward Euler): it takes energy, and the less the shorter the sub-step is beside the contact's period.
"""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.contact import Faces
from lattice.explicit.forces import Touch
from lattice.explicit.kernels import push
from lattice.explicit.layout import Motion, PerNode
from lattice.explicit.march import add_moments, moved_point
from lattice.grid import Array

HALVINGS = 40  #: of the interval in which the force is, to 1e-12 of its width


@compiled(nogil=True)
def remember_velocity(touch: Touch, now: Array, then: Array, v: Array) -> None:
    """Velocities of the nodes before the sub-step into ``then`` (m, 5); no contact is in ``now`` (m, 5) yet."""
    for k in range(len(touch.row)):
        for c in range(5):
            then[k, c], now[k, c] = v[c, touch.row[k], touch.column[k]], 0.0


@compiled(nogil=True)
def press(touch: Touch, now: Array, then: Array, motion: Motion, kick: PerNode, dt: float, alpha: float) -> float:
    """Adds the contact to a sub-step in which all other forces have acted, into ``now`` (m, 5) [N], [N m].

    Half its power at the velocities ``then`` is returned [W].
    """
    x, goes, half = np.empty(3), np.empty((3, 3)), 0.0
    for k in range(len(touch.row)):
        i, j, h, lead = touch.row[k], touch.column[k], touch.height[k], touch.lead[k]
        moved_point(touch, k, motion, alpha, x)
        u, w, phi = dt * kick.u[i, j], dt * kick.w[i, j], dt * kick.phi[i, j]
        goes[:] = 0.0
        goes[0, 0], goes[1, 1], goes[2, 2] = u + h * h * phi, u + h * h * phi, w + lead * lead * phi
        goes[0, 2] = goes[2, 0] = -h * lead * phi
        force_at_end(touch.faces, k, x, goes, now)
        add_moments(touch, k, now)
        for c in range(5):
            half += 0.5 * now[k, c] * then[k, c]
    push(touch.row, touch.column, now, motion, kick, dt + alpha)
    return half


@compiled(nogil=True)
def force_at_end(faces: Faces, k: int, x: Array, goes: Array, now: Array) -> None:
    """Force of node k, whose point would be displaced by x (3,) without it and goes by ``goes`` (3, 3) [m/N] under it.

    All points of a node press nearly one way, so that the sum of their pressures times overlaps says how they yield.
    """
    s = faces.overlap.shape[1]
    mean, pressing, most = np.zeros(3), 0, 0.0
    reaches, yields = np.empty(s), np.empty(s)
    now[k, :3] = 0.0
    for p in range(s):
        reaches[p] = faces.overlap[k, p] + np.dot(faces.grows[k, p], x)
        if reaches[p] > faces.crushed[k, p]:
            mean += faces.way[k, p]
            pressing += 1
            most += pressure_times_overlap(faces, k, p, reaches[p])
    if pressing == 0:
        return
    push_of_one = np.dot(goes, mean / pressing)
    for p in range(s):
        yields[p] = max(-np.dot(faces.grows[k, p], push_of_one), 0.0)
    low, high = 0.0, most
    for _ in range(HALVINGS):
        middle, found = 0.5 * (low + high), 0.0
        for p in range(s):
            found += pressure_times_overlap(faces, k, p, reaches[p] - yields[p] * middle)
        if found > middle:
            low = middle
        else:
            high = middle
    for p in range(s):
        now[k, :3] += pressure_times_overlap(faces, k, p, reaches[p] - yields[p] * high) * faces.way[k, p]


@compiled(nogil=True)
def pressure_times_overlap(faces: Faces, k: int, p: int, overlap: float) -> float:
    """What presses at point p of node k at an overlap [m], by `Faces.way` [Pa m]."""
    closes = overlap - faces.crushed[k, p]
    if closes <= 0.0 or overlap <= 0.0:
        return 0.0
    return float(min(faces.stiffness * closes, faces.strength) * min(overlap, faces.whole[k, p]))
