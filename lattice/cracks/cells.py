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

from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import Legendre

from lattice.compiled import compiled
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
Triple = tuple[float, float, float]
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


class Strain(NamedTuple):
    """Mean strain and curvature of a cell in the axes of its crack; shear is engineering shear."""

    n: float  #: across the crack [-]
    t: float  #: along it
    g: float  #: shear
    kn: float  #: their slopes through the thickness, positive where the upper side is stretched [1/m]
    kt: float
    kg: float


class Resultants(NamedTuple):
    """Forces and moments of a cell per width in the axes of its crack."""

    Nn: float  #: [N/m]
    Nt: float
    Ng: float
    Mn: float  #: [N]
    Mt: float
    Mg: float


LOSSES = ("cracking", "crushing", "rubbing", "switching")


def room_for(m: int) -> Cracks:
    """Room for m layered cells, none of them in use."""
    f = np.zeros
    return Cracks(
        cell=f(m, np.int64),
        corner=f(m, np.int64),
        axis=f((2, m)),
        damage=f((m, LAYERS, 2)),
        crushed=f((m, LAYERS, 2)),
        slip=f((m, LAYERS)),
        shear_slip=f((m, 4)),
        thrust=f((m, 2)),
        membrane=f((4, m)),
        coupling=f((4, m)),
        bending=f((4, m)),
        offset=f((6, m)),
        stiff=f((4, m)),
        held=f((4, m)),
        seen=f((6, m)),
        constant=f(m),
        force=f((20, m)),
        losses=f(4),
    )


@compiled(inline="always")
def gradients(b: int, my: int, q: float, y: Array) -> Triple:
    """d/dx, d/dy and the hourglass mode of one component y on the nodes of the cell at b."""
    A, B, C, D = y[b], y[b + my], y[b + 1], y[b + my + 1]
    return (B - A + D - C) * q, (C - A + D - B) * q, (A - B - C + D) * q


@compiled(inline="always")
def turned(e11: float, e22: float, g12: float, c: float, s: float) -> Triple:
    """Strain (engineering shear) in axes turned by the angle of (c, s)."""
    cc, ss, cs = c * c, s * s, c * s
    return cc * e11 + ss * e22 + cs * g12, ss * e11 + cc * e22 - cs * g12, 2.0 * cs * (e22 - e11) + (cc - ss) * g12


@compiled(inline="always")
def turned_back(Nn: float, Nt: float, Ng: float, c: float, s: float) -> Triple:
    """Stress resultants in the axes of the sheet."""
    cc, ss, cs = c * c, s * s, c * s
    return cc * Nn + ss * Nt - 2.0 * cs * Ng, ss * Nn + cc * Nt + 2.0 * cs * Ng, cs * (Nn - Nt) + (cc - ss) * Ng


@compiled(inline="always")
def elongations(b: int, my: int, half: float, y: Array) -> tuple[float, float, float, float]:
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
def strain_of(b: int, my: int, q: float, axis: tuple[float, float], y: Array) -> Strain:
    """Mean strain and curvature of the cell at b in axes of cosine and sine ``axis``; y (5, nodes), q = 1 / 2d."""
    c, s = axis
    xx, xy, _ = gradients(b, my, q, y[0])
    yx, yy, _ = gradients(b, my, q, y[1])
    px, py, _ = gradients(b, my, q, y[3])
    rx, ry, _ = gradients(b, my, q, y[4])
    en, et, eg = turned(xx, yy, xy + yx, c, s)
    kn, kt, kg = turned(px, ry, py + rx, c, s)
    return Strain(en, et, eg, kn, kt, kg)


@compiled(inline="always")
def tangent_energy(k: int, e: Strain, cracks: Cracks) -> float:
    """Energy of the linear cell per area at a strain, without its constant [J/m2]."""
    m, c, b, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    en, et, eg, kn, kt, kg = e.n, e.t, e.g, e.kn, e.kt, e.kg
    E: float = 0.5 * (m[0, k] * en * en + m[2, k] * et * et + m[3, k] * eg * eg) + m[1, k] * en * et
    E += 0.5 * (b[0, k] * kn * kn + b[2, k] * kt * kt + b[3, k] * kg * kg) + b[1, k] * kn * kt
    E += c[0, k] * en * kn + c[1, k] * (en * kt + et * kn) + c[2, k] * et * kt + c[3, k] * eg * kg
    E += o[0, k] * en + o[1, k] * et + o[2, k] * eg + o[3, k] * kn + o[4, k] * kt + o[5, k] * kg
    return E


@compiled(inline="always")
def resultants(k: int, e: Strain, cracks: Cracks) -> Resultants:
    """N and M of the linear cell at a strain, in the axes of its crack."""
    m, u, p, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    en, et, eg, kn, kt, kg = e.n, e.t, e.g, e.kn, e.kt, e.kg
    return Resultants(
        o[0, k] + m[0, k] * en + m[1, k] * et + u[0, k] * kn + u[1, k] * kt,
        o[1, k] + m[1, k] * en + m[2, k] * et + u[1, k] * kn + u[2, k] * kt,
        o[2, k] + m[3, k] * eg + u[3, k] * kg,
        o[3, k] + u[0, k] * en + u[1, k] * et + p[0, k] * kn + p[1, k] * kt,
        o[4, k] + u[1, k] * en + u[2, k] * et + p[1, k] * kn + p[2, k] * kt,
        o[5, k] + u[3, k] * eg + p[3, k] * kg,
    )
