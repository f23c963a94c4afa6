"""Figures 2-9, 2-10, 2-11 and 2-18: dispersion of the three waves in the lattice and in the Mindlin-Reissner plate.

The lattice relation is that of Bloch waves in the assembled equations: the rows of an inner node are read from the
stiffness matrix, no formula of (2.37)-(2.39) is typed in.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, limited, near, value
from cosim.verify.plate import TABLE_2_1, ice_of, springs_of
from lattice import continuum
from lattice.grid import Array
from lattice.ice import Ice
from lattice.spectrum import Stencil

PARAMETERS: dict[str, Any] = {key: number for key, number in TABLE_2_1.items() if key not in ("Lx", "Ly")} | {
    "d": [0.1, 1.0, 1.5, 10.0],
    "directions": 24,
}
LONG = 0.02  #: k d of the long waves that are compared
CONTOURS = ((1.0, (500.0, 1000.0, 2000.0), "2-10"), (1.0, (3000.0,), "2-11"))  #: cell size [m], omega [rad/s], figure
MESHES = (5.0, 66.0)  #: omega of Figure 2-18 [rad/s]


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Wave speeds of lattice and plate, and their difference for long waves."""
    ice, kd = ice_of(p), np.linspace(0.01, np.pi, 60)
    quantities = [value("k_x d", kd, "-")]
    curves = {}
    for d in p["d"]:
        stencil = _stencil(ice, p, d)
        curves[d] = (stencil.dispersion(kd, 0.0), continuum.dispersion(ice, kd / d, 0.0))
        quantities += [
            _long_waves(stencil, ice, d, p),
            value(f"lattice, d = {d:g} m", curves[d][0].T, "rad/s"),
            value(f"continuum, d = {d:g} m", curves[d][1].T, "rad/s"),
        ]
    quantities += [_group_velocity(ice, p), *_anisotropy(ice, p)]
    figures = [Figure("figure_2-9", "Figure 2-9: dispersion along x", _draw_branches(kd, curves))]
    figures += [
        Figure(
            f"figure_{number}",
            f"Figure {number}: contours of frequency, d = {d:g} m",
            _draw_contours(ice, p, [d], omegas),
        )
        for d, omegas, number in CONTOURS
    ]
    figures.append(
        Figure(
            "figure_2-18",
            "Figure 2-18: contours of frequency, cell size varied",
            _draw_contours(ice, p, [10 / 3, 2.0, 1.0], MESHES, split=True),
        )
    )
    return CaseResult("dispersion", p, quantities, figures)


def _known(p: dict[str, Any]) -> bool:
    """The plate of Table 2-1 with the matched stiffnesses; cell sizes and directions are free."""
    return all(p[key] == PARAMETERS[key] for key in p if key not in ("d", "directions"))


def _stencil(ice: Ice, p: dict[str, Any], d: float) -> Stencil:
    return Stencil.of_assembled(ice, springs_of(p, ice), d)


def _long_waves(stencil: Stencil, ice: Ice, d: float, p: dict[str, Any]) -> Any:
    """Relative difference of the three branches at k d = 0.02, over all directions."""
    theta = np.linspace(0.0, 0.5 * np.pi, int(p["directions"]))
    kx, ky = LONG * np.cos(theta), LONG * np.sin(theta)
    error = stencil.dispersion(kx, ky) / continuum.dispersion(ice, kx / d, ky / d) - 1.0
    return limited(
        f"three branches at k d = {LONG:g}, all directions, d = {d:g} m: largest difference",
        float(np.abs(error).max()),
        "-",
        LONG**2,
        "(2.43)-(2.45); the lattice is of second order",
        _known(p),
    )


def _group_velocity(ice: Ice, p: dict[str, Any]) -> Any:
    """The shortest wave, k d = pi, stands: its slope over the largest slope (end of section 2.4)."""
    kd = np.linspace(0.0, np.pi, 2001)
    slope = np.gradient(_stencil(ice, p, p["d"][0]).dispersion(kd, 0.0)[:, 0], kd, edge_order=2)
    return limited(
        "group velocity of the deflection wave at k d = pi over its largest",
        float(slope[-1] / slope.max()),
        "-",
        1e-4,
        "van Vliet (2018), section 2.4: standing wave",
        _known(p),
    )


