"""The law evaluated in a layered cell: new states of its layers, a new tangent, and what that took."""

from __future__ import annotations

import math
from typing import NamedTuple

from lattice.compiled import compiled
from lattice.cracks.cells import (
    CRACKING,
    CRUSHING,
    GG,
    LAYERS,
    M_G,
    M_N,
    M_T,
    N_G,
    N_N,
    N_T,
    NN,
    NT,
    POINTS,
    RUBBING,
    SWITCHING,
    TT,
    WEIGHTS,
    Cracks,
    Plate,
    edge_energy,
    edge_forces,
    resultants,
    tangent_energy,
)
from lattice.cracks.kinematics import Edges, Strain, elongations, leaned, strain_of, turned
from lattice.cracks.law import CrackLaw, N, T, layer
from lattice.grid import Array


class Answer(NamedTuple):
    """What the layers of a cell make of a strain, per area."""

    force: tuple[float, float, float, float, float, float]  #: `N_N` ... [N/m], [N]
    stored: float  #: elastic energy [J/m2]
    cracking: float  #: taken [J/m2]
    crushing: float  #: taken [J/m2]
    rubbing: float  #: taken [J/m2]
    limit: float  #: largest shear out of the plane that the cracks bear per width, infinite without cracks [N/m]


@compiled(inline="always")
def add_layers(k: int, e: Strain, h: float, law: CrackLaw, cracks: Cracks) -> Answer:
    """New states, tangent, offset and thrust of cell k at a strain, layer by layer."""
    m, u, p, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    for i in range(4):
        m[i, k] = u[i, k] = p[i, k] = 0.0
    Nn = Nt = Ng = Mn = Mt = Mg = hold_n = hold_t = push_n = push_t = stored = 0.0
    cracking = crushing = rubbing = 0.0
    broken_n = broken_t = False
    for i in range(LAYERS):
        z, w = 0.5 * h * POINTS[i], h * WEIGHTS[i]
        damage, crushed = cracks.damage[k, i], cracks.crushed[k, i]
        a = layer(e.n + z * e.kn, e.t + z * e.kt, e.g + z * e.kg, damage, crushed, cracks.slip[k, i], law)
        cracks.slip[k, i] = a.slip
        Nn, Nt, Ng = Nn + w * a.s_n, Nt + w * a.s_t, Ng + w * a.tau
        Mn, Mt, Mg = Mn + w * z * a.s_n, Mt + w * z * a.s_t, Mg + w * z * a.tau
        for j, t in enumerate((a.nn, a.nt, a.tt, a.gg)):  # as `NN` ...
            m[j, k] += w * t
            u[j, k] += w * z * t
            p[j, k] += w * z * z * t
        stored, cracking = stored + w * a.stored, cracking + w * a.cracking
        crushing, rubbing = crushing + w * a.crushing, rubbing + w * a.rubbing
        D_n, D_t = damage[N], damage[T]
        broken_n, broken_t = broken_n or D_n > 0.0, broken_t or D_t > 0.0
        push_n, push_t = push_n + w * max(-a.s_n, 0.0), push_t + w * max(-a.s_t, 0.0)
        hold_n, hold_t = hold_n + w * (1.0 - D_n) * law.cohesion, hold_t + w * (1.0 - D_t) * law.cohesion
    cracks.thrust[k, N], cracks.thrust[k, T] = push_n, push_t
    o[N_N, k] = Nn - (m[NN, k] * e.n + m[NT, k] * e.t + u[NN, k] * e.kn + u[NT, k] * e.kt)
    o[N_T, k] = Nt - (m[NT, k] * e.n + m[TT, k] * e.t + u[NT, k] * e.kn + u[TT, k] * e.kt)
    o[N_G, k] = Ng - (m[GG, k] * e.g + u[GG, k] * e.kg)
    o[M_N, k] = Mn - (u[NN, k] * e.n + u[NT, k] * e.t + p[NN, k] * e.kn + p[NT, k] * e.kt)
    o[M_T, k] = Mt - (u[NT, k] * e.n + u[TT, k] * e.t + p[NT, k] * e.kn + p[TT, k] * e.kt)
    o[M_G, k] = Mg - (u[GG, k] * e.g + p[GG, k] * e.kg)
    limit = math.inf
    if broken_n:
        limit = hold_n + law.mu * push_n
    if broken_t:
        limit = min(limit, hold_t + law.mu * push_t)
    return Answer((Nn, Nt, Ng, Mn, Mt, Mg), stored, cracking, crushing, rubbing, limit)


