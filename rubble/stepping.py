"""The loop over the sub-steps of a window, compiled: move, find contacts, forces, solve, without Python in between.

Threads of a team all call it. The first one goes through the sub-steps; the others wait, and do their share of what it
asks for (`Halves.ask`): to find pairs, section by section, to set arms and laws of rows, and to solve the rows of a
large pile, half by half.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Records
from rubble.banks import Banks, bank_rows
from rubble.bed import bed_rows
from rubble.bending import Loaded, sum_bending
from rubble.books import book_contacts, book_step, book_structure, kick, outside, sum_contacts
from rubble.compiled import compiled
from rubble.edges import Edges, push_edge
from rubble.gather import Scene, gather
from rubble.halves import TASK, Halves, divide
from rubble.joints import Joints, joint_rows
from rubble.moving import move_structure
from rubble.pairs import find_pairs
from rubble.plates import Plates, move_all
from rubble.prisms import round_rows
from rubble.rows import Rows, Surface, set_arms, set_law
from rubble.sides import Sides, side_rows
from rubble.slices import CORNERS
from rubble.solver import begin, solve
from rubble.team import Team, together
from rubble.water import Hulls, Water, fill_tops, plate_forces

#: what went wrong: a list of pairs was too short, a contact with an unknown body, too few rows
TOO_MANY, STRANGE, NO_ROOM = -1, -2, -3
FIND, SET, SOLVE, END = 0, 1, 2, 3  #: what the others of a team are asked to do


class Window(NamedTuple):
    """A window of sub-steps."""

    iterations: int
    surface: Surface
    water: Water
    hulls: Hulls
    thrust: Array  #: (n, 6) constant force and moment beside the weight [N, N m]
    sides: Sides
    banks: Banks
    joints: Joints
    loaded: Loaded
    planar: bool  #: plates keep their y, and do not roll or yaw


class Sums(NamedTuple):
    """All that is summed over sub-steps."""

    plate: Array  #: (n, 9) `store.ON_PLATE`
    books: Records  #: (1,) BOOKS
    water: Records  #: (1,) WATER_IMPULSE
    pressure: Array  #: (n, 6) of the last sub-step [N, N m]
    momenta: Array  #: (4, 6) that plates receive, see `books`
    counted: IntArray  #: (3,) rows of the last sub-step; its number; rows that are contacts


@compiled(nogil=True)
def advance_substeps(
    team: Team, n: int, window: Window, scene: Scene, even: Rows, odd: Rows, halves: Halves, sums: Sums
) -> int:
    """Do ``n`` sub-steps; returns how many were done, fewer where a list must grow first.

    A sub-step that found no room has moved the plates, and is gone on with: its contacts are found once more.
    """
    if team.member > 0:
        _help(team, window, scene, even, odd, halves, sums.counted)
        return 0
    plates, edges, dt, books = scene.plates, scene.edges, scene.dt, sums.books[0]
    count = plates.moved.shape[0] - 1
    forces, lowest, corners, done = np.empty((count, 3, 6)), np.empty(count), np.empty((CORNERS, 2)), 0
    for k in range(n):
        books.stepping += move_all(plates, dt)
        _move_sheet(edges, dt)
        move_structure(scene.moving, dt)
        _ask(team, FIND, halves)
        find_pairs(team, scene)
        stamp = sums.counted[1] + 1
        cut = stamp == scene.cut
        rows, old = (even, odd) if stamp % 2 == 0 else (odd, even)
        gathered = contacts = gather(scene, rows, old, stamp)
        if contacts >= 0:
            contacts = side_rows(scene, window.sides, rows, old, contacts, sums.counted[0], cut)
        if contacts >= 0:
            contacts = bank_rows(scene, window.banks, rows, old, contacts, sums.counted[0], cut)
        if contacts >= 0:
            contacts = round_rows(scene, rows, old, contacts, sums.counted[0])
        if contacts >= 0:
            contacts = bed_rows(scene, (rows, old), contacts, sums.counted[0], cut and not window.planar, corners)
        found = joint_rows(scene, window.joints, rows, old, contacts, sums.counted[0]) if contacts >= 0 else -1
        if found < 0:
            done = gathered if gathered < 0 else NO_ROOM
            break
        sums.counted[0], sums.counted[1], sums.counted[2] = found, stamp, contacts
        _ask(team, SET, halves)
        _set_rows(team, scene, rows, sums.counted, window.surface)
        plate_forces(plates, window.hulls, window.water, forces, lowest)
        _sum_water(forces, dt, sums.water)
        outside(plates, window.hulls, forces, dt, sums.momenta)
        before = plates.motion.copy(), edges.nodes.copy(), edges.motion.copy()
        kick(plates, window.hulls, window.thrust, forces, sums.pressure, dt, books)
        fill_tops(plates, window.water, lowest, dt)
        _kick_sheet(edges, dt)
        _flatten(plates, window.planar)
        divide(scene, rows, found, halves)
        begin(rows, found, plates, edges, halves)
        _ask(team, SOLVE, halves)
        solve(team, rows, halves, plates, edges, window.iterations)
        _flatten(plates, window.planar)
        book_step(forces, before[0], plates, dt, books)
        _book(rows, found, before, scene, window.loaded, sums)
        done = k + 1
        if found > 0 and 2 * found > rows.point.shape[0]:
            break
    _ask(team, END, halves)
    return done


@compiled(nogil=True, borrows=True)
def _ask(team: Team, task: int, halves: Halves) -> None:
    """The first of a team begins a task with the others."""
    halves.ask[TASK] = task
    together(team)


@compiled(nogil=True, borrows=True)
def _help(team: Team, window: Window, scene: Scene, even: Rows, odd: Rows, halves: Halves, counted: IntArray) -> None:
    """What the others of a team do, until the first one has done all sub-steps."""
    while True:
        together(team)
        task, rows = halves.ask[TASK], even if counted[1] % 2 == 0 else odd
        if task == END:
            return
        if task == SOLVE:
            solve(team, rows, halves, scene.plates, scene.edges, window.iterations)
        elif task == FIND:
            find_pairs(team, scene)
        else:
            _set_rows(team, scene, rows, counted, window.surface)


@compiled(nogil=True, borrows=True)
def _set_rows(team: Team, scene: Scene, rows: Rows, counted: IntArray, surface: Surface) -> None:
    """Arms of all rows and laws of contacts: each of a team its share."""
    found, contacts = counted[0], counted[2]
    for c in range(found * team.member // team.size, found * (team.member + 1) // team.size):
        set_arms(rows, c, scene.plates, scene.edges)
        if c < contacts:
            set_law(rows, c, scene.plates, scene.edges, scene.moving, surface, scene.dt)
    together(team)


@compiled(nogil=True, borrows=True)
def _book(
    rows: Rows, count: int, before: tuple[Records, Records, Array], scene: Scene, loaded: Loaded, sums: Sums
) -> None:
    """What contacts have done in a sub-step; ``before`` as in `book_contacts`."""
    book_contacts(rows, count, before, scene.plates, scene.edges, scene.moving, sums.books[0])
    book_structure(rows, count, scene.moving)
    sum_contacts(rows, count, sums.plate, scene.edges.nodes, sums.momenta)
    sum_bending(rows, count, scene.plates, loaded)


@compiled(nogil=True, borrows=True)
def _move_sheet(edges: Edges, dt: float) -> None:
    """Nodes move with the sheet and with the edge that yields."""
    for e in range(edges.motion.shape[0]):
        x, z = edges.motion[e, 0] + edges.shift[e, 0], edges.motion[e, 1] + edges.shift[e, 1]
        for k in range(edges.offset[e], edges.offset[e + 1]):
            node = edges.nodes[k]
            node.x += dt * (node.v_x + x)
            node.z += dt * (node.v_z + z)


@compiled(nogil=True, borrows=True)
def _kick_sheet(edges: Edges, dt: float) -> None:
    """Velocities after what the lattice does in a sub-step."""
    for k in range(edges.nodes.shape[0]):
        node = edges.nodes[k]
        node.v_x, node.v_y, node.v_z = node.v_x + node.gain_x, node.v_y + node.gain_y, node.v_z + node.gain_z
    for e in range(edges.motion.shape[0]):
        if edges.yields.shape[1] > 0:
            push_edge(edges.yields, edges.motion, e, -dt * edges.carried[e, 0], -dt * edges.carried[e, 1])


@compiled(nogil=True, borrows=True)
def _sum_water(forces: Array, dt: float, sums: Records) -> None:
    """Adds the impulses of the water on all plates, x and z."""
    out = sums[0]
    for i in range(forces.shape[0]):
        out.flooded_x += dt * forces[i, 0, 0]
        out.flooded_z += dt * forces[i, 0, 2]
        out.dry_x += dt * forces[i, 1, 0]
        out.dry_z += dt * forces[i, 1, 2]
        out.drag_x += dt * forces[i, 2, 0]
        out.drag_z += dt * forces[i, 2, 2]


@compiled(nogil=True, borrows=True)
def _flatten(plates: Plates, planar: bool) -> None:
    """Takes what leads out of the plane from all motions, where they are ``planar``."""
    for i in range(plates.moved.shape[0] - 1 if planar else 0):
        v, s = plates.motion[i], plates.shift[i]
        v.y = v.a = v.c = s.y = s.a = s.c = 0.0
