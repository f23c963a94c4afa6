"""Impulses of all contacts over all sections: projected Gauss-Seidel with Coulomb's cone.

Rows are solved one after the other, part by part (see `halves`), each with what the others have found so far:

    normal    0 <= J_n <= most, so that u_n reaches its target (restitution)
    friction  |(J_t, J_s)| <= mu J_n, against the slip, on both ends
    shift     0 <= J <= J_n, so that overlap recedes; it moves plates without a velocity (split impulse: no energy of
              motion), and pushes no harder than the contact does: what carries nothing is left as it overlaps; on the
              structure as hard as it takes, up to ``most``, that no shift of others moves a plate deeper into it

``most`` is what the ice carries before it crushes. A row that holds (a joint) has no bounds. The sheet's edge answers
to an impulse in one section in all of them, by its matrix, or with its nodes there, see `sheet`.
"""

from __future__ import annotations

import numpy as np

from rubble.arrays import IntArray, Record
from rubble.compiled import compiled
from rubble.edges import Edges, push_edge, push_sheet, sheet_speed
from rubble.halves import DEEP, Halves
from rubble.plates import Plates
from rubble.rows import STRUCTURE, Rows, speed
from rubble.team import TILES, Team, together


@compiled(nogil=True, borrows=True, forceinline=True)
def _push(way: Record, a: Record, b: Record, ma: float, mb: float, j: float) -> None:
    """An impulse j along a direction on b, and the opposite one on a; ``ma``, ``mb`` inverse masses."""
    x, y, z = j * way.x, j * way.y, j * way.z
    b.x += mb * x
    b.y += mb * y
    b.z += mb * z
    b.a += j * way.tb_x
    b.b += j * way.tb_y
    b.c += j * way.tb_z
    if ma > 0.0:
        a.x -= ma * x
        a.y -= ma * y
        a.z -= ma * z
        a.a -= j * way.ta_x
        a.b -= j * way.ta_y
        a.c -= j * way.ta_z


@compiled(nogil=True, borrows=True, forceinline=True)
def _shift(point: Record, n: Record, a: Record, b: Record, ma: float, mb: float, edge: float) -> float:
    """Take out overlap; ``edge``: how fast the sheet's edge recedes along n. Returns the impulse."""
    stopped = point.shift + n.mass * (edge - speed(n, a, b))
    most = max(n.impulse, min(stopped, point.most)) if point.kind == STRUCTURE else n.impulse
    new = max(min(stopped + n.mass * point.shift_speed, most), 0.0)
    j = float(new - point.shift)
    if j != 0.0:
        point.shift = new
        _push(n, a, b, ma, mb, j)
    return j


@compiled(nogil=True, borrows=True, forceinline=True)
def _normal(point: Record, n: Record, a: Record, b: Record, ma: float, mb: float, edge: float) -> float:
    """Normal impulse of one row; ``edge``: speed of the sheet along n. Returns by how much it has changed."""
    new = n.impulse + n.mass * (n.target - speed(n, a, b) + edge)
    if point.mu >= 0.0:
        new = min(max(new, 0.0), point.most)
    j = float(new - n.impulse)
    if j != 0.0:
        n.impulse = new
        _push(n, a, b, ma, mb, j)
    return j


@compiled(nogil=True, borrows=True, forceinline=True)
def _friction(
    ways: tuple[Record, Record, Record],
    mu: float,
    a: Record,
    b: Record,
    ma: float,
    mb: float,
    along: float,
    across: float,
) -> tuple[float, float]:
    """Friction of one row; ``along``, ``across``: speed of the sheet along t and s. Returns by how much both change."""
    n, t, s = ways
    if mu >= 0.0 and n.impulse == 0.0 and t.impulse == 0.0 and s.impulse == 0.0:
        return 0.0, 0.0
    f = t.impulse + t.mass * (t.target - speed(t, a, b) + along)
    g = s.impulse + s.mass * (s.target - speed(s, a, b) + across)
    if mu >= 0.0:
        size, most = np.sqrt(f * f + g * g), mu * n.impulse
        if size > most:
            f, g = f * most / size, g * most / size
    j, k = f - t.impulse, g - s.impulse
    t.impulse, s.impulse = f, g
    _push(t, a, b, ma, mb, j)
    _push(s, a, b, ma, mb, k)
    return j, k


