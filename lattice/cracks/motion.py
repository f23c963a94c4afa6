"""Layered cells in the sub-steps of the explicit engine."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.cracks.cells import (
    MOVED,
    WIDE,
    Cracks,
    Plate,
    Strain,
    elongations,
    gradients,
    tangent_energy,
    turned,
    turned_back,
)
from lattice.cracks.evaluate import evaluate
from lattice.cracks.law import CrackLaw
from lattice.explicit.layout import Motion, PerNode
from lattice.grid import Array


class Layered(NamedTuple):
    """The layered cells of a sheet with their law."""

    number: int  #: the first so many cells of ``cells`` are in use
    cells: Cracks
    plate: Plate
    law: CrackLaw


class Nodes(NamedTuple):
    """Nodes of a padded row-by-row array in a sub-step, with room for two states of them; arrays are (5, nodes)."""

    my: int  #: length of a row
    y: Array  #: effective displacement x + alpha v
    v: Array
    alpha: float  #: material damping [s]
    dt: float  #: sub-step [s]
    x: Array  #: room for the displacement
    way: Array  #: room for how far the nodes have come in the sub-step


@compiled(inline="always")
def moved(k: int, my: int, y: Array, plate: Plate, law: CrackLaw, cracks: Cracks) -> bool:
    """Whether a face's strain has moved so far since the last evaluation that the law must be asked anew."""
    b, q, half, s = cracks.corner[k], 0.5 / plate.d, 0.5 * plate.h, cracks.seen
    wide = max(abs(s[0, k]) + half * abs(s[3, k]), abs(s[1, k]) + half * abs(s[4, k]))
    far = MOVED * (law.e_0 + WIDE * wide)
    xx, xy, _ = gradients(b, my, q, y[0])
    yx, yy, _ = gradients(b, my, q, y[1])
    px, py, _ = gradients(b, my, q, y[3])
    rx, ry, _ = gradients(b, my, q, y[4])
    a = abs(xx - s[0, k]) + half * abs(px - s[3, k])
    c = abs(yy - s[1, k]) + half * abs(ry - s[4, k])
    g = abs(xy + yx - s[2, k]) + half * abs(py + rx - s[5, k])
    far_enough: bool = a > far or c > far or g > far
    return far_enough


@compiled(nogil=True)
def renew(nodes: Nodes, layered: Layered) -> int:
    """Evaluates the law in every cell whose strain has moved, at the displacements y - alpha v; how many."""
    evaluated = 0
    for k in range(layered.number):
        if moved(k, nodes.my, nodes.y, layered.plate, layered.law, layered.cells):
            evaluate_at(k, nodes, layered)
            evaluated += 1
    return evaluated


@compiled(nogil=True)
def evaluate_at(k: int, nodes: Nodes, layered: Layered) -> float:
    """Evaluates the law in cell k at y - alpha v; its energy [J]."""
    my, y, v, alpha, dt, x, way = nodes
    cracks, q = layered.cells, 0.5 / layered.plate.d
    b = cracks.corner[k]
    for c in range(5):
        for n in (b, b + my, b + 1, b + my + 1):
            x[c, n] = y[c, n] - alpha * v[c, n]
            way[c, n] = dt * v[c, n]
    s = cracks.seen
    s[0, k], xy, _ = gradients(b, my, q, y[0])
    yx, s[1, k], _ = gradients(b, my, q, y[1])
    s[3, k], py, _ = gradients(b, my, q, y[3])
    rx, s[4, k], _ = gradients(b, my, q, y[4])
    s[2, k], s[5, k] = xy + yx, py + rx
    stored: float = evaluate(k, x, way, my, layered.plate, layered.law, cracks)
    return stored


