"""Layered cells in the sub-steps of the explicit engine."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.blocks import (
    SAYS,
    V,
    Y,
    add_forces,
    fetch,
    fetch_cells,
    fetch_lean,
    force_block,
    halve,
    lean_block,
    moved,
    pose_in,
    power_block,
    put_forces,
    put_lean,
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
    part_of,
    place,
    plate_at,
    tangent_energy,
)
from lattice.cracks.evaluate import renew_cell, write
from lattice.cracks.kinematics import Pose, Strain, elongations, leaned, plus, pose_of, strain_of
from lattice.cracks.law import CrackLaw, Local, law_at
from lattice.cracks.slopes import GAINED, POWER, Lean, OnNodes
from lattice.explicit.kernels import Span
from lattice.explicit.layout import LANES, U_X, Motion, PerNode, W
from lattice.grid import Array
from lattice.team import Team


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
    my: int  #: places in a row
    alpha: float  #: material damping [s]
    dt: float  #: sub-step [s]


@compiled(inline="always")
def ask(k: int, y: Pose, v: Pose, times: tuple[float, float], layered: Layered) -> float:
    """Evaluates the law in cell k at y - alpha v; its energy [J]. ``times`` are alpha and the sub-step [s]."""
    cracks, lean, local, (alpha, dt) = layered.cells, layered.lean.strain, layered.local, times
    b, at, linear = cracks.corner[k], place(k), cracks.linear
    plate, law = plate_at(b, layered.plate, local), law_at(b, layered.law, local)
    seen = leaned(y.strain, b, lean)
    write(SEEN, at, (seen.n, seen.t, seen.g), linear)
    write(SEEN_TURN, at, (seen.kn, seen.kt, seen.kg), linear)
    half = 0.5 * plate.h
    wide = max(abs(seen.n) + half * abs(seen.kn), abs(seen.t) + half * abs(seen.kt))
    write(FAR, at, (MOVED * (local.e_0[b] + WIDE * wide),), linear)
    x, still = plus(Pose(seen, y.long), -alpha, v), Pose(Strain(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
    stored: float = renew_cell(k, x, plus(still, dt, v), plate, law, cracks)
    return stored


@compiled(nogil=True, error_model="numpy")
def evaluate_at(k: int, nodes: Nodes, layered: Layered) -> float:
    """Evaluates the law in cell k at y - alpha v; its energy [J]."""
    b, my, d = layered.cells.corner[k], nodes.my, layered.plate.d
    y, v = pose_of(b, my, d, nodes.y), pose_of(b, my, d, nodes.v)
    stored: float = ask(k, y, v, (nodes.alpha, nodes.dt), layered)
    return stored


@compiled(nogil=True, borrows=True, error_model="numpy")
def ask_moved(first: int, end: int, times: tuple[float, float], room: Array, layered: Layered) -> None:
    """Evaluates the law in those cells of a block that `moved` has found."""
    d = layered.plate.d
    for k in range(first, end):
        lane = k - first
        if room[SAYS + lane] > 0.0:
            ask(k, pose_in(Y + lane, d, room), pose_in(V + lane, d, room), times, layered)
    fetch_cells(first, layered.cells.linear, room)


@compiled(nogil=True, borrows=True)
def look_at_layered(team: Team, nodes: Nodes, layered: Layered) -> None:
    """New slopes of layered cells, their law where their strain has moved, and their forces.

    One thread adds these on the nodes, several leave them to `add_given`. The energy that slopes have given, over d^2,
    is added to ``parts`` [J/m2].
    """
    cracks, d, my = layered.cells, layered.plate.d, nodes.my
    q, ago, lean = 0.5 / d, nodes.alpha + 0.5 * nodes.dt, layered.lean
    for first in range(team.member * LANES, layered.used, team.size * LANES):
        end, part = min(first + LANES, layered.used), part_of(first)
        room = layered.nodes.room[part]
        corner = cracks.corner[first:end]
        fetch_cells(first, cracks.linear, room)
        fetch(Y, corner, my, nodes.y, room)
        fetch_lean(corner, lean.strain, room)
        fetch(V, corner, my, nodes.v, room)
        if layered.leans:
            lean_block(q, nodes.alpha, ago, room)
            layered.nodes.parts[part, GAINED] += put_lean(corner, room, lean.strain, lean.pull)
        if moved(q, room) > 0:
            ask_moved(first, end, (nodes.alpha, nodes.dt), room, layered)
        force_block(d, room)
        if team.size == 1:
            add_forces(corner, my, room, layered.nodes.force)
        else:
            put_forces(first // LANES, room, team.given)


@compiled(nogil=True)
def crack_forces(my: int, y: Array, layered: Layered) -> None:
    """Forces of the layered cells and of slopes on the nodes at the effective displacements y (5, nodes)."""
    cracks, on, room = layered.cells, layered.nodes, layered.nodes.room[0]
    on.force[:] = 0.0
    on.force[: W + 1] = layered.lean.force
    for first in range(0, layered.used, LANES):
        end = min(first + LANES, layered.used)
        corner = cracks.corner[first:end]
        fetch_cells(first, cracks.linear, room)
        fetch(Y, corner, my, y, room)
        fetch_lean(corner, layered.lean.strain, room)
        force_block(layered.plate.d, room)
        add_forces(corner, my, room, on.force)


@compiled(nogil=True, borrows=True)
def damping_power(team: Team, my: int, v: Array, z: Array, layered: Layered) -> None:
    """Sum of v . K (v + z) / 2 over layered cells with their tangents K, for two motions of the nodes (5, nodes).

    It is added to ``parts``.
    """
    cracks, parts = layered.cells, layered.nodes.parts
    for first in range(team.member * LANES, layered.used, team.size * LANES):
        end, part = min(first + LANES, layered.used), part_of(first)
        room = layered.nodes.room[part]
        corner = cracks.corner[first:end]
        fetch_cells(first, cracks.linear, room)
        fetch(Y, corner, my, z, room)
        fetch(V, corner, my, v, room)
        halve(room)
        power_block(layered.plate.d, room)
        for lane in range(end - first):
            parts[part, POWER] += room[SAYS + lane]


@compiled(nogil=True, borrows=True, fastmath={"reassoc"})
def dot(x: Array, y: Array) -> float:
    """Sum of products in the order in which vectors have them: the same bits in every run."""
    total = 0.0
    for n in range(len(x)):
        total += x[n] * y[n]
    return total


@compiled(nogil=True, borrows=True)
def give(span: Span, motion: Motion, kick: PerNode, go: float, force: Array) -> None:
    """Adds forces (5, places) on the nodes of some rows to a sub-step that has been made."""
    y, v, f = motion.y, motion.v, force.reshape(motion.y.shape)
    ny = kick.u.shape[1]
    for c in range(5):
        mobility = kick.u if c < W else kick.w if c == W else kick.phi
        for i in range(span[0], span[1]):
            for j in range(ny):
                dv = mobility[i, j] * f[c, i, j]
                v[c, i, j] += dv
                y[c, i, j] += go * dv


@compiled(nogil=True, borrows=True)
def pull_on_held(span: Span, held: Array, force: Array) -> float:
    """Force along x that nodes with ``held`` (places,) 1 need against the forces (5, places) on some places [N]."""
    total: float = dot(held[span[0] : span[1]], force[U_X, span[0] : span[1]])
    return -total


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
