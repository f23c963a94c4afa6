"""Pieces of the lattice as `Fragment`."""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, Fragment, IntArray
from coupling.sheet_port.front import Front
from coupling.sheet_port.motion import Motion
from lattice.floe import Floe


def fragment(sheet: Floe, motion: Motion, front: Front, nodes: IntArray) -> Fragment:
    """The piece of these nodes as it is and moves now, less what is crushed off it; the front books that it leaves."""
    g, s, edge = sheet.grid, sheet.state, front.edge
    row, column = np.divmod(nodes, g.ny)
    position = motion.position(nodes)
    position[:, 1] += front.ice_y[column] - (g.y0 + column * g.d)
    return Fragment(
        row=g.nx - 1 - row,
        column=column,
        mass=front.leave(nodes),
        length=edge.length(row),
        width=edge.width[column],
        lead=edge.lead(row),
        position=position,
        velocity=motion.velocities(nodes),
        tilt=s.q[nodes, 1].copy(),
        tilt_rate=s.q_dot[nodes, 1].copy(),
        flooded=_flooded(sheet, nodes),
        cut=edge.cut(row, column),
        cut_tan=edge.tan[column],
        cut_face=front.contact.face,
    )


def _flooded(sheet: Floe, nodes: IntArray) -> Array:
    """Part of the head that the tops of nodes carry, (n,)."""
    return np.zeros(len(nodes)) if sheet.tops is None else sheet.tops.flooded[nodes]
