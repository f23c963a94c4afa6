"""The law evaluated in a layered cell: new states of its layers, a new tangent, and what that took."""

from __future__ import annotations

import math

from lattice.compiled import compiled
from lattice.cracks.cells import (
    BENDING,
    COUPLING,
    CRACKING,
    CRUSHING,
    FACE,
    HELD,
    MEMBRANE,
    OFFSET,
    RUBBING,
    SKEW,
    SKEW_TURN,
    STIFF,
    SWITCHING,
    TURN,
    Cracks,
    Plate,
    edge_energy,
    edge_forces,
    forces,
    part_of,
    place,
    resultants,
    tangent_energy,
)
from lattice.cracks.kinematics import Edges, Pose, Strain, leaned, pose_of, turned, turned_back
from lattice.cracks.law import CrackLaw, N, T
from lattice.cracks.layers import HISTORY, Answer, Tangent, follow_all, sums
from lattice.explicit.layout import LANES
from lattice.grid import Array

Resultants = tuple[float, float, float, float, float, float]


@compiled(inline="always")
def write(line: int, at: int, values: tuple[float, ...], linear: Array) -> None:
    """Values of the cell at ``at`` into the lines from ``line`` on."""
    for i in range(len(values)):
        linear[line + LANES * i + at] = values[i]


@compiled(inline="always")
def tangent_in_sheet(t: Tangent, c: float, s: float) -> Resultants:
    """T' t T with T that turns strains by the angle of cosine c and sine s, the six entries as in ``Cracks.linear``."""
    cc, ss, cs, two = c * c, s * s, c * s, c * c - s * s
    n_x, n_y, n_s = t.nn * cc + t.nt * ss, t.nn * ss + t.nt * cc, (t.nn - t.nt) * cs
    t_x, t_y, t_s = t.nt * cc + t.tt * ss, t.nt * ss + t.tt * cc, (t.nt - t.tt) * cs
    g_x, g_y, g_s = -2.0 * cs * t.gg, 2.0 * cs * t.gg, two * t.gg
    return (
        cc * n_x + ss * t_x - 2.0 * cs * g_x,
        cc * n_y + ss * t_y - 2.0 * cs * g_y,
        cc * n_s + ss * t_s - 2.0 * cs * g_s,
        ss * n_y + cc * t_y + 2.0 * cs * g_y,
        ss * n_s + cc * t_s + 2.0 * cs * g_s,
        cs * (n_s - t_s) + two * g_s,
    )


@compiled(inline="always")
def answer(k: int, e: Strain, h: float, law: CrackLaw, cracks: Cracks) -> Answer:
    """Of the layers of cell k at a strain in the axes of its crack; their states go on."""
    stack, history = cracks.stack[part_of(k)], cracks.history
    for i in range(HISTORY):
        stack[i] = history[k, i]
    follow_all(e, h, law, stack)
    for i in range(HISTORY):
        history[k, i] = stack[i]
    a: Answer = sums(h, law, stack)
    cracks.thrust[k, N], cracks.thrust[k, T] = a.thrust
    return a


@compiled(inline="always")
def renew_tangent(at: int, e: Strain, axis: tuple[float, float], a: Answer, linear: Array) -> Resultants:
    """Tangent and offset of the cell at ``at`` from the answer at a strain; its N and M, in the axes of the sheet."""
    c, s = axis
    write(MEMBRANE, at, tangent_in_sheet(a.membrane, c, s), linear)
    write(COUPLING, at, tangent_in_sheet(a.coupling, c, s), linear)
    write(BENDING, at, tangent_in_sheet(a.bending, c, s), linear)
    f, made = a.force, forces(at, e, linear)
    n, m = turned_back(f[0], f[1], f[2], c, s), turned_back(f[3], f[4], f[5], c, s)
    write(OFFSET, at, (n[0] - made[0], n[1] - made[1], n[2] - made[2]), linear)
    write(TURN, at, (m[0] - made[3], m[1] - made[4], m[2] - made[5]), linear)
    return n[0], n[1], n[2], m[0], m[1], m[2]