def _anisotropy(ice: Ice, p: dict[str, Any]) -> list[Any]:
    """Radius along the diagonal over the radius along x of the contours of the deflection wave, d = 1 m."""
    out = []
    for omega, limit in ((500.0, 0.02), (2000.0, 0.05)):
        radii = contour(_stencil(ice, p, 1.0), omega, np.array([0.0, 0.25 * np.pi]), 0)
        name = f"anisotropy of the deflection wave, d = 1 m, {omega:g} rad/s"
        ratio = float(radii[1] / radii[0])
        source = "van Vliet (2018), Figure 2-10: almost circular at 500 rad/s, quasi-circular up to 2000 rad/s"
        out.append(near(name, ratio, "-", 1.0 if _known(p) else None, limit, source))
    return out


def contour(stencil: Stencil, omega: float, theta: Array, branch: int) -> Array:
    """K d in direction theta at which the branch has angular frequency omega, by bisection; nan where it has none."""
    low, high = np.zeros(len(theta)), np.pi / np.maximum(np.abs(np.cos(theta)), np.abs(np.sin(theta)))

    def frequency(k: Array) -> Array:
        return stencil.dispersion(k * np.cos(theta), k * np.sin(theta))[:, branch]

    reached = (frequency(low) <= omega) & (frequency(high) >= omega)
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = frequency(middle) < omega
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.where(reached, 0.5 * (low + high), np.nan)


def _draw_branches(kd: Array, curves: dict[float, tuple[Array, Array]]) -> Any:
    def draw(figure: Any) -> None:
        for axes, (d, (ours, exact)) in zip(figure.subplots(2, 2).ravel(), curves.items(), strict=False):
            for branch in range(3):
                axes.plot(kd, exact[:, branch], "-", color=f"C{branch}")
                axes.plot(kd, ours[:, branch], "--", color=f"C{branch}")
            axes.set(
                title=f"d = {d:g} m (lattice dashed)",
                xlabel="k_x d [-]",
                ylabel="omega [rad/s]",
                ylim=(0, 1.3 * ours.max()),
            )

    return draw


def _draw_contours(
    ice: Ice, p: dict[str, Any], sizes: list[float], omegas: tuple[float, ...], split: bool = False
) -> Any:
    def draw(figure: Any) -> None:
        panels = figure.subplots(1, len(omegas) if split else 1, squeeze=False)[0]
        theta = np.linspace(0.0, 2.0 * np.pi, 181)
        for i, omega in enumerate(omegas):
            axes = panels[i if split else 0]
            for j, d in enumerate(sizes):
                colour = f"C{j if split else i}"
                _lattice_contour(axes, _stencil(ice, p, d), omega, d, colour, 1.3 * max(_continuum_radii(ice, omega)))
                axes.plot([], [], "--", color=colour, label=f"lattice d = {d:.3g} m, {omega:g} rad/s")
            radii = _continuum_radii(ice, omega)
            for radius in radii:
                axes.plot(radius * np.cos(theta), radius * np.sin(theta), "-", color="k", linewidth=0.8)
            axes.set(
                aspect="equal",
                xlabel="k_x [1/m]",
                ylabel="k_y [1/m]",
                xlim=(-1.25 * max(radii), 1.25 * max(radii)),
                ylim=(-1.25 * max(radii), 1.25 * max(radii)),
            )
            axes.legend(fontsize=7, loc="upper right")

    return draw


def _lattice_contour(axes: Any, stencil: Stencil, omega: float, d: float, colour: str, reach: float) -> None:
    """Level omega of the three branches over the part of the Brillouin zone |k_x d|, |k_y d| <= pi within reach."""
    kd = min(np.pi, reach * d) * np.linspace(-1.0, 1.0, 161)
    branches = stencil.dispersion(kd[:, None], kd[None, :])
    for branch in range(3):
        if branches[..., branch].min() < omega < branches[..., branch].max():
            axes.contour(kd / d, kd / d, branches[..., branch].T, [omega], colors=colour, linestyles="--")


def _continuum_radii(ice: Ice, omega: float) -> list[float]:
    """Wave numbers of the isotropic plate at omega: where the branches cross it."""
    k = np.linspace(0.0, 20.0, 200001)
    branches = continuum.dispersion(ice, k, 0.0)
    return [float(np.interp(omega, branches[:, b], k)) for b in range(3) if branches[0, b] <= omega <= branches[-1, b]]
