"""How the viewer is laid out: two cameras, loads, events."""

from __future__ import annotations

import json
import tomllib
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from cosim.analysis.run_data import RunData
from cosim.show.cells import over_text
from cosim.show.scale import Scale, scale_of

TIMELINE = "simulated_time"


def blueprint(run: RunData) -> rrb.Blueprint:
    """Two cameras on the left, of the sheet and of the rubble; loads and events on the right."""
    reach = 0.5 * float(run.metadata["spacing_m"]) * max(_nodes(run))
    above = _view(
        "Sheet: blue to red = utilisation, dark = cracked",
        (-0.5 * reach - 44, -0.6 * reach - 46, 0.4 * reach + 36),
        (-0.3 * reach - 8, -4, -4),
        (24, 34, 52),
    )
    below = _rubble_view(run)
    scale, over = load_scale(run), over_text(run.averaging)
    curves = [
        rrb.TimeSeriesView(
            origin=f"/load/{axis}",
            name=f"{label} on the structure [{scale.unit}], mean over {over}",
            axis_x=rrb.TimeAxis(view_range=rr.TimeRange(start=_boundary(0.0), end=_boundary(float(run.t[-1])))),
            plot_legend=rrb.PlotLegend(corner="LeftTop", visible=True),
        )
        for axis, label in (("fx", "Fx"), ("fz", "Fz"))
    ]
    log = rrb.TextLogView(origin="/events", name="Events")
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(above, below), rrb.Vertical(*curves, log, row_shares=[3, 3, 2]), column_shares=[3, 2]
        ),
        rrb.TimePanel(timeline=TIMELINE, state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _boundary(seconds: float) -> Any:
    return rr.TimeRangeBoundary.absolute(seconds=seconds)


def load_scale(run: RunData) -> Scale:
    """In which the curves of a run are drawn."""
    return scale_of((np.abs(run.lasting.component(axis)).max(initial=0.0) for axis in ("fx", "fz")), "N")


def _rubble_view(run: RunData) -> Any:
    """From under water, or from above it where ice rides up: close by, as blocks are as long as a few thicknesses."""
    scenario = tomllib.loads(run.texts.get("scenario.toml", ""))
    colours = "orange = rotating, green = sliding"
    if scenario.get("structure", {}).get("breaking") != "upward":
        return _view(f"Rubble from under water: {colours}", (-58, -52, -24), (-12, 0, -7), (14, 52, 70))
    h = float(run.metadata["thickness_m"])
    return _view(
        f"Rubble from above: {colours}", (-14.0 * h - 4, -16.0 * h - 8, 7.0 * h + 4), (-2.0 * h, 0, 0), (14, 52, 70)
    )


def _nodes(run: RunData) -> list[int]:
    nodes: list[int] = json.loads(run.metadata["nodes"])
    return nodes


def _view(name: str, position: tuple[float, ...], target: tuple[float, ...], rgb: tuple[int, int, int]) -> Any:
    return rrb.Spatial3DView(
        name=name,
        origin="/world",
        background=rrb.Background(color=(*rgb, 255), kind="SolidColor"),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(position=position, look_target=target, eye_up=(0, 0, 1)),
    )
