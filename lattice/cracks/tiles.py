"""The parts of a sub-step, each for one half of the rows: what threads of a team do between two meetings.

A part writes to nodes of its own rows and to cells that begin there, and to layered cells of its own, see
`cells.part_of`. Where halves meet, the connections from the last row of the first half are found once, before any node
moves: the first half gathers them, and the second one begins with what they leave to the row behind.
"""

from __future__ import annotations

from typing import NamedTuple

from lattice.compiled import compiled
from lattice.cracks.blocks import add_given
from lattice.cracks.cells import TURNING
from lattice.cracks.lean import book_pull, gather_lean, lean_elastic, overloaded_leaning
from lattice.cracks.motion import Layered, Nodes, give, pull_on_held
from lattice.cracks.slopes import COUNT, GAINED, HOLD, LOSS, POWER
from lattice.explicit.forces import PointForces, Sums, Touch
from lattice.explicit.kernels import (
    CARRIED,
    Span,
    carry_on,
    connections,
    gather,
    pull_of_springs,
    push_within,
)
from lattice.explicit.layout import LANES, LINE, Mesh, Motion
from lattice.explicit.march import dissipated
from lattice.explicit.screen import Screen
from lattice.grid import Array
from lattice.team import TILES, Team


class Tile(NamedTuple):
    """A part of the rows."""

    part: int
    rows: Span  #: of nodes, and of the cells that begin there
    places: Span  #: of these nodes in a row-by-row array; that of the last part goes to its end


@compiled(inline="always")
def tile_of(part: int, nx: int, my: int) -> Tile:
    """Of ``nx`` rows of nodes with ``my`` places each."""
    half = max(1, nx // 2)
    if part == 0:
        return Tile(0, (0, half), (0, half * my))
    return Tile(1, (half, nx), (half * my, (nx + 1) * my))


@compiled(nogil=True, borrows=True)
def look(tile: Tile, stock: bool, nodes: Nodes, mesh: Mesh, layered: Layered) -> None:
    """New slopes of elastic cells, and no force yet; where ``stock`` is taken of damping, velocities are kept."""
    force, before, parts = layered.nodes.force, mesh.before.reshape(5, -1), layered.nodes.parts
    a, b = tile.places
    for c in range(5):
        for n in range(a, b):
            force[c, n] = 0.0
        if stock:
            for n in range(a, b):
                before[c, n] = nodes.v[c, n]
    parts[tile.part, GAINED] = parts[tile.part, POWER] = 0.0
    if layered.leans:
        plane = mesh.intact.plane.reshape(-1)
        parts[tile.part, GAINED] = lean_elastic(tile.part, tile.rows, nodes, plane, layered)


@compiled(nogil=True, borrows=True)
def add_up(tile: Tile, team: Team, motion: Motion, nodes: Nodes, mesh: Mesh, layered: Layered) -> None:
    """All that cells do to nodes, what held ones take of it, and the connections between both halves."""
    on, (a, b), k = layered.nodes, tile.places, tile.part
    if team.size > 1:
        add_given(tile.places, layered.cells.corner[: layered.used], nodes.my, team.given, on.force)
    if layered.leans:
        gather_lean(tile.places, nodes.my, layered)
        for c in range(3):
            for n in range(a, b):
                on.force[c, n] += layered.lean.force[c, n]
    layered.cells.losses[k, TURNING] -= layered.plate.d**2 * on.parts[k, GAINED]
    on.parts[k, HOLD] += pull_of_springs(tile.rows, motion, mesh.intact, mesh.held, mesh.springs)
    on.parts[k, HOLD] += pull_on_held(tile.places, mesh.held.reshape(-1), on.force)
    book_pull(k, tile.places, 0.5 * nodes.dt, nodes.v, layered)
    nx, ny = mesh.kick.u.shape
    if tile.rows[1] < nx:
        connections(tile.rows[1] - 1, ny, motion.y, mesh.intact, mesh.springs, on.lines[TILES])


@compiled(nogil=True, borrows=True)
def take(ny: int, between: Array, rows: Array) -> None:
    """The forces of connections from another room."""
    for line in range(0, CARRIED, LINE):
        for j in range(line, line + LANES + ny):
            rows[j] = between[j]


@compiled(nogil=True, borrows=True)
def sweep_tile(tile: Tile, motion: Motion, mesh: Mesh, lines: Array) -> None:
    """As `kernels.sweep`, of a part."""
    rows, (nx, ny), (first, end) = lines[tile.part], mesh.kick.u.shape, tile.rows
    if first > 0:
        take(ny, lines[TILES], rows)
        carry_on(ny, mesh.springs.lever, rows)
    else:
        rows[CARRIED:] = 0.0
    for i in range(first, end):
        if i + 1 == end and end < nx:
            take(ny, lines[TILES], rows)
        else:
            connections(i, ny, motion.y, mesh.intact, mesh.springs, rows)
        gather(i, ny, motion, mesh.kick, mesh.springs.lever, mesh.pace, rows)


@compiled(nogil=True, borrows=True)
def move(tile: Tile, motion: Motion, mesh: Mesh, load: PointForces, touch: Touch, sums: Sums, layered: Layered) -> None:
    """Nodes go on by a sub-step."""
    go, rows = mesh.pace.go, tile.rows
    sweep_tile(tile, motion, mesh, layered.nodes.lines)
    push_within(rows, load.row, load.column, load.force, motion, mesh.kick, go)
    push_within(rows, touch.row, touch.column, sums.now, motion, mesh.kick, go)
    give(rows, motion, mesh.kick, go, layered.nodes.force)


@compiled(nogil=True, borrows=True)
def take_stock(
    tile: Tile, stock: bool, motion: Motion, nodes: Nodes, mesh: Mesh, screen: Screen, layered: Layered
) -> None:
    """What slopes and, where ``stock`` is taken of it, damping took; faces at their limit."""
    parts, alpha = layered.nodes.parts[tile.part], nodes.alpha
    book_pull(tile.part, tile.places, 0.5 * nodes.dt, nodes.v, layered)
    if stock:
        parts[LOSS] += dissipated(tile.rows, motion, mesh, layered.nodes.lines[tile.part])
        parts[LOSS] += nodes.dt * alpha * parts[POWER]
    parts[COUNT] = overloaded_leaning(tile.rows, motion, mesh.threshold, screen, alpha, layered)
