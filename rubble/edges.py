"""The sheet in the contact solver: its nodes in all sections, and edges that yield beside them; see `sheet`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Record, Records
from rubble.compiled import compiled


class Edges(NamedTuple):
    """The sheet in all sections: its nodes, and the edges that yield beside them, see `sheet`."""

    nodes: Records  #: NODE of all sections with a sheet, foremost first
    offset: IntArray  #: (e + 1,) section e owns nodes[offset[e]:offset[e + 1]]
    motion: Array  #: (e, 2) velocity with which an edge yields, x and z [m/s]
    shift: Array  #: (e, 2) see `plates.Plates.shift`
    carried: Array  #: (e, 2) forces that the lattice knows [N]
    yields: Array  #: (2, e, e) velocity in x, and in z, of each for an impulse on each [1/kg]; (2, 0, 0) in lockstep
    body: IntArray  #: (e,) address of its body in pymunk; 0 where there is no sheet


def still_edges(nodes: Records, offset: IntArray, *, yielding: bool) -> Edges:
    """Edges of sections with these nodes that do not move beside them."""
    count = len(offset) - 1
    motion, shift, carried = (np.zeros((count, 2)) for _ in range(3))
    side = count if yielding else 0
    return Edges(nodes, offset, motion, shift, carried, np.zeros((2, side, side)), np.zeros(count, np.int64))


@compiled(nogil=True, borrows=True)
def locate(point: Record, nodes: Records, first: int, end: int) -> None:
    """The nodes first to end of the sheet between which a point lies; beyond the ends the line goes on straight.

    Linear weights along x keep the moment of a vertical force. A horizontal force acts off the line of the nodes; its
    moment goes into a pair of vertical forces.
    """
    k = first
    while k < end - 2 and point.x < nodes[k + 1].x:
        k += 1
    point.front, point.rear, point.weight, point.lever = k, k, 1.0, 0.0
    if end - first > 1:
        front, rear = nodes[k], nodes[k + 1]
        span = front.x - rear.x
        w = (point.x - rear.x) / span
        point.rear, point.weight, point.lever = k + 1, w, (w * front.z + (1.0 - w) * rear.z - point.z) / span


@compiled(nogil=True, borrows=True)
def between(
    point: Record, front: tuple[float, float], rear: tuple[float, float], origin: float = 0.0
) -> tuple[float, float]:
    """What two nodes do along x, from ``origin`` on, and z, as a point of the sheet does it.

    Its sections stay plane and turn: speed and place of a contact must both be of this, or what the one keeps apart
    the other finds overlapping.
    """
    w = point.weight
    x = w * front[0] + (1.0 - w) * rear[0] - origin + point.lever * (front[1] - rear[1])
    return x, w * front[1] + (1.0 - w) * rear[1]


@compiled(nogil=True, borrows=True)
def sheet_speed(nodes: Records, moves: Array, point: Record, way: Record) -> float:
    """Speed of the sheet's end of a row along one of its directions; ``moves`` as `Edges.motion`."""
    if point.edge < 0:
        return 0.0
    f, r, w, e = nodes[point.front], nodes[point.rear], point.weight, point.edge
    x, z = between(point, (f.v_x, f.v_z), (r.v_x, r.v_z))
    x, y, z = x + moves[e, 0], w * f.v_y + (1.0 - w) * r.v_y, z + moves[e, 1]
    found: float = x * way.x + y * way.y + z * way.z
    return found


@compiled(nogil=True, borrows=True)
def push_edge(yields: Array, motion: Array, e: int, x: float, z: float) -> None:
    """An impulse (x, z) of the rubble on the sheet in section e moves the edge in all sections."""
    for f in range(yields.shape[1]):
        motion[f, 0] += yields[0, e, f] * x
        motion[f, 1] += yields[1, e, f] * z


@compiled(nogil=True, borrows=True)
def push_sheet(edges: Edges, point: Record, way: Record, j: float) -> None:
    """An impulse j along a direction on the plate of a row, and the opposite one on its sheet."""
    x, y, z = -j * way.x, -j * way.y, -j * way.z
    f, r, w = edges.nodes[point.front], edges.nodes[point.rear], point.weight
    f.v_x += f.light_x * w * x
    f.v_y += f.light_y * w * y
    f.v_z += f.light_z * (w * z + point.lever * x)
    r.v_x += r.light_x * (1.0 - w) * x
    r.v_y += r.light_y * (1.0 - w) * y
    r.v_z += r.light_z * ((1.0 - w) * z - point.lever * x)
    push_edge(edges.yields, edges.motion, point.edge, x, z)


@compiled(nogil=True, borrows=True)
def lightness(edges: Edges, point: Record, x: float, y: float, z: float) -> float:
    """Speed of the sheet's end of a row along (x, y, z) for a unit impulse there."""
    f, r, w, e = edges.nodes[point.front], edges.nodes[point.rear], point.weight, point.edge
    u, couple = 1.0 - w, point.lever * x
    total = w * w * (f.light_x * x * x + f.light_y * y * y) + u * u * (r.light_x * x * x + r.light_y * y * y)
    total += f.light_z * (w * z + couple) ** 2 + r.light_z * (u * z - couple) ** 2
    if edges.yields.shape[1] > 0:
        total += x * x * edges.yields[0, e, e] + z * z * edges.yields[1, e, e]
    return float(total)


@compiled(nogil=True, borrows=True)
def deeper_on_sheet(edges: Edges, section: int, point: Record, nx: float, nz: float) -> float:
    """By how much a contact with the sheet is deeper than with its outline: nodes have moved since that was made."""
    nodes, first = edges.nodes, edges.offset[section]
    locate(point, nodes, first, edges.offset[section + 1])
    foremost, f, r = nodes[first], nodes[point.front], nodes[point.rear]
    front, rear = (f.x - f.outline_x, f.z - f.outline_z), (r.x - r.outline_x, r.z - r.outline_z)
    x, z = between(point, front, rear, foremost.x)
    return float(x * nx + (z - foremost.z) * nz)
