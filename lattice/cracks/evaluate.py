"""The law of all layers of a cell at a new strain: its tangent, what it stores, and what it has lost."""

from __future__ import annotations

import math
from typing import NamedTuple

from lattice.compiled import compiled
from lattice.cracks.cells import (
    LAYERS,
    POINTS,
    WEIGHTS,
    Cracks,
    Plate,
    Resultants,
    Strain,
    elongations,
    resultants,
    strain_of,
    tangent_energy,
)
from lattice.cracks.law import CrackLaw, layer
from lattice.grid import Array

Springs = tuple[float, float, float, float]  #: of the edge springs 0-1, 2-3, 0-2, 1-3


class Layers(NamedTuple):
    """The layers of a cell, added up through the thickness."""

    carried: Resultants
    limit: float  #: shear that its edges can take, by friction and cohesion; infinite while nothing is broken [N/m]
    stored: float  #: elastic energy [J/m2]
    cracking: float  #: taken by damage, crushing and slip [J/m2]
    crushing: float
    rubbing: float


class Shear(NamedTuple):
    """Sums with the edge springs added [J]."""

    stored: float
    rubbing: float
    tangent: float  #: energy of the linear cell without its constant


@compiled(error_model="numpy")
def through_thickness(k: int, e: Strain, plate: Plate, law: CrackLaw, cracks: Cracks) -> Layers:
    """Asks the law in every layer; tangents and the thrust of cell k are set."""
    h, m, u, p = plate.h, cracks.membrane, cracks.coupling, cracks.bending
    for i in range(4):
        m[i, k] = u[i, k] = p[i, k] = 0.0
    Nn = Nt = Ng = Mn = Mt = Mg = hold_n = hold_t = push_n = push_t = stored = 0.0
    cracking = crushing = rubbing = 0.0
    broken_n = broken_t = False
    for i in range(LAYERS):
        z, w = 0.5 * h * POINTS[i], h * WEIGHTS[i]
        n, t, g = e.n + z * e.kn, e.t + z * e.kt, e.g + z * e.kg
        a = layer(n, t, g, cracks.damage[k, i], cracks.crushed[k, i], cracks.slip[k, i], law)
        cracks.slip[k, i] = a.slip
        Nn, Nt, Ng = Nn + w * a.s_n, Nt + w * a.s_t, Ng + w * a.tau
        Mn, Mt, Mg = Mn + w * z * a.s_n, Mt + w * z * a.s_t, Mg + w * z * a.tau
        for j, tangent in enumerate((a.nn, a.nt, a.tt, a.gg)):
            m[j, k] += w * tangent
            u[j, k] += w * z * tangent
            p[j, k] += w * z * z * tangent
        stored, cracking = stored + w * a.stored, cracking + w * a.cracking
        crushing, rubbing = crushing + w * a.crushing, rubbing + w * a.rubbing
        D_n, D_t = cracks.damage[k, i, 0], cracks.damage[k, i, 1]
        broken_n, broken_t = broken_n or D_n > 0.0, broken_t or D_t > 0.0
        push_n, push_t = push_n + w * max(-a.s_n, 0.0), push_t + w * max(-a.s_t, 0.0)
        hold_n, hold_t = hold_n + w * (1.0 - D_n) * law.cohesion, hold_t + w * (1.0 - D_t) * law.cohesion
    cracks.thrust[k, 0], cracks.thrust[k, 1] = push_n, push_t
    limit = math.inf
    if broken_n:
        limit = hold_n + law.mu * push_n
    if broken_t:
        limit = min(limit, hold_t + law.mu * push_t)
    return Layers(Resultants(Nn, Nt, Ng, Mn, Mt, Mg), limit, stored, cracking, crushing, rubbing)


