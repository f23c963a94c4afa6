"""Layered cells in the sub-steps of the explicit engine."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.cells import (
    E_X,
    E_Y,
    G_XY,
    K_X,
    K_XY,
    K_Y,
    MOVED,
    WIDE,
    Cracks,
    Plate,
    edge_energy,
    edge_forces,
    plate_at,
    resultants,
    tangent_energy,
)
from lattice.cracks.evaluate import evaluate
from lattice.cracks.kinematics import elongations, leaned, strain_of, turned, turned_back
from lattice.cracks.law import CrackLaw, Local, law_at
from lattice.cracks.slopes import Lean
from lattice.explicit.layout import PHI_X, PHI_Y, U_X, U_Y, Motion, PerNode, W
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


class Nodes(NamedTuple):
    """The nodes in rows, one after the other, as cells look at them; (5, nodes) each."""

    y: Array  #: effective displacement x + alpha v
    v: Array  #: velocity
    x: Array  #: room for displacements
    way: Array  #: room for what they were in the last sub-step
    my: int  #: places in a row
    alpha: float  #: material damping [s]
    dt: float  #: sub-step [s]


@compiled(inline="always")
def moved(k: int, my: int, y: Array, layered: Layered) -> bool:
    """Whether a face's strain has moved so far since the last evaluation that the law must be asked anew."""
    b, s = layered.cells.corner[k], layered.cells.seen
    plate = plate_at(b, layered.plate, layered.local)
    half = 0.5 * plate.h
    wide = max(abs(s[E_X, k]) + half * abs(s[K_X, k]), abs(s[E_Y, k]) + half * abs(s[K_Y, k]))
    far: float = MOVED * (layered.local.e_0[b] + WIDE * wide)
    in_sheet, _ = strain_of(b, my, 0.5 / plate.d, y)
    e = leaned(in_sheet, b, layered.lean.strain, 1.0)
    a: float = abs(e.n - s[E_X, k]) + half * abs(e.kn - s[K_X, k])
    c: float = abs(e.t - s[E_Y, k]) + half * abs(e.kt - s[K_Y, k])
    g: float = abs(e.g - s[G_XY, k]) + half * abs(e.kg - s[K_XY, k])
    return a > far or c > far or g > far


@compiled(nogil=True)
def renew(nodes: Nodes, layered: Layered) -> int:
    """Evaluates the law in every cell whose strain has moved, at the displacements y - alpha v; how many."""
    evaluated = 0
    for k in range(layered.used):
        if moved(k, nodes.my, nodes.y, layered):
            evaluate_at(k, nodes, layered)
            evaluated += 1
    return evaluated


@compiled(nogil=True)
def evaluate_at(k: int, nodes: Nodes, layered: Layered) -> float:
    """Evaluates the law in cell k at y - alpha v; its energy [J]."""
    cracks, my = layered.cells, nodes.my
    b, s = cracks.corner[k], cracks.seen
    for c in range(5):
        for n in (b, b + my, b + 1, b + my + 1):
            nodes.x[c, n] = nodes.y[c, n] - nodes.alpha * nodes.v[c, n]
            nodes.way[c, n] = nodes.dt * nodes.v[c, n]
    in_sheet, _ = strain_of(b, my, 0.5 / layered.plate.d, nodes.y)
    e = leaned(in_sheet, b, layered.lean.strain, 1.0)
    s[E_X, k], s[E_Y, k], s[G_XY, k] = e.n, e.t, e.g
    s[K_X, k], s[K_Y, k], s[K_XY, k] = e.kn, e.kt, e.kg
    lean, local = layered.lean.strain, layered.local
    plate, law = plate_at(b, layered.plate, local), law_at(b, layered.law, local)
    stored: float = evaluate(k, nodes.x, nodes.way, my, plate, law, cracks, lean)
    return stored


