"""How the viewer is laid out: two cameras, loads, events."""

from __future__ import annotations

import json
import tomllib
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from cosim.analysis.run_data import RunData
from cosim.scenario.units import si_of
from cosim.show.cells import over_text
from cosim.show.scale import Scale, scale_of

TIMELINE = "simulated_time"


def blueprint(run: RunData) -> rrb.Blueprint:
    """Two cameras on the left, of the sheet and of the rubble; loads and events on the right."""
    f = _nearness(run)
    reach = 0.5 * float(run.metadata["spacing_m"]) * max(_nodes(run))
    above = _view(
        "Sheet: blue to red = utilisation, dark = cracked",
        (-0.5 * reach - 44 * f, -0.6 * reach - 46 * f, 0.4 * reach + 36 * f),
        (-0.3 * reach - 8 * f, -4 * f, -4 * f),
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
        f = _nearness(run)
        eye, target = (-58 * f, -52 * f, -24 * f), (-12 * f, 0.0, -7 * f)
        return _view(f"Rubble from under water: {colours}", eye, target, (14, 52, 70))
    h = float(run.metadata["thickness_m"])
    eye = (-18.0 * h, -24.0 * h, 11.0 * h)
    return _view(f"Rubble from above: {colours}", eye, (-2.0 * h, 0, 0), (14, 52, 70))


def _nearness(run: RunData) -> float:
    """How near the cameras stand, 1 at a cone of 15 m: by the radius at the waterline, without one by the thickness."""
    structure = tomllib.loads(run.texts.get("scenario.toml", "")).get("structure", {})
    radius = structure.get("waterline_radius")
    return si_of(radius) / 15.0 if isinstance(radius, str) else float(run.metadata["thickness_m"]) / 3.0


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