@compiled(inline="always")
def set_offset(k: int, e: Strain, carried: Resultants, cracks: Cracks) -> None:
    """The linear cell carries ``carried`` at the strain e."""
    m, u, p, o = cracks.membrane, cracks.coupling, cracks.bending, cracks.offset
    o[0, k] = carried.Nn - (m[0, k] * e.n + m[1, k] * e.t + u[0, k] * e.kn + u[1, k] * e.kt)
    o[1, k] = carried.Nt - (m[1, k] * e.n + m[2, k] * e.t + u[1, k] * e.kn + u[2, k] * e.kt)
    o[2, k] = carried.Ng - (m[3, k] * e.g + u[3, k] * e.kg)
    o[3, k] = carried.Mn - (u[0, k] * e.n + u[1, k] * e.t + p[0, k] * e.kn + p[1, k] * e.kt)
    o[4, k] = carried.Mt - (u[1, k] * e.n + u[2, k] * e.t + p[1, k] * e.kn + p[2, k] * e.kt)
    o[5, k] = carried.Mg - (u[3, k] * e.g + p[3, k] * e.kg)


@compiled(inline="always")
def spring_forces(k: int, long: Springs, cracks: Cracks) -> Springs:
    """Of the edge springs as linear ones [N]."""
    return (
        cracks.held[0, k] + cracks.stiff[0, k] * long[0],
        cracks.held[1, k] + cracks.stiff[1, k] * long[1],
        cracks.held[2, k] + cracks.stiff[2, k] * long[2],
        cracks.held[3, k] + cracks.stiff[3, k] * long[3],
    )


@compiled(error_model="numpy")
def shear_springs(k: int, long: Springs, limit: float, sums: Shear, plate: Plate, cracks: Cracks) -> Shear:
    """Slips the edge springs where they exceed ``limit`` [N/m] over half the cell; their tangents are set."""
    d, (stored, rubbing, after) = plate.d, sums
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
    return Shear(stored, rubbing, after)


@compiled(inline="always")
def change_over(way: Strain, old: Resultants, new: Resultants, half: float, energy: float) -> float:
    """``energy`` and ``half`` times the change of the resultants over a change of strain [J]."""
    energy += half * ((new.Nn - old.Nn) * way.n + (new.Nt - old.Nt) * way.t + (new.Ng - old.Ng) * way.g)
    energy += half * ((new.Mn - old.Mn) * way.kn + (new.Mt - old.Mt) * way.kt + (new.Mg - old.Mg) * way.kg)
    return energy


@compiled(error_model="numpy")
def evaluate(k: int, x: Array, way: Array, my: int, plate: Plate, law: CrackLaw, cracks: Cracks) -> float:
    """Evaluates the law in cell k at the displacements x (5, nodes); the cell goes on with a new tangent.

    ``way`` (5, nodes) is how far the nodes have come in the last sub-step. What leapfrog conserves has x of this and of
    the last sub-step in its elastic energy, so a force that changes by df takes df . way / 2 beside the energy at x.
    Returns what the cell stores without its hourglass modes [J].
    """
    d, q = plate.d, 0.5 / plate.d
    b, axis = cracks.corner[k], (cracks.axis[0, k], cracks.axis[1, k])
    e, long = strain_of(b, my, q, axis, x), elongations(b, my, 0.5 * d, x)
    before = cracks.constant[k] + d * d * tangent_energy(k, e, cracks)
    for i in range(4):
        before += (0.5 * cracks.stiff[i, k] * long[i] + cracks.held[i, k]) * long[i]
    old, was = resultants(k, e, cracks), spring_forces(k, long, cracks)
    found = through_thickness(k, e, plate, law, cracks)
    set_offset(k, e, found.carried, cracks)
    start = Shear(d * d * found.stored, d * d * found.rubbing, d * d * tangent_energy(k, e, cracks))
    sums: Shear = shear_springs(k, long, found.limit, start, plate, cracks)
    stored, rubbing = sums.stored, sums.rubbing
    cracks.constant[k] = stored - sums.tangent
    before = change_over(strain_of(b, my, q, axis, way), old, found.carried, 0.5 * d * d, before)
    more = elongations(b, my, 0.5 * d, way)
    for i in range(4):
        before += 0.5 * (cracks.held[i, k] + cracks.stiff[i, k] * long[i] - was[i]) * more[i]
    lost = cracks.losses
    lost[0] += d * d * found.cracking
    lost[1] += d * d * found.crushing
    lost[2] += rubbing
    lost[3] += before - stored - d * d * (found.cracking + found.crushing) - rubbing
    return stored
