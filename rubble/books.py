"""Where the energy of the rubble goes, sub-step by sub-step; exact for what the solver does.

A sub-step moves every plate by (v_0 + b) dt, b the shift that takes out overlap, then kicks it with its force F and
solves the contacts: v_1 = v_0 + (F dt + sum J) / M. Kinetic energy is a square, so in the sum over plates

    forces    F dt . (v_0 + v_1) / 2 = F . v_0 dt + F dt . (v_1 - v_0) / 2
    contacts  J . (u_0 + u_1) / 2 each, u the velocity of its point

whatever the order in which the solver has found the impulses J. F . v_0 is the power of weight, water and drag. The
second part, and that the pressure is taken at the end of the way and not all along it, come from the step being finite:
*stepping*, as is what turning with a constant angular momentum does; at rest it is zero. The shift b dt moves a plate
against its weight and the pressure without any velocity: *correction*. M counts the added mass.
"""

from __future__ import annotations

import numpy as np

from rubble.arrays import Array, Record, Records, record
from rubble.compiled import compiled
from rubble.edges import Edges, sheet_speed
from rubble.moving import Moving, speed_of_structure
from rubble.plates import Plates
from rubble.rows import BED, ICE, JOINT, SHEET, STRUCTURE, Rows, speed
from rubble.water import Hulls

#: since the start [J]: put in by stepping, by correction, by thrust; done by plates on the sheet; lost to drag; work of
#: dry tops; lost in contacts by kind (`rows.KINDS`), along the normal and to friction
BOOKS = record(
    *("stepping", "correction", "thrust", "on_sheet", "drag_loss", "dry_work"),
    *("impact_ice", "impact_structure", "impact_sheet", "friction_ice", "friction_structure", "friction_sheet"),
    *("impact_bed", "friction_bed"),
)
#: rows of the momenta that plates receive from outside since the start, x, y, z and about the origin [N s], [N m s]:
#: from structure, sheet and joints; from water, weight and thrust; angular momentum that comes as a shift moves mass;
#: from the sea bed
CONTACT, WATER, SHIFT, GROUND = 0, 1, 2, 3


@compiled(nogil=True, borrows=True)
def _power(forces: Array, i: int, k: int, v: Record) -> float:
    """Of force k on plate i, with its moment, at a MOTION."""
    total: float = forces[i, k, 0] * v.x + forces[i, k, 1] * v.y + forces[i, k, 2] * v.z
    total += forces[i, k, 3] * v.a + forces[i, k, 4] * v.b + forces[i, k, 5] * v.c
    return total


@compiled(nogil=True, borrows=True)
def _add_momenta(out: Array, row: int, px: float, py: float, pz: float, x: float, y: float, z: float) -> None:
    """Add an impulse (x, y, z) at a point, and its moment about the origin."""
    out[row, 0], out[row, 1], out[row, 2] = out[row, 0] + x, out[row, 1] + y, out[row, 2] + z
    out[row, 3] += py * z - pz * y
    out[row, 4] += pz * x - px * z
    out[row, 5] += px * y - py * x


@compiled(nogil=True, borrows=True)
def outside(plates: Plates, hulls: Hulls, forces: Array, dt: float, momenta: Array) -> None:
    """Adds the momenta (4, 6) that plates receive in a sub-step from water and weight, and by their shift."""
    for i in range(plates.moved.shape[0] - 1):
        own, still, turn = forces[i], hulls.weight[i], hulls.moment[i]
        fx = own[0, 0] + own[1, 0] + own[2, 0] + still[0]
        fy = own[0, 1] + own[1, 1] + own[2, 1] + still[1]
        fz = own[0, 2] + own[1, 2] + own[2, 2] + still[2]
        at, v, s, m = plates.position[i], plates.motion[i], plates.shift[i], plates.moved[i]
        _add_momenta(momenta, WATER, at[0], at[1], at[2], x=dt * fx, y=dt * fy, z=dt * fz)
        for d in range(3):
            momenta[WATER, 3 + d] += dt * (own[0, 3 + d] + own[1, 3 + d] + own[2, 3 + d] + turn[d])
        momenta[SHIFT, 3] += dt * m * (s.y * v.z - s.z * v.y)
        momenta[SHIFT, 4] += dt * m * (s.z * v.x - s.x * v.z)
        momenta[SHIFT, 5] += dt * m * (s.x * v.y - s.y * v.x)


