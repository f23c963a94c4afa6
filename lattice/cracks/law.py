"""The law of one layer of a cracked cell, in the axes of its crack: n across the crack, t along it.

A layer that is whole is elastic in plane stress. Across each of the two axes it may crack: the compliance of that axis
grows by the damage D, but in tension only, so that a crack that closes carries like whole ice:

    eps_n = sigma_n / (E a_n) - nu sigma_t / E,    a_n = 1 - D_n where sigma_n > 0, else 1;    eps_t likewise.

D follows from the strain q = sigma_n / (E a_n), what the stress of the other axis adds taken off, such that the stress
goes down on a straight line from sigma_t at e_0 = sigma_t / E to zero at e_f = w_c / d, w_c = 2 G_f / sigma_t: a
cohesive crack of fracture energy G_f in series with the elastic cell of size d (Hillerborg et al. 1976, Bazant and
Oh 1983).
In compression the stress stays above -sigma_c; beyond it ice is crushed, a strain that stays. Shear along a crack is
limited by what is left of the cohesion c and by Coulomb friction, and the slip stays:

    |tau| <= (1 - D) c + mu |sigma_n|.

The law returns what each of the three took: crushing sigma_c times its strain, slip the limit times its way, damage the
energy that it lowers at constant strain.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array
from lattice.ice import Ice

N, T = range(2)  #: axes of a crack, across it and along it: last index of damage and crushing


class CrackLaw(NamedTuple):
    """Constants of the law, all layers alike."""

    E: float  #: Young's modulus [Pa]
    nu: float  #: Poisson's ratio [-]
    sigma_c: float  #: compressive strength [Pa]
    cohesion: float  #: shear strength of whole ice [Pa]
    mu: float  #: friction of the faces of a crack [-]
    e_0: float  #: strain sigma_t / E at which a layer begins to crack [-]
    e_f: float  #: strain at which its crack carries no tension any more, w_c / d, at least e_0: brittle [-]


class Local(NamedTuple):
    """The ice of each cell beside that of the law, (places,) each: at the place of its node 0, as in `Cracks`."""

    E: Array  #: over that of the law
    strength: Array  #: of every kind, over that of the law
    thickness: Array  #: over that of the plate
    e_0: Array  #: as in `CrackLaw`
    e_f: Array  #: as in `CrackLaw`


def local_of(law: CrackLaw, E: Array, strength: Array, thickness: Array, rigid: float | None = None) -> Local:
    """G_f is the same everywhere, so that weaker ice softens over a wider opening.

    ``rigid`` is the `softening` of the law; without it a law that is brittle is so in every cell.
    """
    if rigid is None:
        rigid = law.e_f if law.e_f > law.e_0 else 0.0
    e_0 = law.e_0 * (strength / E)
    return Local(E, strength, thickness, e_0, np.maximum(e_0, rigid / strength))


@compiled(inline="always")
def law_at(b: int, law: CrackLaw, local: Local) -> CrackLaw:
    """The law of the cell at b."""
    E, s = local.E[b], local.strength[b]
    return CrackLaw(law.E * E, law.nu, law.sigma_c * s, law.cohesion * s, law.mu, local.e_0[b], local.e_f[b])


#: shear strength of whole ice where none is given, as share of the compressive one: 700 kPa of 4 MPa (van Vliet 2018,
#: chapter 5 and Table 6-1) [-]
COHESION = 0.175


def law_of(ice: Ice, fracture_energy: float, mu: float, d: float) -> CrackLaw:
    """The law for layers of strength ``ice.sigma_t`` in cells of size d [m]; ``fracture_energy`` [J/m2], 0: brittle."""
    e_0 = ice.sigma_t / ice.E
    e_f = max(e_0, softening(ice, fracture_energy, d))
    cohesion = ice.sigma_shear if math.isfinite(ice.sigma_shear) else COHESION * ice.sigma_c
    return CrackLaw(ice.E, ice.nu, ice.sigma_c, cohesion, mu, e_0, e_f)


def softening(ice: Ice, fracture_energy: float, d: float) -> float:
    """Strain w_c / d of cells of size d [m] at which a crack carries nothing any more, were the cell itself rigid."""
    return 2.0 * fracture_energy / (ice.sigma_t * d)


class Layer(NamedTuple):
    """What a layer carries and how it answers to small strains while nothing in it cracks, crushes or slips."""

    s_n: float  #: stress across the crack [Pa]
    s_t: float  #: stress along it [Pa]
    tau: float  #: shear stress [Pa]
    nn: float  #: d s_n / d eps_n [Pa]
    nt: float  #: d s_n / d eps_t = d s_t / d eps_n [Pa]
    tt: float  #: d s_t / d eps_t [Pa]
    gg: float  #: d tau / d gamma [Pa]
    slip: float  #: plastic part of gamma [-]
    stored: float  #: elastic energy [J/m3]
    cracking: float  #: energy that growing damage took [J/m3]
    crushing: float  #: energy that crushing took [J/m3]
    rubbing: float  #: energy that slip took [J/m3]


@compiled(inline="always")
def damage_of(q: float, law: CrackLaw) -> float:
    """Damage at the strain q > e_0 across a crack: linear softening."""
    if q >= law.e_f:
        return 1.0
    return 1.0 - law.e_0 / q * (law.e_f - q) / (law.e_f - law.e_0)


@compiled(inline="always")
def stiffness_shares(x_n: float, x_t: float, D_n: float, D_t: float, nu: float) -> tuple[float, float]:
    """(a_n, a_t) of the law at the elastic strains (x_n, x_t): 1 - D where the stress is tension, else 1."""
    a_n, a_t = 1.0, 1.0
    for _ in range(2):
        a_n = 1.0 - D_n if x_n + nu * a_t * x_t > 0.0 else 1.0
        a_t = 1.0 - D_t if x_t + nu * a_n * x_n > 0.0 else 1.0
    return a_n, a_t


@compiled(inline="always")
def normal_energy(s_n: float, s_t: float, a_n: float, a_t: float, law: CrackLaw) -> float:
    """Elastic energy of the normal stresses [J/m3]; a crack without stiffness stores none."""
    stored: float = -law.nu * s_n * s_t / law.E
    if a_n > 0.0:
        stored += 0.5 * s_n * s_n / (law.E * a_n)
    if a_t > 0.0:
        stored += 0.5 * s_t * s_t / (law.E * a_t)
    return stored


@compiled(inline="always")
def tension(x_n: float, x_t: float, damage: Array, law: CrackLaw) -> tuple[float, float, float, float, float]:
    """Stresses at elastic strains; ``damage`` (2,) grows as the law asks. Also (a_n, a_t) and the energy it took."""
    nu = law.nu
    a_n, a_t = stiffness_shares(x_n, x_t, damage[N], damage[T], nu)
    f = law.E / (1.0 - nu * nu * a_n * a_t)
    s_n, s_t = f * a_n * (x_n + nu * a_t * x_t), f * a_t * (x_t + nu * a_n * x_n)
    q_n, q_t, took = x_n + nu * s_t / law.E, x_t + nu * s_n / law.E, 0.0
    D_n = max(damage[N], damage_of(q_n, law) if q_n > law.e_0 else 0.0)
    D_t = max(damage[T], damage_of(q_t, law) if q_t > law.e_0 else 0.0)
    if D_n > damage[N] or D_t > damage[T]:
        took = normal_energy(s_n, s_t, a_n, a_t, law)
        damage[N], damage[T] = D_n, D_t
        a_n, a_t = stiffness_shares(x_n, x_t, D_n, D_t, nu)
        f = law.E / (1.0 - nu * nu * a_n * a_t)
        s_n, s_t = f * a_n * (x_n + nu * a_t * x_t), f * a_t * (x_t + nu * a_n * x_n)
        took -= normal_energy(s_n, s_t, a_n, a_t, law)
    return s_n, s_t, a_n, a_t, took


@compiled(inline="always")
def crushing_of(x_n: float, x_t: float, a_n: float, a_t: float, law: CrackLaw) -> tuple[float, float, float, float]:
    """Stresses of a layer that is crushed, and the strain by which it is: across n, across t, else across both.

    The stress returns to the box of both strengths by the shortest way in energy (associated flow), which is along the
    axis whose stress alone, brought back, leaves the other one inside and crushes, not stretches.
    """
    c, nu, E = law.sigma_c, law.nu, law.E
    s_t = E * a_t * x_t - nu * a_t * c
    p_n = x_n + (c + nu * s_t) / E
    if s_t >= -c and p_n <= 0.0:
        return -c, s_t, p_n, 0.0
    s_n = E * a_n * x_n - nu * a_n * c
    p_t = x_t + (c + nu * s_n) / E
    if s_n >= -c and p_t <= 0.0:
        return s_n, -c, 0.0, p_t
    return -c, -c, x_n + (1.0 - nu) * c / E, x_t + (1.0 - nu) * c / E


@compiled(error_model="numpy")
def layer(eps_n: float, eps_t: float, gamma: float, damage: Array, crushed: Array, slip: float, law: CrackLaw) -> Layer:
    """A layer at these strains. ``damage`` and ``crushed`` (2,) for n and t are its states, which follow in place."""
    E, nu = law.E, law.nu
    s_n, s_t, a_n, a_t, cracking = tension(eps_n - crushed[N], eps_t - crushed[T], damage, law)
    f = E / (1.0 - nu * nu * a_n * a_t)
    nn, nt, tt, crushing = f * a_n, f * nu * a_n * a_t, f * a_t, 0.0
    if s_n < -law.sigma_c or s_t < -law.sigma_c:
        s_n, s_t, p_n, p_t = crushing_of(eps_n - crushed[N], eps_t - crushed[T], a_n, a_t, law)
        crushing = -law.sigma_c * (p_n + p_t)
        crushed[N], crushed[T] = crushed[N] + p_n, crushed[T] + p_t
        nn, nt, tt = 0.0 if p_n < 0.0 else E * a_n, 0.0, 0.0 if p_t < 0.0 else E * a_t
    G = 0.5 * E / (1.0 + nu)
    tau, gg, rubbing = G * (gamma - slip), G, 0.0
    if damage[N] > 0.0 or damage[T] > 0.0:
        limit = math.inf
        if damage[N] > 0.0:
            limit = (1.0 - damage[N]) * law.cohesion + law.mu * max(-s_n, 0.0)
        if damage[T] > 0.0:
            limit = min(limit, (1.0 - damage[T]) * law.cohesion + law.mu * max(-s_t, 0.0))
        if abs(tau) > limit:
            new = math.copysign(limit, tau)
            moved = (tau - new) / G
            if cracking > 0.0:  # shear that a new crack lets go at once
                cracking += 0.5 * G * moved * moved
            slip, rubbing, gg, tau = slip + moved, new * moved, 0.0, new
    stored = normal_energy(s_n, s_t, a_n, a_t, law) + 0.5 * tau * tau / G
    return Layer(
        s_n, s_t, tau, nn, nt, tt, gg, slip, stored=stored, cracking=cracking, crushing=crushing, rubbing=rubbing
    )