@compiled(nogil=True, borrows=True)
def _warm_start(rows: Rows, part: IntArray, plates: Plates, edges: Edges) -> None:
    """Applies the impulses that rows have kept from the last sub-step."""
    motion, inverse = plates.motion, plates.inverse_mass
    for i in range(part.shape[0]):
        c = part[i]
        point = rows.point[c]
        for d in range(3):
            way = rows.way[c, d]
            if way.impulse != 0.0:
                _push(way, motion[point.a], motion[point.b], inverse[point.a], inverse[point.b], way.impulse)
                if point.edge >= 0:
                    push_sheet(edges, point, way, way.impulse)


@compiled(nogil=True, borrows=True)
def _sweep(rows: Rows, part: IntArray, plates: Plates, edges: Edges, deep: bool) -> None:
    """All rows of a part once."""
    motion, shift, inverse = plates.motion, plates.shift, plates.inverse_mass
    nodes, moves, shifts, yields = edges.nodes, edges.motion, edges.shift, edges.yields
    for at in range(part.shape[0]):
        c = part[at]
        point, n, t, s = rows.point[c], rows.way[c, 0], rows.way[c, 1], rows.way[c, 2]
        i, k, e = point.a, point.b, point.edge
        a, b, ma, mb = motion[i], motion[k], inverse[i], inverse[k]
        if e < 0:
            if deep:
                _shift(point, n, shift[i], shift[k], ma, mb, 0.0)
            _normal(point, n, a, b, ma, mb, 0.0)
            _friction((n, t, s), point.mu, a, b, ma, mb, along=0.0, across=0.0)
            continue
        if deep:
            j = _shift(point, n, shift[i], shift[k], ma, mb, n.x * shifts[e, 0] + n.z * shifts[e, 1])
            if j != 0.0:
                push_edge(yields, shifts, e, -j * n.x, -j * n.z)
        j = _normal(point, n, a, b, ma, mb, sheet_speed(nodes, moves, point, n))
        if j != 0.0:
            push_sheet(edges, point, n, j)
        along, across = sheet_speed(nodes, moves, point, t), sheet_speed(nodes, moves, point, s)
        f, g = _friction((n, t, s), point.mu, a, b, ma, mb, along=along, across=across)
        if f != 0.0 or g != 0.0:
            push_sheet(edges, point, t, f)
            push_sheet(edges, point, s, g)


@compiled(nogil=True, borrows=True)
def begin(rows: Rows, count: int, plates: Plates, edges: Edges, halves: Halves) -> None:
    """The shift of plates, edges and rows starts from none."""
    for i in range(plates.shift.shape[0]):
        own = plates.shift[i]
        own.x = own.y = own.z = own.a = own.b = own.c = 0.0
    edges.shift[:] = 0.0
    halves.ask[DEEP] = 0
    for c in range(count):
        rows.point[c].shift = 0.0
        if rows.point[c].shift_speed > 0.0:
            halves.ask[DEEP] = 1


@compiled(nogil=True, borrows=True)
def solve(team: Team, rows: Rows, halves: Halves, plates: Plates, edges: Edges, iterations: int) -> None:
    """All rows, so many times: each of a team its halves, the first one the seam. `begin` has come before."""
    start, deep = halves.start, halves.ask[DEEP] == 1
    for k in range(-1, iterations):
        for part in range(TILES + 1):
            if part == TILES:
                together(team)
            if part % TILES % team.size == team.member:
                _go_through(k, rows, halves.row[start[part] : start[part + 1]], plates, edges, deep)
        together(team)


@compiled(nogil=True, borrows=True, forceinline=True)
def _go_through(k: int, rows: Rows, part: IntArray, plates: Plates, edges: Edges, deep: bool) -> None:
    """Sweep ``k`` over a part; before the first one, -1, what the rows have kept."""
    if k < 0:
        _warm_start(rows, part, plates, edges)
    else:
        _sweep(rows, part, plates, edges, deep)
