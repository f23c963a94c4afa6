"""The loop over the sub-steps of a lattice in which some cells are layered: `explicit.march` with their forces."""

from __future__ import annotations

from typing import NamedTuple

from lattice.compiled import compiled
from lattice.cracks.motion import Layered, Nodes, crack_forces, give, renew
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import push, sweep
from lattice.explicit.layout import Mesh, Motion, Pace
from lattice.explicit.march import contact_force, dissipated, half_power
from lattice.explicit.screen import Screen, overloaded


class CrackedLattice(NamedTuple):
    """The lattice as the loop sees it."""

    mesh: Mesh  #: of its elastic cells
    screen: Screen
    layered: Layered


@compiled(nogil=True)
def damped(motion: Motion, mesh: Mesh, layered: Layered) -> None:
    """As `explicit.march.damped`; layered cells damp with their tangent."""
    room, pace, (cells, my) = mesh.scratch, mesh.pace, (layered.cells, motion.y.shape[2])
    room.before[:] = motion.v
    room.after[:] = motion.v
    room.y[:] = pace.alpha * motion.v
    crack_forces(layered.number, my, room.y.reshape(5, -1), 0.0, layered.plate, cells)
    water = Pace(0.0, 0.0, 0.0, pace.drag + pace.alpha * pace.buoy)  # dt c / (rho h)
    trial = Motion(room.y, room.after)
    sweep(trial, mesh.intact, mesh.kick, mesh.springs, water, mesh.rows)
    give(layered.number, trial, mesh.kick, 0.0, cells)


@compiled(nogil=True)
def march_cracked(
    steps: int,
    stride: int,
    motion: Motion,
    lattice: CrackedLattice,
    load: PointForces,
    touch: Touch,
    sums: Sums,
) -> Made:
    """As `explicit.march.march`, with the forces of the layered cells, whose law is asked where their strain moves."""
    mesh, screen, layered = lattice
    pace, contact_work, loss, cells, my = mesh.pace, 0.0, 0.0, layered.cells, motion.y.shape[2]
    y, v, dt = motion.y.reshape(5, -1), motion.v.reshape(5, -1), pace.go - pace.alpha
    x, way = mesh.scratch.before.reshape(5, -1), mesh.scratch.after.reshape(5, -1)
    nodes = Nodes(my, y, v, pace.alpha, dt, x, way)
    for step in range(steps):
        contact_force(touch, sums.now, motion, pace.alpha)
        sums.contact[:] += sums.now[:, :3]
        renew(nodes, layered)
        if step % stride == 0:
            damped(motion, mesh, layered)
        crack_forces(layered.number, my, y, 1.0, layered.plate, cells)
        contact_work += half_power(load, touch, sums, motion.v)
        sweep(motion, mesh.intact, mesh.kick, mesh.springs, pace, mesh.rows)
        push(load.row, load.column, load.force, motion, mesh.kick, pace.go)
        push(touch.row, touch.column, sums.now, motion, mesh.kick, pace.go)
        give(layered.number, motion, mesh.kick, pace.go, cells)
        contact_work += half_power(load, touch, sums, motion.v)
        if step % stride == 0:
            loss += dissipated(motion.v, mesh.scratch.before, mesh.scratch.after, mesh.mass)
        count = overloaded(motion, mesh.threshold, screen, pace.alpha)
        if count > 0:
            return Made(step + 1, count, contact_work, loss)
    return Made(steps, 0, contact_work, loss)
