"""Nevel's wedges: the sheet in front of a cone, cut by radial cracks, breaks as beams of growing width on water.

From memory (Nevel 1961, 1972; used by Lubbad and Loset for ships) and unverified: no worked example was found. What
it leaves out is more than what it has: no ride-up, no rubble, no in-plane compression. Number of wedges and loaded
length are assumptions: half a circle of equal wedges with their tips on the axis, loaded over the radius of the cone.
"""

from __future__ import annotations

from math import cos, pi, sin, tan

from cosim.baselines.case import Case, Load, refuse


def nevel(k: Case) -> Load:
    """N wedges of tip angle th = pi / n, P = sigma_f h^2 / 6 . 2 tan(th / 2) . [1.05 + 2 r/l + 0.5 (r/l)^3] [N]."""
    if k.wedges < 2:
        raise refuse("Nevel", f"{k.wedges} wedge in half a circle", "give baseline.wedges of 2 or more")
    slip = cos(k.a) - k.mu * sin(k.a)
    if slip <= 0.0:
        raise refuse(
            "Nevel",
            f"friction {k.mu:g} on a slope of {k.a * 180 / pi:g} deg: the ice does not slide",
            f"use less than {1.0 / tan(k.a):.3g}",
        )
    xi = (sin(k.a) + k.mu * cos(k.a)) / slip
    length = (k.E * k.h**3 / (12.0 * k.rho_w * k.g)) ** 0.25
    ratio = 0.5 * k.w / length
    P = k.sigma_f * k.h**2 / 6.0 * 2.0 * tan(0.5 * pi / k.wedges) * (1.05 + 2.0 * ratio + 0.5 * ratio**3)
    H_B = xi * k.wedges * P
    return Load({"H_B": H_B}, H_B, k.sign * k.wedges * P, H_B, {"l": length, "P": P, "xi": xi})