@compiled(nogil=True)
def crack_forces(my: int, y: Array, whole: float, layered: Layered) -> None:
    """Forces of the layered cells on their nodes at the effective displacements y (5, nodes).

    ``whole`` is 1; 0 leaves out what the cells carry without strain, so that y = alpha v gives their damping.
    """
    d, cracks, lean = layered.plate.d, layered.cells, layered.lean.strain
    q, half, f, F = 0.5 / d, 0.5 * d, 0.5 * d, cracks.force
    for k in range(layered.used):
        b, c, s = cracks.corner[k], cracks.axis[0, k], cracks.axis[1, k]
        plate = plate_at(b, layered.plate, layered.local)
        H, R = plate.hourglass, plate.hourglass * plate.h * plate.h / 12.0
        e, h = strain_of(b, my, q, y)
        Nn, Nt, Ng, Mn, Mt, Mg = resultants(k, turned(leaned(e, b, lean, whole), c, s), whole, cracks)
        N1, N2, N3 = turned_back(Nn, Nt, Ng, c, s)
        M1, M2, M3 = turned_back(Mn, Mt, Mg, c, s)
        Q0, Q1, Q2, Q3 = edge_forces(k, elongations(b, my, half, y), whole, cracks)
        # nodes 0 (-, -), 1 (+, -), 2 (-, +), 3 (+, +)
        F[0, U_X, k], F[1, U_X, k] = f * (N1 + N3 - H * h.x), f * (-N1 + N3 + H * h.x)
        F[2, U_X, k], F[3, U_X, k] = f * (N1 - N3 + H * h.x), f * (-N1 - N3 - H * h.x)
        F[0, U_Y, k], F[1, U_Y, k] = f * (N2 + N3 - H * h.y), f * (N2 - N3 + H * h.y)
        F[2, U_Y, k], F[3, U_Y, k] = f * (-N2 + N3 + H * h.y), f * (-N2 - N3 - H * h.y)
        F[0, W, k], F[1, W, k], F[2, W, k], F[3, W, k] = Q0 + Q2, Q3 - Q0, Q1 - Q2, -Q1 - Q3
        F[0, PHI_X, k], F[1, PHI_X, k] = f * (M1 + M3 - R * h.tx - Q0), f * (-M1 + M3 + R * h.tx - Q0)
        F[2, PHI_X, k], F[3, PHI_X, k] = f * (M1 - M3 + R * h.tx - Q1), f * (-M1 - M3 - R * h.tx - Q1)
        F[0, PHI_Y, k], F[1, PHI_Y, k] = f * (M2 + M3 - R * h.ty - Q2), f * (M2 - M3 + R * h.ty - Q3)
        F[2, PHI_Y, k], F[3, PHI_Y, k] = f * (-M2 + M3 + R * h.ty - Q2), f * (-M2 - M3 - R * h.ty - Q3)


@compiled(nogil=True)
def give(used: int, motion: Motion, kick: PerNode, go: float, cracks: Cracks) -> None:
    """Adds the forces of `crack_forces` to a sub-step that has been made."""
    F, my, ny = cracks.force, motion.y.shape[2], kick.u.shape[1]
    y, v = motion.y.reshape(5, -1), motion.v.reshape(5, -1)
    u, w, phi = kick.u.reshape(-1), kick.w.reshape(-1), kick.phi.reshape(-1)
    for k in range(used):
        b = cracks.corner[k]
        at = b // my * ny + b % my
        for n, g, r in ((b, at, 0), (b + my, at + ny, 1), (b + 1, at + 1, 2), (b + my + 1, at + ny + 1, 3)):
            for c in range(5):
                dv = (u[g] if c < W else w[g] if c == W else phi[g]) * F[r, c, k]
                v[c, n] += dv
                y[c, n] += go * dv


@compiled(nogil=True)
def pull_on_held(my: int, held: Array, layered: Layered) -> float:
    """Force along x that nodes with ``held`` (places,) 1 need against `crack_forces` and slopes [N]."""
    F, lean, total = layered.cells.force, layered.lean.force, 0.0
    for k in range(layered.used):
        b = layered.cells.corner[k]
        total -= held[b] * F[0, U_X, k] + held[b + my] * F[1, U_X, k]
        total -= held[b + 1] * F[2, U_X, k] + held[b + my + 1] * F[3, U_X, k]
    for n in range(held.shape[0]):
        total -= held[n] * lean[U_X, n]
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
    d, cracks, lean = layered.plate.d, layered.cells, layered.lean.strain
    out, q, half = np.empty(layered.used), 0.5 / d, 0.5 * d
    for k in range(layered.used):
        b = cracks.corner[k]
        plate = plate_at(b, layered.plate, layered.local)
        H, R = plate.hourglass, plate.hourglass * plate.h * plate.h / 12.0
        e, h = strain_of(b, my, q, x)
        E = tangent_energy(k, turned(leaned(e, b, lean, 1.0), cracks.axis[0, k], cracks.axis[1, k]), cracks)
        E += 0.5 * (H * (h.x * h.x + h.y * h.y) + R * (h.tx * h.tx + h.ty * h.ty))
        out[k] = edge_energy(k, elongations(b, my, half, x), cracks.constant[k] + plate.d * plate.d * E, cracks)
    return out
