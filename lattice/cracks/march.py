"""The loop over the sub-steps of a lattice in which some cells are layered: `explicit.march` with their forces."""

from __future__ import annotations

from typing import NamedTuple

from lattice.compiled import compiled
from lattice.cracks.lean import book_pull, lean_on, look_at_slopes, overloaded_leaning
from lattice.cracks.motion import Layered, Nodes, crack_forces, give, pull_on_held, renew
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import pull_of_springs, push, sweep
from lattice.explicit.layout import Mesh, Motion, Pace
from lattice.explicit.march import contact_force, dissipated, half_power
from lattice.explicit.screen import Screen


class Stretch(NamedTuple):
    """Sub-steps in one go."""

    steps: int
    stride: int  #: damping is taken stock of in each of so many


@compiled(nogil=True)
def damped(motion: Motion, mesh: Mesh, layered: Layered) -> None:
    """As `explicit.march.damped`; layered cells damp with their tangent."""
    room, pace, (cells, my) = mesh.scratch, mesh.pace, (layered.cells, motion.y.shape[2])
    room.before[:] = motion.v
    room.after[:] = motion.v
    room.y[:] = pace.alpha * motion.v
    crack_forces(my, room.y.reshape(5, -1), 0.0, layered)
    water = Pace(0.0, 0.0, 0.0, pace.drag + pace.alpha * pace.buoy)  # dt c / (rho h)
    trial = Motion(room.y, room.after)
    sweep(trial, mesh.intact, mesh.kick, mesh.springs, water, mesh.rows)
    give(layered.used, trial, mesh.kick, 0.0, cells)


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
    pace, room, contact_work, loss = mesh.pace, mesh.scratch, 0.0, 0.0
    hold = 0.0
    cells, my, y = layered.cells, motion.y.shape[2], motion.y.reshape(5, -1)
    x, way = room.before.reshape(5, -1), room.after.reshape(5, -1)
    nodes = Nodes(y, motion.v.reshape(5, -1), x, way, my, pace.alpha, pace.go - pace.alpha)
    for step in range(stretch.steps):
        contact_force(touch, sums.now, motion, pace.alpha)
        sums.contact[:] += sums.now[:, :3]
        if layered.leans:
            look_at_slopes(nodes, mesh.intact.plane.reshape(-1), layered)
        renew(nodes, layered)
        if step % stretch.stride == 0:
            damped(motion, mesh, layered)
        crack_forces(my, y, 1.0, layered)
        hold += pull_of_springs(motion, mesh.intact, mesh.held, mesh.springs)
        hold += pull_on_held(my, mesh.held.reshape(-1), layered)
        contact_work += half_power(load, touch, sums, motion.v)
        book_pull(0.5 * nodes.dt, nodes.v, layered)
        sweep(motion, mesh.intact, mesh.kick, mesh.springs, pace, mesh.rows)
        push(load.row, load.column, load.force, motion, mesh.kick, pace.go)
        push(touch.row, touch.column, sums.now, motion, mesh.kick, pace.go)
        give(layered.used, motion, mesh.kick, pace.go, cells)
        lean_on(motion, mesh.kick, pace.go, layered.lean.force)
        contact_work += half_power(load, touch, sums, motion.v)
        book_pull(0.5 * nodes.dt, nodes.v, layered)
        if step % stretch.stride == 0:
            loss += dissipated(motion.v, room.before, room.after, mesh.mass)
        count = overloaded_leaning(motion, mesh.threshold, screen, pace.alpha, layered)
        if count > 0:
            return Made(step + 1, count, contact_work, loss, hold)
    return Made(stretch.steps, 0, contact_work, loss, hold)
