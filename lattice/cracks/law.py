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


class History(NamedTuple):
    """What a layer has been through."""

    D_n: float  #: damage across the crack, 0 to 1
    D_t: float  #: damage along it
    p_n: float  #: strain of crushing across the crack [-]
    p_t: float  #: strain of crushing along it [-]
    slip: float  #: plastic part of the shear strain [-]


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
    """Damage at the strain q across a crack: none up to e_0, then linear softening."""
    share = law.e_0 / (law.e_f - law.e_0)  # infinite where the ice is brittle: then it is not used
    soft = 1.0 - share * (law.e_f - q) / q
    torn = 1.0 if q >= law.e_f else soft
    return torn if q > law.e_0 else 0.0


@compiled(inline="always")
def stiffness_shares(x_n: float, x_t: float, D_n: float, D_t: float, nu: float) -> tuple[float, float]:
    """(a_n, a_t) of the law at the elastic strains (x_n, x_t): 1 - D where the stress is tension, else 1."""
    a_n = 1.0 - D_n if x_n + nu * x_t > 0.0 else 1.0
    a_t = 1.0 - D_t if x_t + nu * a_n * x_n > 0.0 else 1.0
    a_n = 1.0 - D_n if x_n + nu * a_t * x_t > 0.0 else 1.0
    a_t = 1.0 - D_t if x_t + nu * a_n * x_n > 0.0 else 1.0
    return a_n, a_t


@compiled(inline="always")
def normal_stresses(x_n: float, x_t: float, a_n: float, a_t: float, law: CrackLaw) -> tuple[float, float, float]:
    """At the elastic strains (x_n, x_t), and E / (1 - nu^2 a_n a_t) [Pa]."""
    nu = law.nu
    f = law.E / (1.0 - nu * nu * a_n * a_t)
    return f * a_n * (x_n + nu * a_t * x_t), f * a_t * (x_t + nu * a_n * x_n), f


@compiled(inline="always")
def crushing_of(x_n: float, x_t: float, a_n: float, a_t: float, law: CrackLaw) -> tuple[float, float, float, float]:
    """Stresses of a layer that is crushed, and the strain by which it is: across n, across t, else across both.

    The stress returns to the box of both strengths by the shortest way in energy (associated flow), which is along the
    axis whose stress alone, brought back, leaves the other one inside and crushes, not stretches.
    """
    c, nu, E, soft = law.sigma_c, law.nu, law.E, 1.0 / law.E
    s_t = E * a_t * x_t - nu * a_t * c
    p_n = x_n + (c + nu * s_t) * soft
    s_n = E * a_n * x_n - nu * a_n * c
    p_t = x_t + (c + nu * s_n) * soft
    across, along = (s_t >= -c) & (p_n <= 0.0), (s_n >= -c) & (p_t <= 0.0)
    only_n, only_t, both = across, along & (not across), (1.0 - nu) * c * soft
    s_t = s_t if only_n else -c
    s_n = s_n if only_t else -c
    p_n = p_n if only_n else 0.0 if only_t else x_n + both
    p_t = p_t if only_t else 0.0 if only_n else x_t + both
    return s_n, s_t, p_n, p_t


@compiled(inline="always")
def shear_limit(D_n: float, D_t: float, s_n: float, s_t: float, law: CrackLaw) -> float:
    """Largest shear stress that the cracks bear, infinite without cracks [Pa]."""
    push_n, push_t = -s_n if s_n < 0.0 else 0.0, -s_t if s_t < 0.0 else 0.0
    across = (1.0 - D_n) * law.cohesion + law.mu * push_n if D_n > 0.0 else math.inf
    along = (1.0 - D_t) * law.cohesion + law.mu * push_t if D_t > 0.0 else math.inf
    return along if along < across else across


@compiled(inline="always")
def follow(eps_n: float, eps_t: float, gamma: float, was: History, law: CrackLaw) -> tuple[Layer, History]:
    """A layer at these strains and what it has been through then. No branch: all layers of a cell go side by side."""
    E, nu, c = law.E, law.nu, law.sigma_c
    x_n, x_t, soft = eps_n - was.p_n, eps_t - was.p_t, nu / E
    a_n, a_t = stiffness_shares(x_n, x_t, was.D_n, was.D_t, nu)
    o_n, o_t, _ = normal_stresses(x_n, x_t, a_n, a_t, law)
    D_n, D_t = damage_of(x_n + soft * o_t, law), damage_of(x_t + soft * o_n, law)
    D_n, D_t = D_n if D_n > was.D_n else was.D_n, D_t if D_t > was.D_t else was.D_t
    a_n, a_t = stiffness_shares(x_n, x_t, D_n, D_t, nu)
    s_n, s_t, f = normal_stresses(x_n, x_t, a_n, a_t, law)
    cracking = 0.5 * ((o_n - s_n) * x_n + (o_t - s_t) * x_t)
    k_n, k_t, r_n, r_t = crushing_of(x_n, x_t, a_n, a_t, law)
    crushes = (s_n < -c) | (s_t < -c)
    s_n, s_t = k_n if crushes else s_n, k_t if crushes else s_t
    r_n, r_t = r_n if crushes else 0.0, r_t if crushes else 0.0
    e_n, e_t = 0.0 if r_n < 0.0 else E * a_n, 0.0 if r_t < 0.0 else E * a_t
    nn, nt, tt = e_n if crushes else f * a_n, 0.0 if crushes else f * nu * a_n * a_t, e_t if crushes else f * a_t
    G = 0.5 * E / (1.0 + nu)
    tried, limit = G * (gamma - was.slip), shear_limit(D_n, D_t, s_n, s_t, law)
    slips = abs(tried) > limit
    tau = math.copysign(limit, tried) if slips else tried
    moved = (tried - tau) * (1.0 / G)
    cracking += 0.5 * G * moved * moved if cracking > 0.0 else 0.0  # shear that a new crack lets go at once
    stored = 0.5 * (s_n * (x_n - r_n) + s_t * (x_t - r_t) + tau * tau * (1.0 / G))
    now = History(D_n, D_t, was.p_n + r_n, was.p_t + r_t, was.slip + moved)
    gg, rubbing = 0.0 if slips else G, tau * moved
    return Layer(
        s_n,
        s_t,
        tau,
        nn,
        nt,
        tt,
        gg,
        now.slip,
        stored=stored,
        cracking=cracking,
        crushing=-c * (r_n + r_t),
        rubbing=rubbing,
    ), now


@compiled(error_model="numpy")
def layer(eps_n: float, eps_t: float, gamma: float, damage: Array, crushed: Array, slip: float, law: CrackLaw) -> Layer:
    """A layer at these strains. ``damage`` and ``crushed`` (2,) for n and t are its states, which follow in place."""
    out: Layer
    out, now = follow(eps_n, eps_t, gamma, History(damage[N], damage[T], crushed[N], crushed[T], slip), law)
    damage[N], damage[T], crushed[N], crushed[T] = now.D_n, now.D_t, now.p_n, now.p_t
    return out
