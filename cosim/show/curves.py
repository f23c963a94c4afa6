"""The load over time as a figure: phases stacked, total as a line, peaks and events marked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from cosim.analysis.run_data import RunData
from cosim.show.figures import draw_loads
from coupling.interface import NS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: events that are marked: colour and style of their line
MARKED = {
    "split": ("#b03a2e", "-"),
    "circumferential": ("#1d2733", "--"),
    "hinge": ("#8d6cab", ":"),
}


def curves(run: RunData, over: float | None = None) -> Figure:
    """Fx and Fz by phase, means over a time [s], default the averaging time."""
    from cosim.show.shown import Shown

    figure = Shown(figsize=(9.0, 5.0), layout="constrained")
    draw_curves(figure, run, over)
    return figure


def draw_curves(figure: Figure, run: RunData, over: float | None = None) -> None:
    """Draw them into a figure."""
    seconds = run.averaging if over is None else over
    draw_loads(figure, run, seconds)
    for ax, name in zip(figure.axes, ("fx", "fz"), strict=True):
        _mark_peak(ax, run.averaged(seconds), name)
        _mark_events(ax, run)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    for old in figure.legends:
        old.remove()
    figure.legend(handles, labels, ncols=len(labels), fontsize=8, loc="outside upper center")


def _mark_peak(ax: Axes, run: RunData, name: str) -> None:
    values, drawn = run.component(name), np.asarray(ax.lines[0].get_ydata())
    k = int(np.abs(values).argmax())
    late, up = run.t[k] > 0.7 * run.t[-1], values[k] > 0.0
    ax.plot(run.t[k], drawn[k], "o", ms=5, mfc="none", mec="#b03a2e", mew=1.5)
    ax.annotate(
        f"{drawn[k]:.3g} at {run.t[k]:.2f} s",
        (float(run.t[k]), float(drawn[k])),
        xytext=(-7 if late else 7, 4 if up else -4),
        textcoords="offset points",
        ha="right" if late else "left",
        va="bottom" if up else "top",
        fontsize=8,
        color="#b03a2e",
        bbox={"fc": "w", "ec": "none", "pad": 0.8, "alpha": 0.8},
    )
    ax.margins(y=0.16)


def _mark_events(ax: Axes, run: RunData) -> None:
    for kind, (colour, style) in MARKED.items():
        times = [e.t_ns / NS for e in run.events if e.kind == kind]
        for number, t in enumerate(times):
            ax.axvline(t, color=colour, ls=style, lw=0.9, alpha=0.8, label=kind if number == 0 else None)
