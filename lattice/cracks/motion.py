"""Layered cells in the sub-steps of the explicit engine."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.blocks import (
    GAINED,
    NEW,
    OLD,
    PULL,
    SAYS,
    V,
    Y,
    add_forces,
    fetch,
    fetch_cells,
    force_block,
    lean_block,
    moved,
    power_block,
)
from lattice.cracks.cells import (
    FAR,
    MOVED,
    SEEN,
    SEEN_TURN,
    WIDE,
    Cracks,
    Plate,
    edge_energy,
    place,
    plate_at,
    tangent_energy,
)
from lattice.cracks.evaluate import evaluate, write
from lattice.cracks.kinematics import elongations, leaned, strain_of
from lattice.cracks.law import CrackLaw, Local, law_at
from lattice.cracks.slopes import Lean, OnNodes
from lattice.explicit.layout import LANES, U_X, Motion, PerNode, W
from lattice.grid import Array


class Layered(NamedTuple):
    """The layered cells of a sheet with their law."""

    used: int  #: how many; the rest of ``cells`` is room
    cells: Cracks
    plate: Plate
    law: CrackLaw
    lean: Lean
    leans: bool  #: slopes strain the middle plane; else rotations are small
    local: Local  #: how the ice of each cell differs from ``plate`` and ``law``
    nodes: OnNodes


class Nodes(NamedTuple):
    """The nodes in rows, one after the other, as cells look at them; (5, nodes) each."""

    y: Array  #: effective displacement x + alpha v
    v: Array  #: velocity
    x: Array  #: room for displacements
    way: Array  #: room for what they were in the last sub-step
    my: int  #: places in a row
    alpha: float  #: material damping [s]
    dt: float  #: sub-step [s]


@compiled(nogil=True)
def evaluate_at(k: int, nodes: Nodes, layered: Layered) -> float:
    """Evaluates the law in cell k at y - alpha v; its energy [J]."""
    cracks, my, lean, local = layered.cells, nodes.my, layered.lean.strain, layered.local
    b, linear = cracks.corner[k], cracks.linear
    for c in range(5):
        for n in (b, b + my, b + 1, b + my + 1):
            nodes.x[c, n] = nodes.y[c, n] - nodes.alpha * nodes.v[c, n]
            nodes.way[c, n] = nodes.dt * nodes.v[c, n]
    plate, law = plate_at(b, layered.plate, local), law_at(b, layered.law, local)
    in_sheet, _ = strain_of(b, my, 0.5 / plate.d, nodes.y)
    e = leaned(in_sheet, b, lean)
    write(SEEN, place(k), (e.n, e.t, e.g), linear)
    write(SEEN_TURN, place(k), (e.kn, e.kt, e.kg), linear)
    wide = max(abs(e.n) + 0.5 * plate.h * abs(e.kn), abs(e.t) + 0.5 * plate.h * abs(e.kt))
    write(FAR, place(k), (MOVED * (local.e_0[b] + WIDE * wide),), linear)
    stored: float = evaluate(k, nodes.x, nodes.way, my, plate, law, cracks, lean)
    return stored


@compiled(nogil=True)
def put_lean(first: int, end: int, layered: Layered) -> float:
    """Slopes of cells from a block to their places; the energy that these have given, over d^2 [J/m2]."""
    room, lean, gained = layered.nodes.room, layered.lean, 0.0
    for k in range(first, end):
        b, lane = layered.cells.corner[k], k - first
        gained += room[GAINED + lane]
        for i in range(3):
            lean.strain[i, b] = room[NEW + i * LANES + lane]
        for i in range(2):
            lean.pull[i, b] = room[PULL + i * LANES + lane]
    return gained


@compiled(nogil=True)
def fetch_lean(first: int, end: int, layered: Layered) -> None:
    """Strains from slopes into the room of a block, those before and, until they are known, those now."""
    room, strain = layered.nodes.room, layered.lean.strain
    for k in range(first, end):
        b, lane = layered.cells.corner[k], k - first
        for i in range(3):
            room[OLD + i * LANES + lane] = room[NEW + i * LANES + lane] = strain[i, b]


@compiled(nogil=True)
def look_at_layered(nodes: Nodes, layered: Layered) -> float:
    """New slopes of layered cells, their law where their strain has moved, and their forces, added on the nodes.

    Returns the energy that the slopes have given, over d^2 [J/m2].
    """
    cracks, room, d, my = layered.cells, layered.nodes.room, layered.plate.d, nodes.my
    q, ago, gained = 0.5 / d, nodes.alpha + 0.5 * nodes.dt, 0.0
    for first in range(0, layered.used, LANES):
        end = min(first + LANES, layered.used)
        corner = cracks.corner[first:end]
        fetch_cells(first, cracks.linear, room)
        fetch(Y, corner, my, nodes.y, room)
        fetch_lean(first, end, layered)
        if layered.leans:
            fetch(V, corner, my, nodes.v, room)
            lean_block(q, nodes.alpha, ago, room)
            gained += put_lean(first, end, layered)
        if moved(q, room) > 0:
            for k in range(first, end):
                if room[SAYS + k - first] > 0.0:
                    evaluate_at(k, nodes, layered)
            fetch_cells(first, cracks.linear, room)
        force_block(d, room)
        add_forces(corner, my, room, layered.nodes.force)
    return gained


@compiled(nogil=True)
def crack_forces(my: int, y: Array, layered: Layered) -> None:
    """Forces of the layered cells and of slopes on the nodes at the effective displacements y (5, nodes)."""
    cracks, on = layered.cells, layered.nodes
    on.force[:] = 0.0
    on.force[: W + 1] = layered.lean.force
    for first in range(0, layered.used, LANES):
        end = min(first + LANES, layered.used)
        corner = cracks.corner[first:end]
        fetch_cells(first, cracks.linear, on.room)
        fetch(Y, corner, my, y, on.room)
        fetch_lean(first, end, layered)
        force_block(layered.plate.d, on.room)
        add_forces(corner, my, on.room, on.force)


@compiled(nogil=True)
def damping_power(my: int, v: Array, mean: Array, layered: Layered) -> float:
    """Sum of v . K ``mean`` over layered cells with their tangents K, for two motions of the nodes (5, nodes)."""
    cracks, room, power = layered.cells, layered.nodes.room, 0.0
    for first in range(0, layered.used, LANES):
        end = min(first + LANES, layered.used)
        corner = cracks.corner[first:end]
        fetch_cells(first, cracks.linear, room)
        fetch(Y, corner, my, mean, room)
        fetch(V, corner, my, v, room)
        power_block(layered.plate.d, room)
        for lane in range(end - first):
            power += room[SAYS + lane]
    return power


@compiled(nogil=True)
def give(motion: Motion, kick: PerNode, go: float, force: Array) -> None:
    """Adds forces (5, places) on all nodes to a sub-step that has been made."""
    y, v, f = motion.y, motion.v, force.reshape(motion.y.shape)
    nx, ny = kick.u.shape
    for c in range(5):
        mobility = kick.u if c < W else kick.w if c == W else kick.phi
        for i in range(nx):
            for j in range(ny):
                dv = mobility[i, j] * f[c, i, j]
                v[c, i, j] += dv
                y[c, i, j] += go * dv


@compiled(nogil=True)
def pull_on_held(held: Array, force: Array) -> float:
    """Force along x that nodes with ``held`` (places,) 1 need against the forces (5, places) [N]."""
    total = 0.0
    for n in range(held.shape[0]):
        total -= held[n] * force[U_X, n]
    return total


@compiled(nogil=True)
def hourglass_energy(k: int, nodes: Nodes, layered: Layered) -> float:
    """Of the hourglass modes of cell k, x(n) . K x(n-1) / 2, as leapfrog has it [J]."""
    b, q = layered.cells.corner[k], 0.5 / layered.plate.d
    plate = plate_at(b, layered.plate, layered.local)
    H, R = plate.hourglass, plate.hourglass * plate.h * plate.h / 12.0
    _, y = strain_of(b, nodes.my, q, nodes.y)
    _, v = strain_of(b, nodes.my, q, nodes.v)
    now, before = -nodes.alpha, -nodes.alpha - nodes.dt
    E = H * ((y.x + now * v.x) * (y.x + before * v.x) + (y.y + now * v.y) * (y.y + before * v.y))
    E += R * ((y.tx + now * v.tx) * (y.tx + before * v.tx) + (y.ty + now * v.ty) * (y.ty + before * v.ty))
    energy: float = 0.5 * plate.d * plate.d * E
    return energy


@compiled(nogil=True)
def energies(my: int, x: Array, layered: Layered) -> Array:
    """Energy of each layered cell at displacements x (5, nodes), hourglass modes included."""
    d, cracks, lean, linear = layered.plate.d, layered.cells, layered.lean.strain, layered.cells.linear
    out, q, half = np.empty(layered.used), 0.5 / d, 0.5 * d
    for k in range(layered.used):
        b = cracks.corner[k]
        plate = plate_at(b, layered.plate, layered.local)
        H, R = plate.hourglass, plate.hourglass * plate.h * plate.h / 12.0
        e, h = strain_of(b, my, q, x)
        E = tangent_energy(place(k), leaned(e, b, lean), linear)
        E += 0.5 * (H * (h.x * h.x + h.y * h.y) + R * (h.tx * h.tx + h.ty * h.ty))
        out[k] = edge_energy(place(k), elongations(b, my, half, x), cracks.constant[k] + d * d * E, linear)
    return out