@compiled(nogil=True)
def kick(plates: Plates, hulls: Hulls, thrust: Array, forces: Array, pressure: Array, dt: float, books: Record) -> None:
    """Velocities after the forces of a sub-step, and what it books.

    ``forces`` (n, 3, 6) from `water.plate_forces`, used up; ``pressure`` (n, 6) is that of the sub-step before, nan if
    there was none, and becomes the one of this; ``thrust`` (n, 6) beside the weight.
    """
    still = np.empty((1, 3, 6))  # mean of weight, thrust and pressure; growth of the pressure; thrust alone
    for i in range(plates.moved.shape[0] - 1):
        v, shift, m, world = plates.motion[i], plates.shift[i], plates.inverse_mass[i], plates.world
        known = pressure[i, 0] == pressure[i, 0]
        for d in range(6):
            own = hulls.weight[i, d] if d < 3 else hulls.moment[i, d - 3]
            now = forces[i, 0, d]
            before = pressure[i, d] if known else now
            still[0, 0, d], still[0, 1, d], still[0, 2, d] = 0.5 * (now + before) + own, now - before, thrust[i, d]
            pressure[i, d] = now
            forces[i, 0, d] = now + forces[i, 1, d] + forces[i, 2, d] + own
        books.stepping += 0.5 * dt * _power(still, 0, 1, v)
        books.correction -= dt * _power(still, 0, 0, shift)
        books.thrust += dt * (_power(still, 0, 2, v) + _power(still, 0, 2, shift))
        books.dry_work += dt * _power(forces, i, 1, v)
        books.drag_loss -= dt * _power(forces, i, 2, v)
        fx, fy, fz = forces[i, 0, 0], forces[i, 0, 1], forces[i, 0, 2]
        tx, ty, tz = forces[i, 0, 3], forces[i, 0, 4], forces[i, 0, 5]
        x = world[i, 0, 0] * tx + world[i, 0, 1] * ty + world[i, 0, 2] * tz
        y = world[i, 1, 0] * tx + world[i, 1, 1] * ty + world[i, 1, 2] * tz
        z = world[i, 2, 0] * tx + world[i, 2, 1] * ty + world[i, 2, 2] * tz
        v.x, v.y, v.z = v.x + dt * m * fx, v.y + dt * m * fy, v.z + dt * m * fz
        v.a, v.b, v.c = v.a + dt * x, v.b + dt * y, v.c + dt * z


@compiled(nogil=True, borrows=True)
def book_step(forces: Array, before: Records, plates: Plates, dt: float, books: Record) -> None:
    """Adds what the whole forces (n, 0, 6) that `kick` has left do for the change of the motion since ``before``."""
    total = 0.0
    for i in range(plates.moved.shape[0] - 1):
        total += _power(forces, i, 0, plates.motion[i]) - _power(forces, i, 0, before[i])
    books.stepping += 0.5 * dt * total


