"""The picture of a `mohr-plane` record."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import Figure
from cosim.verify.mohr_record import Record
from lattice.criteria.laws import BETA, INTERCEPT, SLOPE
from lattice.criteria.mohr import mohr_factors
from lattice.grid import Array
from lattice.ice import Ice

TOP, BOTTOM, FAILING = "tab:blue", "0.62", "tab:orange"


def envelope(ice: Ice, mean: Array, limit: float) -> Array:
    """Radius times E at which (4.6), with (6.1), is reached at these means times E [Pa]."""
    F_1, F_2 = mohr_factors(ice.nu, ice.sigma_c / ice.sigma_t)
    return F_2 * limit - F_1 * mean


def compressive_limit(ice: Ice, mean: Array) -> Array:
    """Radius times E at which (4.5) is reached [Pa]."""
    return np.asarray((INTERCEPT * ice.sigma_c - SLOPE * mean) / (np.sin(2.0 * BETA) + SLOPE * np.cos(2.0 * BETA)))


def mohr_figure(floe: str, number: str, record: Record) -> Figure:
    """Blue: top, grey: bottom, orange: failing, as in the thesis."""

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        span = 1.2 * record.ice.sigma_t / 1e6
        _states(axes, record, 1.3 * span)
        _lines(axes, record, span)
        axes.set(xlabel="mean x E [MPa]", ylabel="radius x E [MPa]", xlim=(-span, span), ylim=(0.0, 1.3 * span))
        axes.set_aspect("equal")
        figure.legend(loc="outside right center", frameon=False)

    return Figure(f"figure_{number}", f"Figure {number}: strain of all cells up to the failure, {floe}", draw)


def _states(axes: Any, record: Record, height: float) -> None:
    states = np.concatenate(record.snapshots) * record.ice.E / 1e6
    for k, color, name, level in ((2, BOTTOM, "bottom", 1), (0, TOP, "top", 2)):
        axes.plot(states[:, k], states[:, k + 1], ".", color=color, markersize=1.2, mew=0.0, zorder=level)
        axes.plot([], [], "o", color=color, markersize=4, label=f"all cells, {name}")
    for located, face, name in ((False, "none", "rest of a cascade"), (True, FAILING, "failing, first of a cascade")):
        points = record.failing_circles(located) / 1e6
        beyond = int((points[:, 1] > height).sum())
        name += f"\n({beyond} beyond the picture)" if beyond else ""
        axes.plot(*points.T, "o", mec=FAILING, mfc=face, markersize=4.5, zorder=5, label=name)


def _lines(axes: Any, record: Record, span: float) -> None:
    ice, mean = record.ice, np.linspace(-2.0 * span, 2.0 * span, 2)
    axes.plot(mean, envelope(ice, mean * 1e6, ice.sigma_t) / 1e6, "k--", label="envelope (4.6), (6.1)")
    for limit in sorted({f.limit for f in record.failures} - {ice.sigma_t}):
        axes.plot(
            mean, envelope(ice, mean * 1e6, limit) / 1e6, "--", color=FAILING, lw=1.0, label="beside a crack tip (4.31)"
        )
    axes.plot(mean, compressive_limit(ice, mean * 1e6) / 1e6, "k:", label="compressive limit (4.5)")
    slope, end = (1.0 + ice.nu) / (1.0 - ice.nu), 0.6 * span
    for side, name, place in ((1.0, "$\\sigma_{22} = 0$", "left"), (-1.0, "$\\sigma_{11} = 0$", "right")):
        axes.annotate("", (side * end, slope * end), (0.0, 0.0), arrowprops={"arrowstyle": "->"}, zorder=4)
        axes.text(side * 1.03 * end, slope * end, name, ha=place, va="bottom")
    for x, y, text in ((0.4, 0.08, "T-T"), (-0.38, 1.15, "T-C"), (-0.4, 0.08, "C-C")):
        axes.text(x * span, y * span, text, ha="center", fontsize=14, weight="bold", zorder=6)
