"""Case `narrow-cone`: what moves the first load of `scenarios/narrow_cone`, one thing at a time.

Thickness and cells, speed of the drift, fracture energy, water that moves along, and the edge: straight, or fitting
round the cone as after an earlier encounter. There is no rubble; the load is that of single windows until it has fallen
to half. Beside it stand ISO 19906 (Croasdale's H_B, a front as wide as the cone) and 3.2 sigma_f h^2 (D / L_c)^0.34,
stated with the case. The beam with which `lattice.cracks.beam` finds the strength of the layers is simulated once more
in the sheet's own cells.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cosim.baselines.croasdale import croasdale
from cosim.baselines.inputs import given
from cosim.build import build, build_ice, build_measured
from cosim.scenario.lengths import characteristic_length
from cosim.scenario.loading import load_scenario
from cosim.scenario.scenario import Scenario
from cosim.verify.case import CaseResult, at_most, value
from coupling.interface import NS
from lattice.cracks.beam import Beam, BeamTest, cut_beam, layer_strength, standard_beam
from lattice.cracks.law import law_of
from lattice.ice import Ice

PARAMETERS: dict[str, Any] = {
    "h": [0.1, 0.2, 0.3],
    "cells": [2.0, 1.0, 0.8],
    "speed": [0.1],
    "energies": [0.0, 38.0],
    "added": [0.0, 10.0],
    "edge": 2.2,
}
REACH, BESIDE = 6.0, 2.2  #: length of the sheet, and its width beside each side of the cone, over L_c
WAY = 1.5  #: drift in which the sheet has to break, over h
WINDOW = 10  #: [ms]; in ice of 0.1 m the load lasts for 60 ms, whose peak windows of 20 ms miss by a tenth
FALLEN = 0.5  #: of the largest load: it has broken
SOURCE = "the mesh of the case, cells of h"


def scenario_of(h: float, cells: float, more: Sequence[str] = (), speed: float = 0.4) -> Scenario:
    """The case at a thickness [m], in cells of so many thicknesses."""
    thickness = f"ice.thickness='{h} m'"
    d, L_c = cells * h, characteristic_length(load_scenario("narrow_cone", [thickness]).model)
    nodes = round(REACH * L_c / d) + 1, 2 * round((BESIDE * L_c + 2.0) / d) + 1  # a node on the axis
    return load_scenario(
        "narrow_cone",
        [
            "rubble.enabled=false",
            thickness,
            f"sheet.length='{(nodes[0] - 1) * d!r} m'",
            f"sheet.width='{(nodes[1] - 1) * d!r} m'",
            f"sheet.nodes=[{nodes[0]}, {nodes[1]}]",
            f"drift.velocity='{speed} m/s'",
            f"coupling.window='{WINDOW} ms'",
            f"scenario.duration='{math.ceil(WAY * h / speed)} s'",
            *more,
        ],
    )


def first_load(scenario: Scenario) -> float:
    """Largest Fx before the load has fallen to half [N]."""
    scheduler, largest = build(scenario), 0.0
    while scheduler.t_ns < scenario.duration_ns:
        fx = float(scheduler.macro_step().load.sum(axis=0)[0])
        largest = max(largest, fx)
        if fx < FALLEN * largest and scheduler.t_ns > 0.05 * NS:
            break
    return largest


def fitting(h: float, cells: float, radius: float) -> float:
    """First load on an edge that is gone within ``radius`` [m] of the middle of the front [N]."""
    s = scenario_of(h, cells).sheet
    i, j = np.indices(s.nodes)
    x, y = i * s.spacing, j * s.spacing
    gone = np.hypot(x + 0.5 * s.spacing - s.length, y - 0.5 * s.width) < radius  # the ice of a node reaches d/2 ahead
    rows = [f"{a!r},{b!r},gone" for a, b in zip(x[gone].tolist(), y[gone].tolist(), strict=True)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "edge.csv"
        file.write_text("\n".join(["x,y,what", *rows, ""]), encoding="utf-8")
        return first_load(scenario_of(h, cells, [f"sheet.broken='{file}'"]))


def formula(h: float) -> float:
    """3.2 sigma_f h^2 (D / L_c)^0.34 with L_c^4 = E h^3 / (12 rho_w g), as stated with the case [N]."""
    L_c = (3e9 * h**3 / (12.0 * 1025.0 * 9.81)) ** 0.25
    return float(3.2 * 700e3 * h**2 * (4.0 / L_c) ** 0.34)


def nominal(scenario: Scenario) -> float:
    """Flexural strength of a beam two of the sheet's cells wide, of the layers that the sheet has [Pa]."""
    ice, m, d = build_ice(scenario), build_measured(scenario), scenario.sheet.spacing
    sigma = layer_strength(ice, m.friction, m.fracture_energy, standard_beam(ice), d)
    layers = Ice(**{**vars(ice), "sigma_t": sigma, "sigma_f": sigma})
    cut = cut_beam(Beam(6.0 * d, 2.0 * d, 1.0), d)
    return BeamTest(layers, law_of(layers, m.fracture_energy, m.friction, cut.grid.d), cut).strength()


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """All of them; ``quick``: ice of 0.2 m on the mesh of the case and on the coarsest."""
    h, cells = (p["h"][1:2], p["cells"][:2]) if quick else (p["h"], p["cells"])
    middle = p["h"][1]
    meshes = [[scenario_of(t, c) for c in cells] for t in h]
    loads = np.array([[first_load(s) for s in row] for row in meshes])
    tested = np.array([[nominal(s) for s in row[:2]] for row in meshes])
    terms = np.array([croasdale(given(row[0].model).case).terms["H_B"] for row in meshes])
    formulas = np.array([formula(t) for t in h])
    out = [
        value("thickness", h, "m"),
        value("cells, over h", cells, "-"),
        value("first load", loads, "N"),
        value("first load over 3.2 sigma_f h^2 (D / L_c)^0.34", loads / formulas[:, None], "-"),
        value("first load over H_B of ISO 19906", loads / terms[:, None], "-"),
        value("nominal strength in the sheet's cells, coarse and those of the case", tested, "Pa"),
        at_most("the latter over 700 kPa, less 1", tested[:, 1] / 700e3 - 1.0, "-", 0.02, "ice.flexural_strength"),
    ]
    if not quick:
        base, c = loads[h.index(middle), 1], cells[1]
        energies = [[f"fracture.fracture_energy='{g} J/m^2'"] for g in p["energies"]]
        added = [[f"water.added_mass={a}"] for a in p["added"]]
        out += [
            at_most("first load on the finest mesh over that of the case, less 1", loads[:, 2] / loads[:, 1] - 1.0,
                    "-", 0.1, SOURCE),
            value("speed", p["speed"], "m/s"),
            value("first load at it, 0.2 m", [first_load(scenario_of(middle, c, speed=v)) for v in p["speed"]], "N"),
            value("fracture energy", p["energies"], "J/m2"),
            value("first load at it, 0.2 m", [first_load(scenario_of(middle, c, more)) for more in energies], "N"),
            value("water that moves along, over what is displaced", p["added"], "-"),
            value("first load with it, 0.2 m", [first_load(scenario_of(middle, c, more)) for more in added], "N"),
            value("first load on an edge round the cone over that on a straight one",
                  fitting(middle, cells[2], p["edge"]) / base, "-"),
        ]  # fmt: skip
    return CaseResult("narrow-cone", p, out)
