"""The loop over the sub-steps of a lattice in which some cells are layered: `explicit.march` with their forces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.lean import book_pull, look_at_cells, overloaded_leaning
from lattice.cracks.motion import Layered, Nodes, damping_power, give, pull_on_held
from lattice.cracks.pressing import press, remember_velocity
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import pull_of_springs, push, sweep
from lattice.explicit.layout import Mesh, Motion
from lattice.explicit.march import contact_force, dissipated, half_power
from lattice.explicit.screen import Screen


class Stretch(NamedTuple):
    """Sub-steps in one go."""

    steps: int
    stride: int  #: damping is taken stock of in each of so many


@compiled(nogil=True)
def march_cracked(
    stretch: Stretch,
    motion: Motion,
    mesh: Mesh,
    screen: Screen,
    load: PointForces,
    touch: Touch,
    sums: Sums,
    layered: Layered,
) -> Made:
    """As `explicit.march.march`, with the forces of the layered cells, whose law is asked where their strain moves."""
    pace, contact_work, loss = mesh.pace, 0.0, 0.0
    hold, my = 0.0, motion.y.shape[2]
    before, force = mesh.before.reshape(5, -1), layered.nodes.force
    nodes = Nodes(motion.y.reshape(5, -1), motion.v.reshape(5, -1), my, pace.alpha, pace.go - pace.alpha)
    presses, then = touch.faces.overlap.shape[1] > 0, np.empty((len(touch.row), 5))
    for step in range(stretch.steps):
        if presses:
            remember_velocity(touch, sums.now, then, motion.v)
        else:
            contact_force(touch, sums.now, motion, pace.alpha)
        look_at_cells(nodes, mesh.intact.plane.reshape(-1), layered)
        if step % stretch.stride == 0:
            mesh.before[:] = motion.v
        hold += pull_of_springs(motion, mesh.intact, mesh.held, mesh.springs)
        hold += pull_on_held(mesh.held.reshape(-1), force)
        contact_work += half_power(load, touch, sums, motion.v)
        book_pull(0.5 * nodes.dt, nodes.v, layered)
        sweep(motion, mesh.intact, mesh.kick, mesh.springs, pace, mesh.rows)
        push(load.row, load.column, load.force, motion, mesh.kick, pace.go)
        push(touch.row, touch.column, sums.now, motion, mesh.kick, pace.go)
        give(motion, mesh.kick, pace.go, force)
        if presses:
            contact_work += press(touch, sums.now, then, motion, mesh.kick, pace.go - pace.alpha, pace.alpha)
        sums.contact[:] += sums.now[:, :3]
        contact_work += half_power(load, touch, sums, motion.v)
        book_pull(0.5 * nodes.dt, nodes.v, layered)
        if step % stretch.stride == 0:
            loss += dissipated(motion, mesh) + nodes.dt * pace.alpha * damping_power(my, before, nodes.v, layered)
        count = overloaded_leaning(motion, mesh.threshold, screen, pace.alpha, layered)
        if count > 0:
            return Made(step + 1, count, contact_work, loss, hold)
    return Made(stretch.steps, 0, contact_work, loss, hold)
