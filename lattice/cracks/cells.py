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
from lattice.cracks.kinematics import Edges, Strain
from lattice.cracks.law import Local
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

NN, NT, TT, GG = range(4)  #: entries of a tangent
N_N, N_T, N_G, M_N, M_T, M_G = range(6)  #: resultants across the crack, along it and shear
E_X, E_Y, G_XY, K_X, K_Y, K_XY = range(6)  #: strains in the axes of the sheet
LOSSES = ("cracking", "crushing", "rubbing", "switching", "turning")
CRACKING, CRUSHING, RUBBING, SWITCHING, TURNING = range(5)  #: entries of ``Cracks.losses``


class Plate(NamedTuple):
    """What layered cells of a sheet have in common."""

    d: float  #: cell size [m]
    h: float  #: thickness [m]
    shear: float  #: of an edge spring of one cell, K_out / 2 [N/m]
    hourglass: float  #: stiffness of the modes without mean strain in the plane [N/m]


@compiled(inline="always")
def plate_at(b: int, plate: Plate, local: Local) -> Plate:
    """The plate of the cell at b."""
    t = local.thickness[b]
    share = local.E[b] * t
    return Plate(plate.d, plate.h * t, plate.shear * share, plate.hourglass * share)


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
    membrane: Array  #: (4, m) tangent `NN` ... of N to the strain [N/m]
    coupling: Array  #: (4, m) of N to the curvature and of M to the strain [N]
    bending: Array  #: (4, m) of M to the curvature [N m]
    offset: Array  #: (6, m) `N_N` ... without strain [N/m], [N]
    stiff: Array  #: (4, m) tangent of the edge springs [N/m]
    held: Array  #: (4, m) their force without elongation [N]
    seen: Array  #: (6, m) `E_X` ... at the last evaluation
    constant: Array  #: (m,) energy by which the tangent's differs from what is stored [J]
    force: Array  #: (4, 5, m) on nodes 0 to 3 in the present sub-step [N], [N m]
    losses: Array  #: (5,) `CRACKING` ...: sums over all cells [J]


def room_for(m: int) -> Cracks:
    """Room for m layered cells, none of them in use."""
    zeros = np.zeros
    return Cracks(
        cell=zeros(m, np.int64),
        corner=zeros(m, np.int64),
        axis=zeros((2, m)),
        damage=zeros((m, LAYERS, 2)),
        crushed=zeros((m, LAYERS, 2)),
        slip=zeros((m, LAYERS)),
        shear_slip=zeros((m, 4)),
        thrust=zeros((m, 2)),
        membrane=zeros((4, m)),
        coupling=zeros((4, m)),
        bending=zeros((4, m)),
        offset=zeros((6, m)),
        stiff=zeros((4, m)),
        held=zeros((4, m)),
        seen=zeros((6, m)),
        constant=zeros(m),
        force=zeros((4, 5, m)),
        losses=zeros(len(LOSSES)),
    )


@compiled(inline="always")
def tangent_energy(k: int, e: Strain, cracks: Cracks) -> float:
    """Energy of the linear cell per area at a strain, without its constant [J/m2]."""
    m, c, b, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    E: float = 0.5 * (m[NN, k] * e.n * e.n + m[TT, k] * e.t * e.t + m[GG, k] * e.g * e.g) + m[NT, k] * e.n * e.t
    E += 0.5 * (b[NN, k] * e.kn * e.kn + b[TT, k] * e.kt * e.kt + b[GG, k] * e.kg * e.kg) + b[NT, k] * e.kn * e.kt
    E += c[NN, k] * e.n * e.kn + c[NT, k] * (e.n * e.kt + e.t * e.kn) + c[TT, k] * e.t * e.kt + c[GG, k] * e.g * e.kg
    E += o[N_N, k] * e.n + o[N_T, k] * e.t + o[N_G, k] * e.g + o[M_N, k] * e.kn + o[M_T, k] * e.kt + o[M_G, k] * e.kg
    return E


@compiled(inline="always")
def resultants(k: int, e: Strain, whole: float, cracks: Cracks) -> tuple[float, float, float, float, float, float]:
    """N and M of the linear cell at a strain, in the axes of its crack [N/m], [N]; ``whole`` as in `crack_forces`."""
    m, u, p, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    return (
        whole * o[N_N, k] + m[NN, k] * e.n + m[NT, k] * e.t + u[NN, k] * e.kn + u[NT, k] * e.kt,
        whole * o[N_T, k] + m[NT, k] * e.n + m[TT, k] * e.t + u[NT, k] * e.kn + u[TT, k] * e.kt,
        whole * o[N_G, k] + m[GG, k] * e.g + u[GG, k] * e.kg,
        whole * o[M_N, k] + u[NN, k] * e.n + u[NT, k] * e.t + p[NN, k] * e.kn + p[NT, k] * e.kt,
        whole * o[M_T, k] + u[NT, k] * e.n + u[TT, k] * e.t + p[NT, k] * e.kn + p[TT, k] * e.kt,
        whole * o[M_G, k] + u[GG, k] * e.g + p[GG, k] * e.kg,
    )


@compiled(inline="always")
def edge_forces(k: int, long: Edges, whole: float, cracks: Cracks) -> Edges:
    """Of the edge springs at these elongations [N]; ``whole`` as in `crack_forces`."""
    held, stiff = cracks.held, cracks.stiff
    return (
        whole * held[0, k] + stiff[0, k] * long[0],
        whole * held[1, k] + stiff[1, k] * long[1],
        whole * held[2, k] + stiff[2, k] * long[2],
        whole * held[3, k] + stiff[3, k] * long[3],
    )


@compiled(inline="always")
def edge_energy(k: int, long: Edges, energy: float, cracks: Cracks) -> float:
    """``energy`` and that of the linear edge springs, without their constant [J]."""
    for i in range(4):
        energy += (0.5 * cracks.stiff[i, k] * long[i] + cracks.held[i, k]) * long[i]
    return energy
