"""The force budget of a recorded run as a picture, see `coupling.budget`."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from cosim.analysis.budget import carriers
from cosim.analysis.run_data import RunData
from cosim.show.scale import scale_of
from coupling.interface import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


#: told apart by people who do not see red from green (Okabe and Ito 2008)
COLOURS = {
    "dry_tops": "#e69f00",
    "flooded_rubble": "#009e73",
    "pressed_sheet": "#0072b2",
    "drag": "#cc79a7",
    "inertia": "#b8bfc6",
    "held": "#56b4e9",
    "sea_bed": "#8c510a",
    "staggering": "#f0e442",
}
#: of loads on the sheet, one after the other
OTHERS = ("#1d2733", "#d55e00", "#7a5195", "#9acd32", "#8c2d4a", "#6b7f3f")


def draw(figure: Figure, run: RunData) -> None:
    """Terms over time, stacked from zero up where they lift the structure and down where not; the total on top.

    Terms that are zero in every window are left out.
    """
    run = run.lasting
    axes = figure.subplots(2, 1, sharex=True)
    scale = scale_of((np.abs(run.component(axis)).max() for axis in ("fz", "fx")), "N")
    drawn = [name for name in carriers(run) if any(np.any(run.budget[f"{axis}_{name}"]) for axis in ("fz", "fx"))]
    colours = colours_of(drawn)
    for ax, axis in zip(axes, ("fz", "fx"), strict=True):
        terms = np.array([run.budget[f"{axis}_{name}"] for name in drawn]) / scale.size
        for side, label in ((np.maximum(terms, 0.0), True), (np.minimum(terms, 0.0), False)):
            names = [name.replace("_", " ") for name in drawn] if label else ()
            ax.stackplot(run.t, side, colors=colours, labels=names, alpha=0.8, lw=0)
        total = run.component(axis) / scale.size
        ax.plot(run.t, total, "k", lw=0.7, label="total")
        ax.set_ylabel(f"{axis.capitalize()} [{scale.unit}]")
        _focus(ax, terms, total)
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=8, fontsize=7, loc="outside upper center")
    axes[1].set_xlabel("time [s]")
    axes[1].set_xlim(0.0, run.t[-1])


def colours_of(names: Sequence[str]) -> list[str]:
    """A colour for every term, none twice as long as there are no more than six loads on the sheet."""
    more = cycle(OTHERS)
    return [COLOURS[name] if name in COLOURS else next(more) for name in names]


def _focus(ax: Axes, terms: Array, total: Array) -> None:
    """Limits in which the load is seen; how much of the stacks sticks out is said in the picture."""
    up, down = np.maximum(terms, 0.0).sum(axis=0), np.minimum(terms, 0.0).sum(axis=0)
    most, least = max(total.max(), 0.0), min(total.min(), 0.0)
    high, low = max(1.15 * most, -0.5 * least, 1e-9), min(1.15 * least, -0.5 * most)
    out = np.mean((up > high) | (down < low))
    ax.set_ylim(low, high)
    if out > 0.0:
        ax.set_title(f"stacks of {out:.1%} of the windows end outside", loc="right", fontsize=7, pad=2.0)
    ax.grid(alpha=0.3)
