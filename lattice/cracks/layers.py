"""All layers of a cell at once: what they carry at a strain, and how they go on.

Their states and answers lie in lines of one flat array at a constant distance: only then can the compiler prove that
they do not overlap, and take the layers side by side.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import Legendre

from lattice.compiled import compiled
from lattice.cracks.kinematics import Strain
from lattice.cracks.law import CrackLaw, History, follow
from lattice.explicit.layout import LANES
from lattice.grid import Array


def lobatto(n: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Points of the Lobatto rule on -1 ... 1 and weights of sum 1 (Abramowitz and Stegun 25.4.32)."""
    P = Legendre.basis(n - 1)
    z = np.concatenate(([-1.0], np.sort(np.real(P.deriv().roots())), [1.0]))
    w = 1.0 / (n * (n - 1) * P(z) ** 2)
    return tuple(z.tolist()), tuple(w.tolist())


LAYERS = 11  #: with 7 the moment of a thrust is up to 4 % off, with 11 1.7 %
POINTS, WEIGHTS = lobatto(LAYERS)  #: the outermost layers are the faces
ROW = -(-LAYERS // LANES) * LANES  #: length of a line: whole vectors
HEIGHT, SHARE = (np.array([*values, *[0.0] * (ROW - LAYERS)]) for values in (POINTS, WEIGHTS))

#: beginnings of the lines: what a layer has been through, what it carries, its tangent, and energies
D_N, D_T, P_N, P_T, SLIP, S_N, S_T, TAU, T_NN, T_NT, T_TT, T_GG, STORED, CRACK, CRUSH, RUB = (
    k * ROW for k in range(16)
)
HISTORY, STACK = 5 * ROW, 16 * ROW  #: length of what is kept, which comes first, and of the flat array


class Tangent(NamedTuple):
    """Of a cell's forces to its strains, in the axes of the crack; shear apart from the rest."""

    nn: float
    nt: float
    tt: float
    gg: float


class Answer(NamedTuple):
    """What the layers of a cell make of a strain, per area."""

    force: tuple[float, float, float, float, float, float]  #: N and M, (n, t, shear) each [N/m], [N]
    membrane: Tangent  #: of N to the strain [N/m]
    coupling: Tangent  #: of N to the curvature and of M to the strain [N]
    bending: Tangent  #: of M to the curvature [N m]
    thrust: tuple[float, float]  #: sum of the compression across n and t [N/m]
    stored: float  #: elastic energy [J/m2]
    cracking: float  #: taken [J/m2]
    crushing: float  #: taken [J/m2]
    rubbing: float  #: taken [J/m2]
    limit: float  #: largest shear out of the plane that the cracks bear per width, infinite without cracks [N/m]


@compiled(nogil=True, borrows=True, error_model="numpy")
def follow_all(e: Strain, h: float, law: CrackLaw, stack: Array) -> None:
    """Every layer of a cell at a strain, from its states in ``stack``; these go on, and what it carries comes."""
    for i in range(ROW):
        z = 0.5 * h * HEIGHT[i]
        was = History(stack[D_N + i], stack[D_T + i], stack[P_N + i], stack[P_T + i], stack[SLIP + i])
        a, now = follow(e.n + z * e.kn, e.t + z * e.kt, e.g + z * e.kg, was, law)
        stack[D_N + i], stack[D_T + i], stack[P_N + i], stack[P_T + i] = now.D_n, now.D_t, now.p_n, now.p_t
        stack[SLIP + i], stack[S_N + i], stack[S_T + i], stack[TAU + i] = now.slip, a.s_n, a.s_t, a.tau
        stack[T_NN + i], stack[T_NT + i], stack[T_TT + i], stack[T_GG + i] = a.nn, a.nt, a.tt, a.gg
        stack[STORED + i], stack[CRACK + i], stack[CRUSH + i], stack[RUB + i] = (
            a.stored,
            a.cracking,
            a.crushing,
            a.rubbing,
        )


@compiled(inline="always")
def moments(line: int, h: float, stack: Array) -> tuple[float, float, float]:
    """Integrals over the thickness of a line, of it times the height, and times its square."""
    zeroth = first = second = 0.0
    for i in range(LAYERS):
        z, part = 0.5 * h * HEIGHT[i], h * SHARE[i] * stack[line + i]
        zeroth, first, second = zeroth + part, first + z * part, second + z * z * part
    return zeroth, first, second


@compiled(inline="always")
def grip(damage: int, stress: int, h: float, law: CrackLaw, stack: Array) -> tuple[float, float]:
    """Compression across an axis, and the shear that its cracks bear, infinite without cracks, per width [N/m]."""
    push = hold = worst = 0.0
    for i in range(LAYERS):
        w, s, D = h * SHARE[i], stack[stress + i], stack[damage + i]
        push += w * (-s if s < 0.0 else 0.0)
        hold += w * (1.0 - D) * law.cohesion
        worst = D if worst < D else worst
    return push, hold + law.mu * push if worst > 0.0 else math.inf


@compiled(nogil=True, borrows=True, error_model="numpy")
def sums(h: float, law: CrackLaw, stack: Array) -> Answer:
    """The integrals over the thickness of what `follow_all` has left."""
    (Nn, Mn, _), (Nt, Mt, _), (Ng, Mg, _) = moments(S_N, h, stack), moments(S_T, h, stack), moments(TAU, h, stack)
    nn, nt, tt = moments(T_NN, h, stack), moments(T_NT, h, stack), moments(T_TT, h, stack)
    gg = moments(T_GG, h, stack)
    push_n, limit_n = grip(D_N, S_N, h, law, stack)
    push_t, limit_t = grip(D_T, S_T, h, law, stack)
    return Answer(
        (Nn, Nt, Ng, Mn, Mt, Mg),
        Tangent(nn[0], nt[0], tt[0], gg[0]),
        Tangent(nn[1], nt[1], tt[1], gg[1]),
        Tangent(nn[2], nt[2], tt[2], gg[2]),
        thrust=(push_n, push_t),
        stored=moments(STORED, h, stack)[0],
        cracking=moments(CRACK, h, stack)[0],
        crushing=moments(CRUSH, h, stack)[0],
        rubbing=moments(RUB, h, stack)[0],
        limit=min(limit_n, limit_t),
    )
