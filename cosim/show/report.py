"""One HTML page of a recorded run: what was asked, the answer and its lights, the ice, curves, balances, parameters."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable
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
from cosim.recording.pictures import Picture
from cosim.series.compare import Comparison
from cosim.show.baseline_cells import beside_table, remarks
from cosim.show.cells import COMPARED, compare_cells, over_text
from cosim.show.figures import FIGURES, has_data
from cosim.show.ice.figures import draw_look, draw_waterline
from cosim.show.ice.history import looks
from cosim.show.ice.scene import scene_of
from cosim.show.mohr import Recorded, mohr_picture
from cosim.show.page.numbers import balances, budget_table, curve_data, moment_table, statistics
from cosim.show.page.parameters import parameters
from cosim.show.png import picture
from cosim.show.scale import scale_of
from cosim.show.series_tables import page_parts
from coupling.interface import NS

CONTENTS = (
    *("answer", "ice", "curves", "stresses", "statistics", "moments", "budget", "formulas", "events", "parameters"),
)


def write_report(
    run: RunData,
    out: Path,
    series: Comparison | None = None,
    pictures: Iterable[Picture] | None = None,
    stresses: Recorded = (None, None),
) -> None:
    """Writes the page, also of a measured series beside the run, of recorded pictures and stresses; all is inside."""
    template = files("cosim.show").joinpath("report.html.j2").read_text("utf-8")
    environment = jinja2.Environment(
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    page = environment.from_string(template).render(content(run, series, pictures, stresses))
    out.write_text(page.lstrip(), "utf-8")


def content(
    run: RunData,
    series: Comparison | None = None,
    pictures: Iterable[Picture] | None = None,
    stresses: Recorded = (None, None),
) -> dict[str, Any]:
    """What the page shows, ready for its template."""
    design = beside(run)
    head, design_rows = beside_table(design)
    shares, found = shares_at_peak(run), trust(run)
    shown = {
        "summary": summary(run),
        "trust": trust_lines(found),
        "trustworthy": found["trustworthy"],
        "over": over_text(run.averaging),
        "loads": scale_of((row["value"] for row in shares.values()), "N"),
        "compared": (*COMPARED, "source"),
        **_beside_reference(run),
        "ice": [] if pictures is None else _ice(run, list(pictures)),
        "figures": [picture(title, draw, run) for title, draw in FIGURES.items() if has_data(title, run)],
        "stresses": mohr_picture(*stresses),
        "shares": shares,
        "statistics": statistics(run),
        "moments": moment_table(run),
        "balances": balances(run),
        "series": [] if series is None else page_parts(series),
        "budget": budget_table(run),
        "bound": budget.largest_residual(run),
        "design": {"head": head, "rows": design_rows, "remarks": remarks(design)},
        "events": _events(run),
        "metadata": dict(run.metadata),
        "parameters": parameters(run),
    }
    there = {name for name in CONTENTS if shown.get(name) != [] and shown.get(name, True) is not None}
    return shown | _frame(run, there)


def _frame(run: RunData, there: set[str]) -> dict[str, Any]:
    """What was asked, versions, the list of contents, and the curves that can be enlarged."""
    scenario = tomllib.loads(run.texts.get("scenario.toml", ""))
    libraries = json.loads(run.metadata.get("libraries", "{}"))
    own = {key: run.metadata[key] for key in ("version", "commit") if key in run.metadata}
    return {
        "asked": scenario.get("scenario", {}).get("description", ""),
        "contents": [(name.capitalize(), name) for name in CONTENTS if name in there],
        "versions": own | libraries,
        "curves": curve_data(run),
        "script": files("cosim.show.page").joinpath("curves.js").read_text("utf-8"),
    }


def _ice(run: RunData, pictures: list[Picture]) -> list[dict[str, str]]:
    """Plan and section at the peaks, and the load along the waterline."""
    scene = scene_of(run)
    out = [
        picture(look.title[:1].upper() + look.title[1:], draw_look, scene.at(run, look.picture.t_ns), look)
        for look in looks(run, pictures)
    ]
    return [*out, picture("Load along the waterline, by place across the drift", draw_waterline, scene, pictures)]


def _events(run: RunData) -> list[dict[str, Any]]:
    return [
        {"time": e.t_ns / NS, "kind": e.kind, "fx": e.force[0], "fz": e.force[2], "cells": e.cells, "text": e.text}
        for e in run.lasting.events
    ]


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
