"""Contacts of all sections as rows of the impulse solver.

Each row has three directions: the normal n from end a to end b, and two along the face, t in the section's plane and s
across it. Ends are plates; structure, sheet and sea bed stand at end a, as the ground, and the sheet's
edge moves on its own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Record, Records, record
from rubble.compiled import compiled
from rubble.edges import Edges, lightness, sheet_speed
from rubble.friction import coefficient, rate_dependent
from rubble.moving import Moving, speed_of_structure
from rubble.physics import RubblePhysics
from rubble.plates import Plates

ICE, STRUCTURE, SHEET, JOINT, BED = 0, 1, 2, 3, 4  #: kinds of rows
KINDS = ("ice", "structure", "sheet", "bed")  #: of those that lose energy
CRUSHES = 1.0 - 1e-9  #: share of the greatest impulse from which a contact crushes
SAME_WAY = 0.99  #: cosine between the normals of a point before and after a sub-step, below which it is another one
STEEPEST = 1e3  #: |n_y| over the rest of a normal beyond which a face counts as parallel to the section
BIAS = 0.9**60.0  #: share of an overlap of ice of 3 m that is left after a second: Chipmunk's
HOLDS = -1.0  #: coefficient of a row that holds whatever pulls at it


#: point x, y, z [m]; coefficient of friction; depth of overlap [m]; greatest normal impulse, impulse of the shift [N s]
#: and the speed that it goes for [m/s]; overlap at which the pair has met, as far as it is left, what of it is crushed
#: ice, and overlap beyond it, which is to be taken out [m]; of a sheet the weight of the node before the point, and the
#: height of the line of nodes over the point by their distance; plates a and b; section whose sheet is end a, else -1;
#: kind, see above; slices a and b, and which point of theirs it is; whether it crushed in the sub-step before, and
#: whether it is found anew; of a sheet the nodes before and behind the point
POINT = record(
    *("x", "y", "z", "mu", "depth", "most", "shift", "shift_speed", "met", "crushed", "owed", "weight", "lever"),
    integers=("a", "b", "edge", "kind", "slot_a", "slot_b", "feature", "crushes", "anew", "front", "rear"),
)
#: one direction of a row: unit vector; arms at a and at b times it [m], and times the inverse inertia; mass that a unit
#: of relative speed moves [kg]; impulse [N s]; speed of b against a that it goes for [m/s]
WAY = record(
    *("x", "y", "z", "a_x", "a_y", "a_z", "b_x", "b_y", "b_z"),
    *("ta_x", "ta_y", "ta_z", "tb_x", "tb_y", "tb_z", "mass", "impulse", "target"),
)


class Rows(NamedTuple):
    """One row per point of contact; room for more than there are."""

    point: Records  #: (c,) POINT
    way: Records  #: (c, 3) WAY along n, t, s


class Surface(NamedTuple):
    """How contacts answer."""

    mu_ice: float  #: ice on ice; negative: rate-dependent
    mu_structure: float
    mu_bed: float
    restitution: float
    bias: float  #: share of an overlap that is taken out in a sub-step
    slop: float  #: overlap that is left alone [m]


def surface_of(p: RubblePhysics) -> Surface:
    """As the physics has it."""
    bias, mu = 1.0 - BIAS ** (p.substep / p.pace), (coefficient(p.mu_ice_ice), coefficient(p.mu_structure))
    return Surface(*mu, p.mu_bed, p.restitution, bias, p.slop)


def room(count: int) -> Rows:
    """Room for so many rows."""
    return Rows(np.zeros(count, POINT), np.zeros((count, 3), WAY))


def grown(rows: Rows, count: int) -> Rows:
    """The same rows with more room behind them."""
    new = room(count)
    for a, b in zip(rows, new, strict=True):
        b[: len(a)] = a
    return new


@compiled(nogil=True, borrows=True, forceinline=True)
def speed(way: Record, a: Record, b: Record) -> float:
    """Speed of b against a, both MOTION, along a direction of a row."""
    found: float = way.x * (b.x - a.x) + way.y * (b.y - a.y) + way.z * (b.z - a.z)
    found += way.b_x * b.a + way.b_y * b.b + way.b_z * b.c
    found -= way.a_x * a.a + way.a_y * a.b + way.a_z * a.c
    return found


@compiled(nogil=True, borrows=True)
def go_on(rows: Rows, c: int, old: Rows, at: int, owed: float, cut: bool) -> None:
    """Row c goes on from row ``at`` of the sub-step before; -1: it is a new point and has ``owed`` to give back [m].

    A point is found anew where it is new, where the slices have been ``cut`` anew and where its normal is another one.
    """
    own, n = rows.point[c], rows.way[c, 0]
    own.owed, own.crushed, own.anew, own.crushes = owed, 0.0, 1, 0
    if at >= 0:
        was, m = old.point[at], old.way[at, 0]
        own.met, own.crushed, own.owed = was.met, was.crushed, was.owed
        own.crushes = 1 if max(m.impulse, was.shift) >= CRUSHES * was.most else 0
        own.anew = 1 if cut or n.x * m.x + n.y * m.y + n.z * m.z < SAME_WAY else 0
    for d in range(3):
        rows.way[c, d].impulse = old.way[at, d].impulse if at >= 0 else 0.0


@compiled(nogil=True, borrows=True)
def set_way(way: Record, x: float, y: float, z: float) -> None:
    """A direction."""
    way.x, way.y, way.z = x, y, z


@compiled(nogil=True, borrows=True)
def set_normal(rows: Rows, c: int, x: float, y: float, z: float) -> float:
    """Directions of row c from a normal of any length: it, in the section's plane across it, across both.

    Returns the inverse of its length.
    """
    h = max(np.hypot(x, z), abs(y) / STEEPEST)
    inverse: float = 1.0 / np.hypot(h, y)
    ux, uy, uz, px, pz = x * inverse, y * inverse, z * inverse, x / h, z / h
    set_way(rows.way[c, 0], ux, uy, uz)
    set_way(rows.way[c, 1], -pz, 0.0, px)
    set_way(rows.way[c, 2], uy * px, -uz * pz - ux * px, uy * pz)
    return inverse


@compiled(nogil=True, borrows=True, forceinline=True)
def set_arms(rows: Rows, c: int, plates: Plates, edges: Edges) -> None:
    """Arms and effective masses of row c from its point, its ends and its directions."""
    point = rows.point[c]
    i, k, e = point.a, point.b, point.edge
    position, world, inverse = plates.position, plates.world, plates.inverse_mass
    ma, mb = inverse[i], inverse[k]
    xa, ya, za = point.x - position[i, 0], point.y - position[i, 1], point.z - position[i, 2]
    xb, yb, zb = point.x - position[k, 0], point.y - position[k, 1], point.z - position[k, 2]
    for d in range(3):
        way = rows.way[c, d]
        ux, uy, uz = way.x, way.y, way.z
        total = ma + mb
        px, py, pz = yb * uz - zb * uy, zb * ux - xb * uz, xb * uy - yb * ux
        way.b_x, way.b_y, way.b_z = px, py, pz
        qx = world[k, 0, 0] * px + world[k, 0, 1] * py + world[k, 0, 2] * pz
        qy = world[k, 1, 0] * px + world[k, 1, 1] * py + world[k, 1, 2] * pz
        qz = world[k, 2, 0] * px + world[k, 2, 1] * py + world[k, 2, 2] * pz
        way.tb_x, way.tb_y, way.tb_z = qx, qy, qz
        total += px * qx + py * qy + pz * qz
        if ma > 0.0:
            px, py, pz = ya * uz - za * uy, za * ux - xa * uz, xa * uy - ya * ux
            qx = world[i, 0, 0] * px + world[i, 0, 1] * py + world[i, 0, 2] * pz
            qy = world[i, 1, 0] * px + world[i, 1, 1] * py + world[i, 1, 2] * pz
            qz = world[i, 2, 0] * px + world[i, 2, 1] * py + world[i, 2, 2] * pz
            total += px * qx + py * qy + pz * qz
        else:
            px = py = pz = qx = qy = qz = 0.0
        way.a_x, way.a_y, way.a_z, way.ta_x, way.ta_y, way.ta_z = px, py, pz, qx, qy, qz
        if e >= 0:
            total += lightness(edges, point, ux, uy, uz)
        way.mass = 1.0 / total


@compiled(nogil=True, borrows=True, forceinline=True)
def set_law(rows: Rows, c: int, plates: Plates, edges: Edges, moving: Moving, surface: Surface, dt: float) -> None:
    """Friction, restitution and shift of row c; the motion is that before the forces of the sub-step.

    Against a structure that moves the speed to go for is that of its surface.

    What a contact gives back is the overlap into which its ends have moved. Pieces of ice that two planes do not both
    see may be found deep in each other when one of them comes into a plane; a slice that is cut anew, or pushed along
    another of its faces, is found deeper or less deep at once. They have met in between: to push them apart would lift
    ice by as much as they overlap. They may stay as deep as they have met and get no deeper. Where ice crushes, the
    overlap is crushed ice and nothing pushes it out either.
    """
    motion, nodes, moves = plates.motion, edges.nodes, edges.motion
    point, n, t, s = rows.point[c], rows.way[c, 0], rows.way[c, 1], rows.way[c, 2]
    a, b = motion[point.a], motion[point.b]
    goes_n = goes_t = goes_s = 0.0
    if point.kind == STRUCTURE:
        goes_n, goes_t = speed_of_structure(moving, point, n), speed_of_structure(moving, point, t)
        goes_s = speed_of_structure(moving, point, s)
    u = speed(n, a, b) - sheet_speed(nodes, moves, point, n) - goes_n
    mu = surface.mu_structure if point.kind == STRUCTURE else surface.mu_ice
    mu = surface.mu_bed if point.kind == BED else mu
    if mu < 0.0:
        v = speed(t, a, b) - sheet_speed(nodes, moves, point, t) - goes_t
        w = speed(s, a, b) - sheet_speed(nodes, moves, point, s) - goes_s
        mu = rate_dependent(np.sqrt(v * v + w * w))
    point.mu = mu
    n.target, t.target, s.target = goes_n - surface.restitution * u, goes_t, goes_s
    over = max(point.depth - surface.slop, 0.0)
    if point.anew:
        both = u + speed(n, plates.shift[point.a], plates.shift[point.b])
        point.met = max(over - point.owed - dt * max(-both, 0.0), 0.0)
    if point.crushes:
        point.crushed, point.met = point.crushed + max(over - point.met, 0.0), over
    point.met = min(point.met, over)
    point.crushed = min(point.crushed, point.met)
    point.owed = over - point.met
    point.shift_speed = surface.bias * point.owed / dt
