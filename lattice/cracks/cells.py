"""Layered cells: Lobatto layers each, in the fixed axes of the crack with which they began.

The mean membrane strain and curvature of the cell give the strain of each layer, the layers give forces N and moments
M per width, and these act on the four nodes. Two further modes of the nodes, the hourglass ones, leave the mean strain
alone: they keep a small stiffness, else a share of the broken cell would keep carrying tension. Out-of-plane shear
goes through the four edge springs of the cell, each limited by friction and what is left of the cohesion.

Between two evaluations of the law a cell is linear: forces are the tangent times the strain plus an offset. It is
evaluated anew when a strain of its faces has moved by `MOVED` of e_0. What the tangent stores is known exactly, so each
evaluation books what cracking, crushing and slip have taken; what changes because a crack closed or opened a little
earlier or later than the tangent knew is booked as ``switching``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import Legendre

from lattice.compiled import compiled
from lattice.cracks.law import layer
from lattice.grid import Array, IntArray


def lobatto(n: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Points of the Lobatto rule on -1 ... 1 and weights of sum 1 (Abramowitz and Stegun 25.4.32)."""
    P = Legendre.basis(n - 1)
    z = np.concatenate(([-1.0], np.sort(np.real(P.deriv().roots())), [1.0]))
    w = 1.0 / (n * (n - 1) * P(z) ** 2)
    return tuple(z.tolist()), tuple(w.tolist())


LAYERS = 11  #: with 7 the moment of a thrust is up to 4 % off, with 11 1.7 %
POINTS, WEIGHTS = lobatto(LAYERS)  #: the outermost layers are the faces
MOVED = 0.02  #: change of a face's strain, as share of e_0, at which the law is evaluated anew
#: share of the largest strain of a face that is added to e_0 there: in an open crack the place between the layers that
#: touch and those that do not is then known to 0.2 % of the thickness
WIDE = 0.1
HOURGLASS = 0.05  #: stiffness of the modes without mean strain, as share of E h (in bending times h^2 / 12)


class Plate(NamedTuple):
    """What all layered cells of a sheet have in common."""

    d: float  #: cell size [m]
    h: float  #: thickness [m]
    shear: float  #: of an edge spring of one cell, K_out / 2 [N/m]
    hourglass: float  #: stiffness of the modes without mean strain in the plane [N/m]


class Cracks(NamedTuple):
    """Layered cells, struct of arrays with room for m of them. N, M are (n, t, shear) in the axes of the crack."""

    cell: IntArray  #: (m,) number of the cell
    corner: IntArray  #: (m,) place of its node 0 in a padded row-by-row array
    axis: Array  #: (2, m) cosine and sine of the direction n
    damage: Array  #: (m, LAYERS, 2) of each layer across n and t, 0 to 1
    crushed: Array  #: (m, LAYERS, 2) strain of crushing
    slip: Array  #: (m, LAYERS) plastic shear strain
    shear_slip: Array  #: (m, 4) slip of the edge springs [m]
    thrust: Array  #: (m, 2) sum of the compression across n and t [N/m]
    membrane: Array  #: (4, m) tangent nn, nt, tt, gg of N to the strain [N/m]
    coupling: Array  #: (4, m) of N to the curvature and of M to the strain [N]
    bending: Array  #: (4, m) of M to the curvature [N m]
    offset: Array  #: (6, m) N and M without strain [N/m], [N]
    stiff: Array  #: (4, m) tangent of the edge springs [N/m]
    held: Array  #: (4, m) their force without elongation [N]
    seen: Array  #: (6, m) strain and curvature at the last evaluation, in the axes of the sheet
    constant: Array  #: (m,) energy by which the tangent's differs from what is stored [J]
    force: Array  #: (20, m) on the nodes, in the present sub-step [N], [N m]
    losses: Array  #: (4,) cracking, crushing, rubbing, switching: sums over all cells [J]


LOSSES = ("cracking", "crushing", "rubbing", "switching")


def room_for(m: int) -> Cracks:
    """Room for m layered cells, none of them in use."""
    f = np.zeros
    return Cracks(
        f(m, np.int64), f(m, np.int64), f((2, m)), f((m, LAYERS, 2)), f((m, LAYERS, 2)), f((m, LAYERS)), f((m, 4)),
        f((m, 2)), f((4, m)), f((4, m)), f((4, m)), f((6, m)), f((4, m)), f((4, m)), f((6, m)), f(m), f((20, m)), f(4),
    )  # fmt: skip


@compiled(inline="always")
def gradients(b, my, q, y):
    """d/dx, d/dy and the hourglass mode of one component y on the nodes of the cell at b."""
    A, B, C, D = y[b], y[b + my], y[b + 1], y[b + my + 1]
    return (B - A + D - C) * q, (C - A + D - B) * q, (A - B - C + D) * q


