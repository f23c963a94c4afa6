"""Case `cone-breaking`: the first breaking load of upward-breaking cones in open field beside Croasdale's term H_B.

The cone of IceFloe's test (`scenarios/icefloe_gla_upward_cone`: 60 deg, 5 m, ice of 1 m, 15 J/m2), then one of
thickness, slope and diameter changed at a time. The sheet reaches 5.5 characteristic lengths back and is held on three
sides; there is no rubble. What breaks the sheet is the largest load before it has fallen by a third, or until the ice
has come `WAY` thicknesses. H_B is the breaking term of ISO 19906, which IceFloe logs for this cone as 1.844 MN; its
width l_c grows by 2.5 L_c however narrow the cone, so it says what a wide front of radial cracks carries.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cosim.baselines.croasdale import croasdale
from cosim.baselines.inputs import given
from cosim.build import build
from cosim.scenario.loading import load_scenario
from cosim.scenario.scenario import Scenario
from cosim.verify.case import CaseResult, Figure, near, value
from coupling.interface import NS

PARAMETERS: dict[str, Any] = {
    "h": [1.0, 0.5, 0.2],
    "slope": [60.0, 52.0, 45.0],
    "diameter": [5.0, 10.0, 14.0],
    "cracks": "closing",
}
REACH, BESIDE = 5.5, 2.0  #: length of the sheet, and its width beside each side of the cone, over L_c
WAY = 3.0  #: drift in which the sheet has to break, over h
FALLEN = 2.0 / 3.0  #: of the largest load: it has broken
SOURCE = "H_B of ISO 19906, IceFloe's log"


class Cone(NamedTuple):
    """A cone in level ice."""

    h: float  #: [m]
    slope: float  #: [deg]
    diameter: float  #: at the waterline [m]


def scenario_of(cone: Cone, cracks: str, coarser: float) -> Scenario:
    """The sheet around the cone, in cells of h or a fifth of the diameter, but not less than 0.08 L_c."""
    h, radius = cone.h, 0.5 * cone.diameter
    L_c = (8e9 * h**3 / (12.0 * 999.8 * 9.81 * (1.0 - 1.0 / 9.0))) ** 0.25
    d = coarser * max(0.08 * L_c, min(h, 0.4 * radius))
    length, width = REACH * L_c, 2.0 * BESIDE * L_c + cone.diameter
    nodes = round(length / d) + 1, 2 * round(0.5 * width / d) + 1  # a node on the axis
    return load_scenario(
        "icefloe_gla_upward_cone",
        [
            "rubble.enabled=false",
            "recording.every='1 s'",
            f"ice.thickness='{h} m'",
            f"structure.slope='{cone.slope} deg'",
            f"structure.waterline_radius='{radius} m'",
            f"structure.neck_radius='{0.3 * radius} m'",
            f"structure.toe_depth='{0.5 * radius} m'",
            f"sheet.length='{(nodes[0] - 1) * d} m'",
            f"sheet.width='{(nodes[1] - 1) * d} m'",
            f"sheet.nodes=[{nodes[0]}, {nodes[1]}]",
            f"fracture.cracks='{cracks}'",
            f"scenario.duration='{round(WAY * h / 0.2, 1)} s'",
        ],
    )


def first_break(scenario: Scenario) -> tuple[float, float]:
    """Largest Fx before the sheet has broken [N], and its time [s]."""
    scheduler, largest, at = build(scenario), 0.0, 0.0
    while scheduler.t_ns < scenario.duration_ns:
        fx = float(scheduler.macro_step().load.sum(axis=0)[0])
        if fx > largest:
            largest, at = fx, scheduler.t_ns / NS
        elif fx < FALLEN * largest:
            break
    return largest, at


def breaking_term(scenario: Scenario) -> float:
    """H_B [N]."""
    return croasdale(given(scenario.model).case).terms["H_B"]


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """All cones; ``quick``: the first one on a mesh half as fine."""
    h, slope, D = (p[k] for k in ("h", "slope", "diameter"))
    cones = [Cone(t, slope[0], D[0]) for t in h]
    cones += [Cone(h[0], s, D[0]) for s in slope[1:]] + [Cone(h[0], slope[0], w) for w in D[1:]]
    scenarios = [scenario_of(c, p["cracks"], 2.0 if quick else 1.0) for c in (cones[:1] if quick else cones)]
    found, terms = np.array([first_break(s) for s in scenarios]), np.array([breaking_term(s) for s in scenarios])
    ratio = found[:, 0] / terms
    known = p == PARAMETERS
    return CaseResult(
        "cone-breaking",
        p,
        [
            value("thickness [m], slope [deg], diameter [m]", cones[: len(found)], "-"),
            value("first breaking load", found[:, 0], "N"),
            value("time of it", found[:, 1], "s"),
            value("H_B", terms, "N"),
            near(
                "first breaking load over H_B, the cone of IceFloe", ratio[0], "-", 1.0 if known else None, 0.25, SOURCE
            ),
            value("first breaking load over H_B", ratio, "-"),
        ],
        [] if quick else [_figure(cones, ratio)],
    )


def _figure(cones: list[Cone], ratio: Any) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots(1, 3, sharey=True)
        names = "thickness [m]", "slope [deg]", "waterline diameter [m]"
        for k, (ax, name) in enumerate(zip(axes, names, strict=True)):
            same = [i for i, c in enumerate(cones) if all(c[j] == cones[0][j] for j in range(3) if j != k)]
            same.sort(key=lambda i: cones[i][k])
            ax.plot([cones[i][k] for i in same], [ratio[i] for i in same], "o-")
            ax.axhline(1.0, color="k", lw=0.8)
            ax.set(xlabel=name, ylim=(0, None))
        axes[0].set_ylabel("first breaking load / H_B [-]")

    return Figure("ratio", "Cones in open field beside Croasdale's breaking term", draw)
