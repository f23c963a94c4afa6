"""The loop over the sub-steps of a lattice in which some cells are layered: `explicit.march` with their forces.

Threads of a team go through it together, see `lattice.team`: each calls it, and does its part between two meetings.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.motion import Layered, Nodes, damping_power, look_at_layered
from lattice.cracks.pressing import press, remember_velocity
from lattice.cracks.slopes import COUNT, HOLD, LOSS
from lattice.cracks.tiles import add_up, look, move, take_stock, tile_of
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.layout import Mesh, Motion
from lattice.explicit.march import contact_force, half_power
from lattice.explicit.screen import Screen
from lattice.team import TILES, Team, together


class Stretch(NamedTuple):
    """Sub-steps in one go."""

    steps: int
    stride: int  #: damping is taken stock of in each of so many
    team: Team


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
    """As `explicit.march.march`, with the forces of the layered cells, whose law is asked where their strain moves.

    What contact and loads do is summed up by the first thread of the team.
    """
    pace, contact_work, team, parts = mesh.pace, 0.0, stretch.team, layered.nodes.parts
    nx, my, first = mesh.kick.u.shape[0], motion.y.shape[2], team.member == 0
    nodes = Nodes(motion.y.reshape(5, -1), motion.v.reshape(5, -1), my, pace.alpha, pace.go - pace.alpha)
    presses, then = touch.faces.overlap.shape[1] > 0, np.empty((len(touch.row), 5))
    for k in range(team.member, TILES, team.size):
        parts[k, HOLD] = parts[k, LOSS] = 0.0
    for step in range(stretch.steps):
        stock = step % stretch.stride == 0
        if first:
            if presses:
                remember_velocity(touch, sums.now, then, motion.v)
            else:
                contact_force(touch, sums.now, motion, pace.alpha)
            contact_work += half_power(load, touch, sums, motion.v)
        for k in range(team.member, TILES, team.size):
            look(tile_of(k, nx, my), stock, nodes, mesh, layered)
        together(team)
        look_at_layered(team, nodes, layered)
        together(team)
        for k in range(team.member, TILES, team.size):
            add_up(tile_of(k, nx, my), team, motion, nodes, mesh, layered)
        together(team)
        for k in range(team.member, TILES, team.size):
            move(tile_of(k, nx, my), motion, mesh, load, touch, sums, layered)
        together(team)
        if first:
            if presses:
                contact_work += press(touch, sums.now, then, motion, mesh.kick, nodes.dt, pace.alpha)
            sums.contact[:] += sums.now[:, :3]
            contact_work += half_power(load, touch, sums, motion.v)
        if presses:
            together(team)
        if stock:
            damping_power(team, my, mesh.before.reshape(5, -1), nodes.v, layered)
        for k in range(team.member, TILES, team.size):
            take_stock(tile_of(k, nx, my), stock, motion, nodes, mesh, screen, layered)
        together(team)
        count = int(parts[0, COUNT] + parts[1, COUNT])
        if count > 0:
            return Made(step + 1, count, contact_work, parts[0, LOSS] + parts[1, LOSS], parts[0, HOLD] + parts[1, HOLD])
    return Made(stretch.steps, 0, contact_work, parts[0, LOSS] + parts[1, LOSS], parts[0, HOLD] + parts[1, HOLD])
