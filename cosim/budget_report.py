"""The force budget of a recorded run as a table and a picture: what carries the load, see `coupling.budget`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.features import at_peak
from cosim.moments import encounters
from cosim.run_data import RunData
from coupling.budget import AXES, TERMS
from coupling.interface import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {
    "dry_tops": "#e6812b",
    "flooded_rubble": "#3a9b5c",
    "pressed_sheet": "#2f7ebc",
    "drag": "#8d6cab",
    "inertia": "#b8bfc6",
    "held": "#5aa9c4",
    "staggering": "#e3c04b",
}


def rows(run: RunData) -> list[dict[str, Any]]:
    """The terms [MN] of Fx and Fz at both peaks, in the last window before each circumferential failure (the first of
    each encounter), and on the mean of the run; empty without a budget.
    """
    if not run.budget or not len(run.t_ns):
        return []
    at_fz, at_fx = (at_peak(run, name) or 0 for name in ("fz", "fx"))
    moments = [("peak of Fz", at_fz), ("peak of Fx", at_fx)] if at_fz != at_fx else [("peak of Fz and Fx", at_fz)]
    moments += [("before failure", e.event - 1) for e in encounters(run) if e.event > 0]
    table = [_row(run, when, f"{run.t[k]:.2f}", axis, slice(k, k + 1)) for when, k in moments for axis in ("fz", "fx")]
    return table + [_row(run, "mean", "all", axis, slice(None)) for axis in ("fz", "fx")]


def _row(run: RunData, when: str, time: str, axis: str, windows: slice) -> dict[str, Any]:
    length = (run.t_ns - run.begin_ns)[windows]

    def mean(values: Array) -> float:
        return float(np.average(values[windows], weights=length)) / 1e6

    terms = {name.replace("_", " "): mean(run.budget[f"{axis}_{name}"]) for name in (*TERMS, "residual")}
    return {
        "when": when,
        "time": time,
        "component": axis.capitalize(),
        "total": mean(run.component(axis)),
        "terms": terms,
    }


def largest_residual(run: RunData) -> dict[str, float]:
    """Largest residual of any window as a share of the run's largest load, by component."""
    if not run.budget or not len(run.t_ns):
        return {}
    return {
        axis: float(np.abs(run.budget[f"{axis}_residual"]).max() / max(np.abs(run.component(axis)).max(), 1e-9))
        for axis in AXES
    }


def draw(figure: Figure, run: RunData) -> None:
    """Terms over time, stacked from zero up where they lift the structure and down where not; the total on top."""
    axes = figure.subplots(2, 1, sharex=True)
    for ax, axis in zip(axes, ("fz", "fx"), strict=True):
        terms = np.array([run.budget[f"{axis}_{name}"] for name in TERMS]) / 1e6
        for side, label in ((np.maximum(terms, 0.0), True), (np.minimum(terms, 0.0), False)):
            names = [name.replace("_", " ") for name in TERMS] if label else ()
            ax.stackplot(run.t, side, colors=[COLOURS[name] for name in TERMS], labels=names, alpha=0.8, lw=0)
        total = run.component(axis) / 1e6
        ax.plot(run.t, total, "k", lw=0.7, label="total")
        ax.set_ylabel(f"{axis.capitalize()} [MN]")
        _focus(ax, terms, total)
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=8, fontsize=7, loc="outside upper center")
    axes[1].set_xlabel("time [s]")
    axes[1].set_xlim(0.0, run.t[-1])


def _focus(ax: Axes, terms: Array, total: Array) -> None:
    """Limits in which the load is seen; how much of the stacks sticks out is said in the picture."""
    up, down = np.maximum(terms, 0.0).sum(axis=0), np.minimum(terms, 0.0).sum(axis=0)
    high, low = 1.15 * max(total.max(), 1e-3), min(1.15 * total.min(), -0.5 * total.max())
    out = np.mean((up > high) | (down < low))
    ax.set_ylim(low, high)
    if out > 0.0:
        ax.text(
            0.995,
            0.03,
            f"stacks of {out:.1%} of the windows end outside",
            transform=ax.transAxes,
            ha="right",
            fontsize=7,
        )
    ax.grid(alpha=0.3)
