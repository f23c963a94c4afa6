"""How the viewer is laid out: two cameras, section, plan, loads, events, lights."""

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
from cosim.show.ice.scene import Scene, scene_of
from cosim.show.ice.section import extent as section_extent
from cosim.show.scale import Scale, scale_of

TIMELINE = "simulated_time"


def blueprint(run: RunData, end: float | None = None) -> rrb.Blueprint:
    """On the left two cameras, the section and the plan; on the right loads, events and lights.

    Curves reach to ``end`` [s], by default that of what is recorded.
    """
    end = float(run.t[-1]) if end is None else end
    f = _nearness(run)
    reach = 0.5 * float(run.metadata["spacing_m"]) * max(_nodes(run))
    above = _view(
        "Sheet: pale to dark red = utilisation, black = cracked",
        (-0.5 * reach - 44 * f, -0.6 * reach - 46 * f, 0.4 * reach + 36 * f),
        (-0.3 * reach - 8 * f, -4 * f, -4 * f),
        (24, 34, 52),
    )
    scene = scene_of(run)
    flat = rrb.Horizontal(
        _flat("section", "Section: orange = rotating, green = sliding, pink = forces", section_extent(scene, 0.0)),
        _flat("plan", "From above: pieces, cracks (red), blocks", _plan_bounds(scene)),
    )
    scale, over = load_scale(run), over_text(run.averaging)
    curves = [
        rrb.TimeSeriesView(
            origin=f"/load/{axis}",
            name=f"{label} on the structure [{scale.unit}], mean over {over}",
            axis_x=rrb.TimeAxis(view_range=rr.TimeRange(start=_boundary(0.0), end=_boundary(end))),
            plot_legend=rrb.PlotLegend(corner="LeftTop", visible=True),
        )
        for axis, label in (("fx", "Fx"), ("fz", "Fz"))
    ]
    told = rrb.Tabs(
        rrb.TextLogView(origin="/events", name="Events"), rrb.TextDocumentView(origin="/about", name="Lights")
    )
    ice = rrb.Vertical(rrb.Horizontal(above, _rubble_view(run)), flat, row_shares=[3, 2])
    return rrb.Blueprint(
        rrb.Horizontal(ice, rrb.Vertical(*curves, told, row_shares=[3, 3, 2]), column_shares=[3, 2]),
        rrb.TimePanel(timeline=TIMELINE, state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _plan_bounds(scene: Scene) -> tuple[float, float, float, float]:
    """Around the structure: x from, to, then y from, to [m]."""
    radius = scene.structure.half_width if np.isfinite(scene.structure.half_width) else 0.3 * scene.width
    ahead = max(3.0 * radius, 15.0 * scene.thickness)
    return -ahead, 1.3 * radius, -2.2 * radius, 2.2 * radius


def _flat(origin: str, name: str, bounds: tuple[float, float, float, float]) -> Any:
    """A view of lines; bounds are x from, to, then upwards from, to [m]."""
    x0, x1, low, high = bounds
    seen = rrb.VisualBounds2D(x_range=(x0, x1), y_range=(-high, -low))
    return rrb.Spatial2DView(origin=f"/{origin}", name=name, background=(16, 24, 34), visual_bounds=seen)


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