@compiled(inline="always")
def turned(e11, e22, g12, c, s):
    """Strain (engineering shear) in axes turned by the angle of (c, s)."""
    cc, ss, cs = c * c, s * s, c * s
    return cc * e11 + ss * e22 + cs * g12, ss * e11 + cc * e22 - cs * g12, 2.0 * cs * (e22 - e11) + (cc - ss) * g12


@compiled(inline="always")
def turned_back(Nn, Nt, Ng, c, s):
    """Stress resultants in the axes of the sheet."""
    cc, ss, cs = c * c, s * s, c * s
    return cc * Nn + ss * Nt - 2.0 * cs * Ng, ss * Nn + cc * Nt + 2.0 * cs * Ng, cs * (Nn - Nt) + (cc - ss) * Ng


@compiled(inline="always")
def elongations(b, my, half, y):
    """Of the edge springs 0-1, 2-3, 0-2, 1-3 [m]; y (5, nodes)."""
    w, px, py = y[2], y[3], y[4]
    w0, w1, w2, w3 = w[b], w[b + my], w[b + 1], w[b + my + 1]
    return (
        w1 - w0 + half * (px[b] + px[b + my]),
        w3 - w2 + half * (px[b + 1] + px[b + my + 1]),
        w2 - w0 + half * (py[b] + py[b + 1]),
        w3 - w1 + half * (py[b + my] + py[b + my + 1]),
    )


@compiled(inline="always")
def tangent_energy(k, en, et, eg, kn, kt, kg, cracks):
    """Energy of the linear cell per area at a strain, without its constant [J/m2]."""
    m, c, b, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    E = 0.5 * (m[0, k] * en * en + m[2, k] * et * et + m[3, k] * eg * eg) + m[1, k] * en * et
    E += 0.5 * (b[0, k] * kn * kn + b[2, k] * kt * kt + b[3, k] * kg * kg) + b[1, k] * kn * kt
    E += c[0, k] * en * kn + c[1, k] * (en * kt + et * kn) + c[2, k] * et * kt + c[3, k] * eg * kg
    E += o[0, k] * en + o[1, k] * et + o[2, k] * eg + o[3, k] * kn + o[4, k] * kt + o[5, k] * kg
    return E


@compiled(inline="always")
def resultants(k, en, et, eg, kn, kt, kg, cracks):
    """N and M of the linear cell at a strain, in the axes of its crack [N/m], [N]."""
    m, u, p, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    return (
        o[0, k] + m[0, k] * en + m[1, k] * et + u[0, k] * kn + u[1, k] * kt,
        o[1, k] + m[1, k] * en + m[2, k] * et + u[1, k] * kn + u[2, k] * kt,
        o[2, k] + m[3, k] * eg + u[3, k] * kg,
        o[3, k] + u[0, k] * en + u[1, k] * et + p[0, k] * kn + p[1, k] * kt,
        o[4, k] + u[1, k] * en + u[2, k] * et + p[1, k] * kn + p[2, k] * kt,
        o[5, k] + u[3, k] * eg + p[3, k] * kg,
    )


