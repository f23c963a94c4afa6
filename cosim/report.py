"""One HTML page of a recorded run: loads by phase, balances, events, and the numbers beside the reference.

Needs the extra ``report`` (matplotlib, jinja2).
"""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim import budget_report
from cosim.baselines.beside import beside
from cosim.compare import compare, reference_of
from cosim.console import compare_cells
from cosim.console_baseline import BESIDE, beside_rows, remarks
from cosim.errors import FailedError
from cosim.features import shares_at_peak, summary
from cosim.run_data import RunData
from coupling.interface import NS, PHASES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = {"breaking": "#2f7ebc", "rotating": "#e6812b", "sliding": "#3a9b5c"}
STORES = ("elastic_energy", "foundation_energy", "kinetic_energy")
LOSSES = ("damping_loss", "scheme_loss", "fracture_loss", "handed_over_energy")
ICE = ("sheet_mass", "rubble_mass", "crushed_mass", "cleared_mass")


def write_report(run: RunData, out: Path) -> None:
    """Writes the page; pictures are inside it."""
    try:
        import jinja2
        import matplotlib
    except ImportError as error:
        text = f"{error.name} is missing: install the extra, for example `uv sync --extra report`"
        raise FailedError(text) from error
    matplotlib.use("Agg")
    template = files("cosim").joinpath("report.html.j2").read_text("utf-8")
    page = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined).from_string(template)
    out.write_text(page.render(content(run)), "utf-8")


def content(run: RunData) -> dict[str, Any]:
    """What the page shows, ready for its template."""
    design = beside(run)
    figures = [picture(title, draw, run) for title, draw in FIGURES.items() if has_data(title, run)]
    return {"summary": summary(run), "rows": _rows(run), "figures": figures, "shares": shares_at_peak(run),
            "budget": budget_report.rows(run), "bound": budget_report.largest_residual(run),
            "design": {"head": BESIDE, "rows": beside_rows(design), "remarks": remarks(design)},
            "events": [{"time": e.t_ns / NS, "kind": e.kind, "fx": e.force[0] / 1e6, "fz": e.force[2] / 1e6,
                        "cells": e.cells, "text": e.text} for e in run.events],
            "metadata": dict(run.metadata), "scenario": run.texts.get("scenario.toml", "")}


def _rows(run: RunData) -> list[tuple[str, ...]]:
    """Features beside their reference, as text; the last column is the source."""
    if "reference.toml" not in run.texts:
        return []
    _, reference = reference_of(run, None)
    return [(*compare_cells(row), row.feature.source) for row in compare(run, reference)]


def has_data(title: str, run: RunData) -> bool:
    """Whether a figure has something to show: a recording may hold no energy books and no force budget."""
    needs = {"energy": "contact_work" in run.ledger, "carries": bool(run.budget)}
    return all(there for word, there in needs.items() if word in title)


def picture(title: str, draw: Callable[[Figure, RunData], None], run: RunData) -> dict[str, str]:
    """A figure as PNG for an HTML page."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    draw(figure, run)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=130)
    return {"title": title, "png": base64.b64encode(buffer.getvalue()).decode()}


def draw_loads(figure: Figure, run: RunData) -> None:
    """Fx and Fz by phase, stacked, with the total as a line."""
    axes = figure.subplots(2, 1, sharex=True)
    for ax, name, label in zip(axes, ("fx", "fz"), ("Fx [MN]", "Fz [MN]"), strict=True):
        phases = np.array([run.component(name, p) for p in PHASES]) / 1e6
        for side, labels in ((np.maximum, list(PHASES)), (np.minimum, ())):  # what presses down is stacked downwards
            ax.stackplot(run.t, side(phases, 0.0), colors=COLOURS.values(), labels=labels, alpha=0.75, lw=0)
        ax.plot(run.t, phases.sum(axis=0), "k", lw=0.7, label="total")
        ax.set_ylabel(label)
        ax.grid(alpha=0.3)
    figure.legend(*axes[0].get_legend_handles_labels(), ncols=4, fontsize=8, loc="outside upper center")
    axes[1].set_xlabel("time [s]")
    axes[1].set_xlim(0.0, run.t[-1])


def draw_mass(figure: Figure, run: RunData) -> None:
    """Where the ice is that has left the sheet."""
    ax = figure.subplots()
    for name in ICE[1:]:
        ax.plot(run.t, run.ledger[name] / 1e6, label=name.removesuffix("_mass"))
    ax.set(xlabel="time [s]", ylabel="mass [1000 t]", xlim=(0.0, run.t[-1]))
    ax.legend()
    ax.grid(alpha=0.3)


def draw_energy(figure: Figure, run: RunData) -> None:
    """Work done on the sheet, what it stores and where the rest went."""
    ax = figure.subplots()
    terms = {name.rsplit("_", 1)[0].replace("_", " "): run.ledger[name] / 1e3 for name in STORES + LOSSES}
    ax.stackplot(run.t, np.maximum(list(terms.values()), 0.0), labels=list(terms), alpha=0.8, lw=0)
    work = (run.ledger["contact_work"] + run.ledger["rubble_work"]) / 1e3
    ax.plot(run.t, work, "k", lw=1.0, label="work on the sheet")
    ax.set(xlabel="time [s]", ylabel="energy [kJ]", xlim=(0.0, run.t[-1]))
    ax.legend(fontsize=8, loc="upper left", ncols=2)
    ax.grid(alpha=0.3)


FIGURES: dict[str, Callable[[Any, RunData], None]] = {
    "Load on the structure by phase": draw_loads,
    "What carries the load": budget_report.draw,
    "Ice that has left the sheet": draw_mass,
    "Work and energy of the sheet": draw_energy,
}