@compiled(inline="always")
def slide(
    k: int, long: Edges, limit: float, stored: float, rubbing: float, plate: Plate, cracks: Cracks
) -> tuple[float, float]:
    """New tangent of the edge springs, whose force is at most ``limit`` [N].

    Returns ``stored`` and ``rubbing`` with what they store and what their slip takes [J].
    """
    for i in range(4):
        Q, K = plate.shear * (long[i] - cracks.shear_slip[k, i]), plate.shear
        if abs(Q) > limit:
            new = math.copysign(limit, Q)
            slipped = (Q - new) / plate.shear
            rubbing += new * slipped
            cracks.shear_slip[k, i], Q, K = cracks.shear_slip[k, i] + slipped, new, 0.0
        stored += 0.5 * Q * Q / plate.shear
        cracks.stiff[i, k], cracks.held[i, k] = K, Q - K * long[i]
    return stored, rubbing


@compiled(error_model="numpy")
def evaluate(k: int, x: Array, way: Array, my: int, plate: Plate, law: CrackLaw, cracks: Cracks, lean: Array) -> float:
    """Evaluates the law in cell k at the displacements x (5, nodes); the cell goes on with a new tangent.

    ``lean`` (3, nodes) are strains from slopes; ``way`` (5, nodes) is how far the nodes have come in the last sub-step.
    What leapfrog conserves has x of this and of the last sub-step in its elastic energy, so a force that changes by df
    takes df . way / 2 beside the energy at x. Returns the energy that the cell stores [J].
    """
    d, q = plate.d, 0.5 / plate.d
    b, c, s = cracks.corner[k], cracks.axis[0, k], cracks.axis[1, k]
    in_sheet, _ = strain_of(b, my, q, x)
    e, long = turned(leaned(in_sheet, b, lean, 1.0), c, s), elongations(b, my, 0.5 * d, x)
    before = edge_energy(k, long, cracks.constant[k] + d * d * tangent_energy(k, e, cracks), cracks)
    old, was = resultants(k, e, 1.0, cracks), edge_forces(k, long, 1.0, cracks)
    a = add_layers(k, e, plate.h, law, cracks)
    stored: float
    stored, rubbing = slide(k, long, 0.5 * d * a.limit, d * d * a.stored, d * d * a.rubbing, plate, cracks)
    after = edge_energy(k, long, d * d * tangent_energy(k, e, cracks), cracks)
    cracks.constant[k] = stored - after
    in_sheet, _ = strain_of(b, my, q, way)
    de, new = turned(in_sheet, c, s), a.force
    before += 0.5 * d * d * ((new[N_N] - old[N_N]) * de.n + (new[N_T] - old[N_T]) * de.t + (new[N_G] - old[N_G]) * de.g)
    before += (
        0.5 * d * d * ((new[M_N] - old[M_N]) * de.kn + (new[M_T] - old[M_T]) * de.kt + (new[M_G] - old[M_G]) * de.kg)
    )
    more, now = elongations(b, my, 0.5 * d, way), edge_forces(k, long, 1.0, cracks)
    for i in range(4):
        before += 0.5 * (now[i] - was[i]) * more[i]
    lost = cracks.losses
    lost[CRACKING] += d * d * a.cracking
    lost[CRUSHING] += d * d * a.crushing
    lost[RUBBING] += rubbing
    lost[SWITCHING] += before - stored - d * d * (a.cracking + a.crushing) - rubbing
    return stored
