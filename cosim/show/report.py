"""One HTML page of a recorded run: loads by phase, balances, events, and the numbers beside the reference."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2

from cosim.analysis import budget
from cosim.analysis.compare import compare, reference_of
from cosim.analysis.lights import trust, trust_lines
from cosim.analysis.peaks import shares_at_peak
from cosim.analysis.reference import FeatureError
from cosim.analysis.run_data import RunData
from cosim.analysis.summary import summary
from cosim.baselines.beside import beside
from cosim.series.compare import Comparison
from cosim.show.baseline_cells import beside_table, remarks
from cosim.show.cells import COMPARED, compare_cells, over_text
from cosim.show.figures import FIGURES, has_data
from cosim.show.png import picture
from cosim.show.scale import scale_of
from cosim.show.series_tables import page_parts
from coupling.interface import NS


def write_report(run: RunData, out: Path, series: Comparison | None = None) -> None:
    """Writes the page, also of a measured series beside the run; pictures are inside it."""
    template = files("cosim.show").joinpath("report.html.j2").read_text("utf-8")
    page = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined).from_string(template)
    out.write_text(page.render(content(run, series)), "utf-8")


def content(run: RunData, series: Comparison | None = None) -> dict[str, Any]:
    """What the page shows, ready for its template."""
    design = beside(run)
    head, design_rows = beside_table(design)
    shares = shares_at_peak(run)
    figures = [picture(title, draw, run) for title, draw in FIGURES.items() if has_data(title, run)]
    return {
        "summary": summary(run),
        "trust": trust_lines(trust(run)),
        "over": over_text(run.averaging),
        "loads": scale_of((row["value"] for row in shares.values()), "N"),
        "compared": COMPARED,
        **_beside_reference(run),
        "figures": figures,
        "shares": shares,
        "series": [] if series is None else page_parts(series),
        "budget": budget.rows(run),
        "bound": budget.largest_residual(run),
        "design": {"head": head, "rows": design_rows, "remarks": remarks(design)},
        "events": [
            {
                "time": e.t_ns / NS,
                "kind": e.kind,
                "fx": e.force[0],
                "fz": e.force[2],
                "cells": e.cells,
                "text": e.text,
            }
            for e in run.lasting.events
        ],
        "metadata": dict(run.metadata),
        "scenario": run.texts.get("scenario.toml", ""),
    }


def _beside_reference(run: RunData) -> dict[str, Any]:
    """Features beside the reference that the run carries, as text, the last column the source; why there are none."""
    if "reference.toml" not in run.texts:
        return {"rows": [], "reference_fault": ""}
    try:
        _, reference = reference_of(run, None)
    except FeatureError as error:
        return {"rows": [], "reference_fault": str(error)}
    rows = [(*compare_cells(row), row.feature.source) for row in compare(run, reference)]
    return {"rows": rows, "reference_fault": ""}