@compiled(inline="always")
def slide(k: int, long: Edges, limit: float, plate: Plate, cracks: Cracks) -> tuple[float, float]:
    """New tangent of the edge springs, whose force is at most ``limit`` [N]; what they store, and slip took [J]."""
    stored, rubbing, at, soft = 0.0, 0.0, place(k), 1.0 / plate.shear
    for i in range(4):
        Q, K = plate.shear * (long[i] - cracks.shear_slip[k, i]), plate.shear
        if abs(Q) > limit:
            new = math.copysign(limit, Q)
            slipped = (Q - new) * soft
            rubbing += new * slipped
            cracks.shear_slip[k, i], Q, K = cracks.shear_slip[k, i] + slipped, new, 0.0
        stored += 0.5 * Q * Q * soft
        cracks.linear[STIFF + LANES * i + at], cracks.linear[HELD + LANES * i + at] = K, Q - K * long[i]
    return stored, rubbing


@compiled(inline="always")
def work(f: Resultants, e: Strain) -> float:
    """Of N and M on a strain, per area."""
    return f[0] * e.n + f[1] * e.t + f[2] * e.g + f[3] * e.kn + f[4] * e.kt + f[5] * e.kg


@compiled(inline="always")
def renew_cell(k: int, here: Pose, way: Pose, plate: Plate, law: CrackLaw, cracks: Cracks) -> float:
    """Evaluates the law in cell k, which goes on with a new tangent; returns the energy that it stores [J].

    ``way`` is how far the nodes have come in the last sub-step. What leapfrog conserves has x of this and of the last
    sub-step in its elastic energy, so a force that changes by df takes df . way / 2 beside the energy at x.
    """
    at, linear, area, (e, long) = place(k), cracks.linear, plate.d * plate.d, here
    c, s = cracks.axis[0, k], cracks.axis[1, k]
    before = edge_energy(at, long, cracks.constant[k] + area * tangent_energy(at, e, linear), linear)
    old, was = resultants(at, e, linear), edge_forces(at, long, linear)
    a = answer(k, turned(e, c, s), plate.h, law, cracks)
    new = renew_tangent(at, e, (c, s), a, linear)
    on_edges, rubbing = slide(k, long, 0.5 * plate.d * a.limit, plate, cracks)
    write(FACE, at, (0.5 * plate.h,), linear)
    write(SKEW, at, (plate.hourglass,), linear)
    write(SKEW_TURN, at, (plate.hourglass * plate.h * plate.h / 12.0,), linear)
    stored: float = area * a.stored + on_edges
    cracks.constant[k] = stored - edge_energy(at, long, area * tangent_energy(at, e, linear), linear)
    before += 0.5 * area * (work(new, way.strain) - work(old, way.strain))
    now = edge_forces(at, long, linear)
    for i in range(4):
        before += 0.5 * (now[i] - was[i]) * way.long[i]
    lost, rubbing = cracks.losses[part_of(k)], area * a.rubbing + rubbing
    lost[CRACKING] += area * a.cracking
    lost[CRUSHING] += area * a.crushing
    lost[RUBBING] += rubbing
    lost[SWITCHING] += before - stored - area * (a.cracking + a.crushing) - rubbing
    return stored


@compiled(nogil=True, error_model="numpy")
def evaluate(k: int, x: Array, way: Array, my: int, plate: Plate, law: CrackLaw, cracks: Cracks, lean: Array) -> float:
    """As `renew_cell`, at the displacements x and with the ``way`` of the nodes, (5, nodes).

    ``lean`` (3, nodes) are strains from slopes.
    """
    b = cracks.corner[k]
    here, gone = pose_of(b, my, plate.d, x), pose_of(b, my, plate.d, way)
    stored: float = renew_cell(k, Pose(leaned(here.strain, b, lean), here.long), gone, plate, law, cracks)
    return stored