@compiled(error_model="numpy")
def evaluate(k, x, way, my, plate, law, cracks):
    """Evaluates the law in cell k at the displacements x (5, nodes); the cell goes on with a new tangent.

    ``way`` (5, nodes) is how far the nodes have come in the last sub-step. What leapfrog conserves has x of this and of
    the last sub-step in its elastic energy, so a force that changes by df takes df . way / 2 beside the energy at x.
    """
    d, h, q = plate.d, plate.h, 0.5 / plate.d
    b, c, s = cracks.corner[k], cracks.axis[0, k], cracks.axis[1, k]
    xx, xy, _ = gradients(b, my, q, x[0])
    yx, yy, _ = gradients(b, my, q, x[1])
    px, py, _ = gradients(b, my, q, x[3])
    rx, ry, _ = gradients(b, my, q, x[4])
    en, et, eg = turned(xx, yy, xy + yx, c, s)
    kn, kt, kg = turned(px, ry, py + rx, c, s)
    long = elongations(b, my, 0.5 * d, x)
    before = cracks.constant[k] + d * d * tangent_energy(k, en, et, eg, kn, kt, kg, cracks)
    for i in range(4):
        before += (0.5 * cracks.stiff[i, k] * long[i] + cracks.held[i, k]) * long[i]
    m, u, p, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    old = resultants(k, en, et, eg, kn, kt, kg, cracks)
    for i in range(4):
        m[i, k] = u[i, k] = p[i, k] = 0.0
    Nn = Nt = Ng = Mn = Mt = Mg = hold_n = hold_t = push_n = push_t = stored = 0.0
    cracking = crushing = rubbing = 0.0
    broken_n = broken_t = False
    for i in range(LAYERS):
        z, w = 0.5 * h * POINTS[i], h * WEIGHTS[i]
        a = layer(
            en + z * kn, et + z * kt, eg + z * kg, cracks.damage[k, i], cracks.crushed[k, i], cracks.slip[k, i], law
        )
        cracks.slip[k, i] = a.slip
        Nn, Nt, Ng = Nn + w * a.s_n, Nt + w * a.s_t, Ng + w * a.tau
        Mn, Mt, Mg = Mn + w * z * a.s_n, Mt + w * z * a.s_t, Mg + w * z * a.tau
        j = 0
        for t in (a.nn, a.nt, a.tt, a.gg):
            m[j, k] += w * t
            u[j, k] += w * z * t
            p[j, k] += w * z * z * t
            j += 1
        stored, cracking = stored + w * a.stored, cracking + w * a.cracking
        crushing, rubbing = crushing + w * a.crushing, rubbing + w * a.rubbing
        D_n, D_t = cracks.damage[k, i, 0], cracks.damage[k, i, 1]
        broken_n, broken_t = broken_n or D_n > 0.0, broken_t or D_t > 0.0
        push_n, push_t = push_n + w * max(-a.s_n, 0.0), push_t + w * max(-a.s_t, 0.0)
        hold_n, hold_t = hold_n + w * (1.0 - D_n) * law.cohesion, hold_t + w * (1.0 - D_t) * law.cohesion
    cracks.thrust[k, 0], cracks.thrust[k, 1] = push_n, push_t
    o[0, k] = Nn - (m[0, k] * en + m[1, k] * et + u[0, k] * kn + u[1, k] * kt)
    o[1, k] = Nt - (m[1, k] * en + m[2, k] * et + u[1, k] * kn + u[2, k] * kt)
    o[2, k] = Ng - (m[3, k] * eg + u[3, k] * kg)
    o[3, k] = Mn - (u[0, k] * en + u[1, k] * et + p[0, k] * kn + p[1, k] * kt)
    o[4, k] = Mt - (u[1, k] * en + u[2, k] * et + p[1, k] * kn + p[2, k] * kt)
    o[5, k] = Mg - (u[3, k] * eg + p[3, k] * kg)
    limit = math.inf
    if broken_n:
        limit = hold_n + law.mu * push_n
    if broken_t:
        limit = min(limit, hold_t + law.mu * push_t)
    stored, rubbing = d * d * stored, d * d * rubbing
    was = (
        cracks.held[0, k] + cracks.stiff[0, k] * long[0],
        cracks.held[1, k] + cracks.stiff[1, k] * long[1],
        cracks.held[2, k] + cracks.stiff[2, k] * long[2],
        cracks.held[3, k] + cracks.stiff[3, k] * long[3],
    )
    after = d * d * tangent_energy(k, en, et, eg, kn, kt, kg, cracks)
    for i in range(4):
        Q, K = plate.shear * (long[i] - cracks.shear_slip[k, i]), plate.shear
        if abs(Q) > 0.5 * d * limit:
            new = math.copysign(0.5 * d * limit, Q)
            slipped = (Q - new) / plate.shear
            rubbing += new * slipped
            cracks.shear_slip[k, i], Q, K = cracks.shear_slip[k, i] + slipped, new, 0.0
        stored += 0.5 * Q * Q / plate.shear
        cracks.stiff[i, k], cracks.held[i, k] = K, Q - K * long[i]
        after += (0.5 * K * long[i] + cracks.held[i, k]) * long[i]
    cracks.constant[k] = stored - after
    xx, xy, _ = gradients(b, my, q, way[0])
    yx, yy, _ = gradients(b, my, q, way[1])
    px, py, _ = gradients(b, my, q, way[3])
    rx, ry, _ = gradients(b, my, q, way[4])
    dn, dt, dg = turned(xx, yy, xy + yx, c, s)
    before += 0.5 * d * d * ((Nn - old[0]) * dn + (Nt - old[1]) * dt + (Ng - old[2]) * dg)
    dn, dt, dg = turned(px, ry, py + rx, c, s)
    before += 0.5 * d * d * ((Mn - old[3]) * dn + (Mt - old[4]) * dt + (Mg - old[5]) * dg)
    more = elongations(b, my, 0.5 * d, way)
    for i in range(4):
        before += 0.5 * (cracks.held[i, k] + cracks.stiff[i, k] * long[i] - was[i]) * more[i]
    lost = cracks.losses
    lost[0] += d * d * cracking
    lost[1] += d * d * crushing
    lost[2] += rubbing
    lost[3] += before - stored - d * d * (cracking + crushing) - rubbing
    return stored
