"""Croasdale's load on a slope, as ISO 19906 has it: breaking, and pushing, lifting and turning of what has broken.

Checked term by term against the log of IceFloe (OpenFAST, modules/icefloe, test GLA, ice flexural failure, ISO): that
is the upward-breaking case, horizontal force. From the standard's text as remembered, and unverified: the vertical
force F_V = F_H / xi, and (rho_w - rho_i) in place of rho_i in H_P, H_R, H_L, H_T for a downward-breaking slope.
"""

from __future__ import annotations

from math import cos, pi, sin, tan

from cosim.baselines.case import Case, Load, refuse

NAME = "Croasdale (ISO 19906)"


def croasdale(k: Case) -> Load:
    """All terms in N. `BaselineError` where the ice sticks to the slope or the rubble is steeper than the slope."""
    _check(k)
    rho = k.rho_i if k.breaking == "upward" else k.rho_w - k.rho_i
    s, c = sin(k.a), cos(k.a)
    xi = (s + k.mu * c) / (c - k.mu * s)
    L_c = (k.E * k.h**3 / (12.0 * k.rho_w * k.g * (1.0 - k.nu**2))) ** 0.25
    l_c = k.w if k.wide else k.w + pi**2 * L_c / 4.0
    H_B = 0.68 * xi * k.sigma_f * (k.rho_w * k.g * k.h**5 / k.E) ** 0.25 * l_c
    H_P, H_R, H_L = _rubble(k, rho, xi)
    H_T = 1.5 * k.w * k.h**2 * rho * k.g * c / (s - k.mu * c)
    left = 1.0 - H_B / (k.sigma_f * l_c * k.h)
    if left <= 0.0:
        raise refuse(
            NAME,
            f"H_B = {H_B:.3g} N compresses the sheet more than its strength of {k.sigma_f:g} Pa",
            "this slope does not break it in bending; use less friction or a gentler slope",
        )
    F_H = (H_B + H_P + H_R + H_L + H_T) / left
    terms = {"H_B": H_B, "H_P": H_P, "H_R": H_R, "H_L": H_L, "H_T": H_T}
    between = {"xi": xi, "L_c": L_c, "l_c": l_c, "compression": 1.0 / left}
    return Load(terms, F_H, k.sign * F_H / xi, H_B / left, between)


def _rubble(k: Case, rho: float, xi: float) -> tuple[float, float, float]:
    """H_P (push through rubble), H_R (push the sheet up through it), H_L (lift it) [N]; none without rubble."""
    if k.h_r == 0.0:
        return 0.0, 0.0, 0.0
    s, c, t = sin(k.a), cos(k.a), tan(k.a)
    ride = k.h_r * k.h * rho * k.g * (s + k.mu * c) / s
    R, heap = 1.0 - tan(k.th) / t, rho * k.g * (1.0 - k.e) * k.h_r**2
    cot = 1.0 / tan(k.th) - 1.0 / t
    H_P = k.w * k.mu_i * heap * R**2 / (2.0 * tan(k.th))
    P = 0.5 * (k.mu_i + k.mu) * heap * R * (k.mu_i * s * cot + c / t) + ride
    H_L = 0.5 * k.w * heap * xi * R * (cot + tan(k.ph) * R) + xi * k.c * k.w * k.h_r * R
    return H_P, k.w * P / (c - k.mu * s), H_L


def _check(k: Case) -> None:
    s, c = sin(k.a), cos(k.a)
    if c - k.mu * s <= 0.0 or s - k.mu * c <= 0.0:
        raise refuse(
            NAME,
            f"friction {k.mu:g} on a slope of {k.a * 180 / pi:g} deg: the ice does not slide",
            f"use less than {min(c / s, s / c):.3g}",
        )
    if k.h_r > 0.0 and not 0.0 < k.th < k.a:
        raise refuse(
            NAME,
            f"rubble slope of {k.th * 180 / pi:g} deg on a structure of {k.a * 180 / pi:g} deg",
            "give baseline.rubble_slope between 0 and the structure's slope",
        )
