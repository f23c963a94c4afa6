"""Ralston's plastic limit load on a cone, in two forms that differ in the yield criterion: compare like with like.

* Tresca, Y = 2.711, as ISO 19906 and IEC 61400-3 have it. H_B and H_R are checked against the log of IceFloe
  (OpenFAST, modules/icefloe, test GLA, ice flexural failure, IEC). Its vertical force is from memory, but equals the
  independent one of the second form to six digits for the same breaking load.
* Johansen, Y = 3.422, with the coefficients A and B of Ralston (1977), as in the manual of IceDyn (OpenFAST),
  p. 26-28. Larger than the first: 4.32 against 3.74 MN in the test GLA. Its equation for lambda is the minimum of
  the Tresca form (1.369 = 1 + 1 / 2.711, 0.0922 = 1 / (4 . 2.711)), so its load is not the least for Y = 3.422. Kept.

A downward-breaking cone has (rho_w g) / 9 in place of rho_i g (Ralston 1977, from memory, unverified).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, log, pi, sin, sqrt, tan

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from cosim.baselines.case import Case, Load, refuse

Y_TRESCA, Y_JOHANSEN = 2.711, 3.422


@dataclass(frozen=True)
class Cone:
    """What depends on slope and friction alone."""

    g: float  #: g_r
    f: float
    h_v: float
    E1: float  #: complete elliptic integral of the first kind, modulus sin a
    E2: float  #: of the second kind


def cone_of(k: Case, name: str) -> Cone:
    """`BaselineError` if friction is so large that the ice does not slide (1 - mu g <= 0)."""
    s, c = sin(k.a), cos(k.a)
    g = (s + k.a / c) / (0.5 * pi * s**2 + 2.0 * k.mu * k.a * c)
    if 1.0 - k.mu * g <= 0.0:
        raise refuse(
            name,
            f"friction {k.mu:g} on a cone of {k.a * 180 / pi:g} deg: the ice does not slide",
            f"it must stay below 1 / g = {1.0 / g:.3g}",
        )
    if not 0.0 <= k.D_T < k.w:
        raise refuse(
            name,
            f"top diameter {k.D_T:g} m of a cone of {k.w:g} m",
            "give baseline.top_diameter below the waterline diameter",
        )
    E1, E2 = float(ellipk(s**2)), float(ellipe(s**2))
    f = s + k.mu * E1 * c
    h_v = (f * c - k.mu * E2) / (0.25 * pi * s**2 + k.mu * k.a * c)
    return Cone(g, f, h_v, E1, E2)


def _weight(k: Case) -> float:
    """Weight of ice per volume, or what stands for it at a downward-breaking cone [N/m3]."""
    return (k.rho_i if k.breaking == "upward" else k.rho_w / 9.0) * k.g


def ralston_tresca(k: Case) -> Load:
    """H_B breaking and H_R ride-up, V_B and V_R their vertical parts [N]; x is the standard's approximation."""
    q, rho_g, c = cone_of(k, "Ralston (ISO/IEC form)"), _weight(k), cos(k.a)
    G = rho_g * k.w**2 / (4.0 * k.sigma_f * k.h)
    x = 1.0 + 1.0 / sqrt(3.0 * G + 0.5 * Y_TRESCA)
    bend = (1.0 + Y_TRESCA * x * log(x)) / (x - 1.0) + G * (x - 1.0) * (x + 2.0)
    H_B = k.sigma_f * k.h**2 / 3.0 * tan(k.a) / (1.0 - k.mu * q.g) * bend
    W = rho_g * k.h_R * (k.w**2 - k.D_T**2) / (4.0 * c)  # per unit angle: no pi
    H_R = W * (tan(k.a) + k.mu * q.E2 - k.mu * q.f * q.g * c) / (1.0 - k.mu * q.g)
    V_B, V_R = H_B * q.h_v, W * c * (0.5 * pi * c - k.mu * k.a - q.f * q.h_v) + H_R * q.h_v
    between = {"G": G, "x": x, "g_r": q.g, "f": q.f, "h_v": q.h_v, "E1": q.E1, "E2": q.E2, "W": W}
    return Load({"H_B": H_B, "H_R": H_R, "V_B": V_B, "V_R": V_R}, H_B + H_R, k.sign * (V_B + V_R), H_B, between)


def ralston_johansen(k: Case) -> Load:
    """A1 breaking, A2 lifting the broken ice, A3 ride-up, all with A4; B1 and B2 vertical [N]."""
    q, rho_g, s, c = cone_of(k, "Ralston (A/B form)"), _weight(k), sin(k.a), cos(k.a)
    G = rho_g * k.w**2 / (k.sigma_f * k.h)
    x = _root(lambda v: v - log(v) + 0.0922 * G * (2.0 * v + 1.0) * (v - 1.0) ** 2 - 1.369)
    ring = rho_g * k.h_R * (k.w**2 - k.D_T**2)
    A1 = (1.0 + Y_JOHANSEN * x * log(x)) / (3.0 * (x - 1.0))
    A2 = (x**2 + x - 2.0) / 12.0
    A3 = 0.25 * (1.0 / c + k.mu * q.E2 / s - k.mu * q.f * q.g / tan(k.a))
    A4 = tan(k.a) / (1.0 - k.mu * q.g)
    B2 = 0.25 * (0.5 * pi * c - k.mu * k.a - q.f * q.h_v)
    terms = {"A1": A1 * A4 * k.sigma_f * k.h**2, "A2": A2 * A4 * rho_g * k.h * k.w**2, "A3": A3 * A4 * ring}
    R_H = sum(terms.values())
    between = {"lambda": x, "A1": A1, "A2": A2, "A3": A3, "A4": A4, "B1": q.h_v, "B2": B2, "g_r": q.g}
    return Load(terms, R_H, k.sign * (q.h_v * R_H + B2 * ring), terms["A1"] + terms["A2"], between)


def _root(equation: Callable[[float], float]) -> float:
    """Lambda > 1; the equation rises from -0.369 at 1 without bound."""
    high = 2.0
    while equation(high) < 0.0:
        high *= 2.0
    return float(brentq(equation, 1.0, high, xtol=1e-14, rtol=1e-14))