@compiled(nogil=True, borrows=True)
def book_contacts(
    rows: Rows,
    count: int,
    before: tuple[Records, Records, Array],
    plates: Plates,
    edges: Edges,
    moving: Moving,
    books: Record,
) -> None:
    """Adds what each contact of a sub-step takes.

    ``before``: the motions of plates (n + 1,), of nodes of the sheet and of edges (e, 2) before forces and contacts.
    """
    motion, nodes, moves = plates.motion, edges.nodes, edges.motion
    plates_before, nodes_before, moves_before = before
    for c in range(count):
        point = rows.point[c]
        i, k = point.a, point.b
        lost = rubbed = 0.0
        for d in range(3):
            way = rows.way[c, d]
            if way.impulse == 0.0:
                continue
            on_edge = sheet_speed(nodes_before, moves_before, point, way) + sheet_speed(nodes, moves, point, way)
            on_edge *= 0.5
            mean = 0.5 * (speed(way, plates_before[i], plates_before[k]) + speed(way, motion[i], motion[k]))
            books.on_sheet -= way.impulse * on_edge
            if point.kind == STRUCTURE:
                on_edge = speed_of_structure(moving, point, way)
            if d == 0:
                lost -= way.impulse * (mean - on_edge)
            else:
                rubbed -= way.impulse * (mean - on_edge)
        if point.kind == STRUCTURE:
            books.impact_structure += lost
            books.friction_structure += rubbed
        elif point.kind == SHEET:
            books.impact_sheet += lost
            books.friction_sheet += rubbed
        elif point.kind == BED:
            books.impact_bed += lost
            books.friction_bed += rubbed
        else:
            books.impact_ice += lost
            books.friction_ice += rubbed


@compiled(nogil=True, borrows=True)
def sum_contacts(rows: Rows, count: int, sums: Array, nodes: Records, momenta: Array) -> None:
    """Adds the impulses of a sub-step to ``sums`` (n, 9) of the plates, to nodes of the sheet, to what comes in."""
    for c in range(count):
        point, n, t, s = rows.point[c], rows.way[c, 0], rows.way[c, 1], rows.way[c, 2]
        k, push, kind = point.b, n.impulse, point.kind
        if push == 0.0 and kind != JOINT:
            continue
        x = push * n.x + t.impulse * t.x + s.impulse * s.x
        y = push * n.y + t.impulse * t.y + s.impulse * s.y
        z = push * n.z + t.impulse * t.z + s.impulse * s.z
        if kind != ICE:
            row = GROUND if kind == BED else CONTACT
            _add_momenta(momenta, row, point.x, point.y, point.z, x=x, y=y, z=z)
        if kind == STRUCTURE:
            sums[k, 0], sums[k, 1], sums[k, 2] = sums[k, 0] - x, sums[k, 1] - y, sums[k, 2] - z
            sums[k, 5], sums[k, 6] = sums[k, 5] + push, sums[k, 6] + push * point.x
            sums[k, 7], sums[k, 8] = sums[k, 7] + push * point.y, sums[k, 8] + push * point.z
        elif kind not in (JOINT, BED):
            sums[k, 3] += push
            if kind == SHEET:
                sums[k, 4] += push
                _on_nodes(nodes, point, -x, -y, -z)
            else:
                sums[point.a, 3] += push


@compiled(nogil=True, borrows=True)
def _on_nodes(nodes: Records, at: Record, x: float, y: float, z: float) -> None:
    """Divide an impulse (x, y, z) on the sheet between the two nodes next to it, see `rows.locate`."""
    front, rear, w = nodes[at.front], nodes[at.rear], at.weight
    front.impulse_x += w * x
    front.impulse_y += w * y
    front.impulse_z += w * z + x * at.lever
    rear.impulse_x += (1.0 - w) * x
    rear.impulse_y += (1.0 - w) * y
    rear.impulse_z += (1.0 - w) * z - x * at.lever


@compiled(nogil=True, borrows=True)
def book_structure(rows: Rows, count: int, moving: Moving) -> None:
    """Impulses of a sub-step on the structure, with their moments, and what it does on plates by moving."""
    out, d = moving.wrench, moving.place
    for c in range(count):
        point = rows.point[c]
        if point.kind != STRUCTURE:
            continue
        x = y = z = 0.0
        for k in range(3):
            way = rows.way[c, k]
            x, y, z = x - way.impulse * way.x, y - way.impulse * way.y, z - way.impulse * way.z
            moving.work[0] += way.impulse * speed_of_structure(moving, point, way)
        rx, ry, rz = point.x - d[0], point.y - d[1], point.z - d[2]
        out[0], out[1], out[2] = out[0] + x, out[1] + y, out[2] + z
        out[3] += ry * z - rz * y
        out[4] += rz * x - rx * z
        out[5] += rx * y - ry * x