@compiled(nogil=True)
def crack_forces(count: int, my: int, y: Array, whole: float, plate: Plate, cracks: Cracks) -> None:
    """Forces of the first ``count`` cells on their nodes at the effective displacements y (5, nodes).

    ``whole`` is 1; 0 leaves out what the cells carry without strain, so that y = alpha v gives their damping.
    """
    q, half, f = 0.5 / plate.d, 0.5 * plate.d, 0.5 * plate.d
    H, R = plate.hourglass, plate.hourglass * plate.h * plate.h / 12.0
    m, u, p, o, F = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset, cracks.force
    for k in range(count):
        b, c, s = cracks.corner[k], cracks.axis[0, k], cracks.axis[1, k]
        xx, xy, hx = gradients(b, my, q, y[0])
        yx, yy, hy = gradients(b, my, q, y[1])
        px, py, tx = gradients(b, my, q, y[3])
        rx, ry, ty = gradients(b, my, q, y[4])
        en, et, eg = turned(xx, yy, xy + yx, c, s)
        kn, kt, kg = turned(px, ry, py + rx, c, s)
        Nn = whole * o[0, k] + m[0, k] * en + m[1, k] * et + u[0, k] * kn + u[1, k] * kt
        Nt = whole * o[1, k] + m[1, k] * en + m[2, k] * et + u[1, k] * kn + u[2, k] * kt
        Ng = whole * o[2, k] + m[3, k] * eg + u[3, k] * kg
        Mn = whole * o[3, k] + u[0, k] * en + u[1, k] * et + p[0, k] * kn + p[1, k] * kt
        Mt = whole * o[4, k] + u[1, k] * en + u[2, k] * et + p[1, k] * kn + p[2, k] * kt
        Mg = whole * o[5, k] + u[3, k] * eg + p[3, k] * kg
        N1, N2, N3 = turned_back(Nn, Nt, Ng, c, s)
        M1, M2, M3 = turned_back(Mn, Mt, Mg, c, s)
        l0, l1, l2, l3 = elongations(b, my, half, y)
        Q0, Q1 = (
            whole * cracks.held[0, k] + cracks.stiff[0, k] * l0,
            whole * cracks.held[1, k] + cracks.stiff[1, k] * l1,
        )
        Q2, Q3 = (
            whole * cracks.held[2, k] + cracks.stiff[2, k] * l2,
            whole * cracks.held[3, k] + cracks.stiff[3, k] * l3,
        )
        # nodes 0 (-, -), 1 (+, -), 2 (-, +), 3 (+, +)
        F[0, k], F[5, k] = f * (N1 + N3 - H * hx), f * (-N1 + N3 + H * hx)
        F[10, k], F[15, k] = f * (N1 - N3 + H * hx), f * (-N1 - N3 - H * hx)
        F[1, k], F[6, k] = f * (N2 + N3 - H * hy), f * (N2 - N3 + H * hy)
        F[11, k], F[16, k] = f * (-N2 + N3 + H * hy), f * (-N2 - N3 - H * hy)
        F[2, k], F[7, k], F[12, k], F[17, k] = Q0 + Q2, Q3 - Q0, Q1 - Q2, -Q1 - Q3
        F[3, k], F[8, k] = f * (M1 + M3 - R * tx - Q0), f * (-M1 + M3 + R * tx - Q0)
        F[13, k], F[18, k] = f * (M1 - M3 + R * tx - Q1), f * (-M1 - M3 - R * tx - Q1)
        F[4, k], F[9, k] = f * (M2 + M3 - R * ty - Q2), f * (M2 - M3 + R * ty - Q3)
        F[14, k], F[19, k] = f * (-M2 + M3 + R * ty - Q2), f * (-M2 - M3 - R * ty - Q3)


@compiled(nogil=True)
def give(count: int, motion: Motion, kick: PerNode, go: float, cracks: Cracks) -> None:
    """Adds the forces of `crack_forces` to a sub-step that has been made."""
    F, my, ny = cracks.force, motion.y.shape[2], kick.u.shape[1]
    y, v = motion.y.reshape(5, -1), motion.v.reshape(5, -1)
    u, w, phi = kick.u.reshape(-1), kick.w.reshape(-1), kick.phi.reshape(-1)
    for k in range(count):
        b = cracks.corner[k]
        at = b // my * ny + b % my
        for n, g, r in ((b, at, 0), (b + my, at + ny, 5), (b + 1, at + 1, 10), (b + my + 1, at + ny + 1, 15)):
            for c in range(5):
                dv = (u[g] if c < 2 else w[g] if c == 2 else phi[g]) * F[r + c, k]
                v[c, n] += dv
                y[c, n] += go * dv


@compiled(nogil=True)
def energies(count: int, my: int, x: Array, plate: Plate, cracks: Cracks) -> Array:
    """Energy of each of the first ``count`` cells at displacements x (5, nodes), with that of its hourglass modes."""
    out, q, half = np.empty(count), 0.5 / plate.d, 0.5 * plate.d
    H, R = plate.hourglass, plate.hourglass * plate.h * plate.h / 12.0
    for k in range(count):
        b, c, s = cracks.corner[k], cracks.axis[0, k], cracks.axis[1, k]
        xx, xy, hx = gradients(b, my, q, x[0])
        yx, yy, hy = gradients(b, my, q, x[1])
        px, py, tx = gradients(b, my, q, x[3])
        rx, ry, ty = gradients(b, my, q, x[4])
        en, et, eg = turned(xx, yy, xy + yx, c, s)
        kn, kt, kg = turned(px, ry, py + rx, c, s)
        E = tangent_energy(k, Strain(en, et, eg, kn, kt, kg), cracks)
        E += 0.5 * (H * (hx * hx + hy * hy) + R * (tx * tx + ty * ty))
        out[k] = cracks.constant[k] + plate.d * plate.d * E
        long = elongations(b, my, half, x)
        for i in range(4):
            out[k] += (0.5 * cracks.stiff[i, k] * long[i] + cracks.held[i, k]) * long[i]
    return out
