"""Figures 6-12, 6-25, 6-26 and 6-31: strain of all cells of the basin floes in the plane of Mohr's circle.

Mean and radius of the circle times E, at the top and at the bottom of every cell, from the first touch to the first
split or circumferential failure of the shipped scenarios, breaking only. In this plane (4.6) with (6.1) is a straight
line, and so are the compressive limit (4.5) and the axes on which a principal stress is zero,
R = +-(1 + nu) / (1 - nu) mean; between them lie the states in tension and compression, "T-C".

The first cell of a cascade fails on the line, at the instant that the engine locates. The others of the cascade take
over its load at the same instant and are found beyond the line. A cell beside a crack tip has the limit (4.31).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from cosim.scenario.scenario import Scenario
from cosim.verify.case import CaseResult, Quantity, at_most, near, value
from cosim.verify.mohr_figure import mohr_figure
from cosim.verify.mohr_record import Record, Witness
from coupling.scheduler import Scheduler
from coupling.sheet_port import SheetPort
from lattice.sheet import Sheet

PARAMETERS: dict[str, Any] = {"floe": "all"}


@dataclass(frozen=True)
class Floe:
    """A shipped scenario and what the thesis found for it."""

    scenario: str
    figure: str
    section: str
    fx: float  #: at the first split or circumferential failure [N]
    fz: float  #: [N]
    tolerance: float  #: of both


FLOES = {
    "165m": Floe("van_vliet_2018_floe_165m", "6-12", "6.3", 5.4e6, 4.6e6, 0.07),
    "55m-corner": Floe("van_vliet_2018_floe_55m_corner", "6-25", "6.4", 3.3e6, 2.8e6, 0.05),
    "55m-centre": Floe("van_vliet_2018_floe_55m_centre", "6-26", "6.4", 3.2e6, 2.7e6, 0.05),
    "34x68m": Floe("van_vliet_2018_floe_34x68m", "6-31", "6.5", 2.7e6, 2.3e6, 0.05),
}
QUICK_NODES = 28  #: along each side of the 55 m floe, instead of 40
ON_LINE = 1e-4  #: of the utilisation of a located failure against 1


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """States of the floes until their first large failure; ``quick``: one floe, coarse."""
    if p["floe"] not in ("all", *FLOES):
        raise ValueError(f"mohr-plane: floe = {p['floe']} is unknown; known: all, {', '.join(FLOES)}")
    chosen = list(FLOES) if p["floe"] == "all" else [p["floe"]]
    if quick:
        chosen = ["55m-centre"]
    quantities, figures = [], []
    for name in chosen:
        record = record_of(FLOES[name], ["sheet.nodes=[28, 28]"] if quick else [])
        quantities += _quantities(name, FLOES[name], record)
        figures.append(mohr_figure(name, FLOES[name].figure, record))
    return CaseResult("mohr-plane", p, quantities, figures)


def record_of(floe: Floe, changes: list[str]) -> Record:
    """Runs the breaking phase of a floe to its first split or circumferential failure."""
    try:
        scenario = load_scenario(floe.scenario, ["rubble.enabled=false", *changes])
    except ScenarioError as error:
        raise ValueError(str(error)) from None
    with threadpool_limits(1):
        return _watch(scenario)


def _watch(scenario: Scenario) -> Record:
    scheduler = build(scenario)
    sheet = _witness(scheduler)
    record = Record(sheet.ice)
    while scheduler.t_ns < scenario.duration_ns:
        frame = scheduler.macro_step()
        record.see(sheet)
        for event in frame.events:
            if event.kind in ("split", "circumferential"):
                record.close(event)
                return record
    raise ValueError(f"mohr-plane: the floe of {scenario.name} does not fail within {scenario.duration_ns / 1e9:g} s")


def _witness(scheduler: Scheduler) -> Witness:
    """The sheet of a run, exchanged for one that keeps the states in which its cells fail."""
    port = scheduler.sheet
    assert isinstance(port, SheetPort)
    assert isinstance(port.sheet, Sheet)
    sheet = Witness.of(port.sheet)
    port.sheet = sheet
    return sheet


def _quantities(name: str, floe: Floe, r: Record) -> list[Quantity]:
    thesis = f"van Vliet (2018), section {floe.section}"
    figure = f"van Vliet (2018), Figure {floe.figure}"
    located, cascade = r.failing(True), r.failing(False)
    dominant = float(r.share[1] - max(r.share[0], r.share[2]))
    return [
        near(f"{name}: Fx at the failure", r.force[0], "N", floe.fx, floe.tolerance, thesis),
        near(f"{name}: Fz at the failure", r.force[2], "N", floe.fz, floe.tolerance, thesis),
        value(f"{name}: time of the failure", r.time, "s"),
        _below_one(f"{name}: largest utilisation (4.6) of an intact cell away from crack tips", r.inside, figure),
        _below_one(f"{name}: largest utilisation (4.31) of an intact cell beside a crack tip", r.inside_tip, figure),
        _below_one(f"{name}: largest utilisation (4.5) in compression", r.compression, "van Vliet (2018), 4.1.1"),
        at_most(
            f"{name}: failing cells at the located instant: distance from their envelope",
            np.abs(located - 1.0).max(),
            "-",
            ON_LINE,
            figure,
        ),
        value(f"{name}: utilisation of the cells that follow in a cascade", cascade, "-"),
        value(f"{name}: share of the states in T-T, T-C, C-C", r.share, "-"),
        Quantity(
            f"{name}: T-C before the next quadrant (dominant: above 0)",
            dominant,
            "-",
            0.0,
            thesis,
            0.0,
            "at least",
            bool(dominant > 0.0),
        ),
        value(f"{name}: mean and radius times E of failing cells, worse face", r.failing_circles(True).T, "Pa"),
    ]


def _below_one(name: str, utilisation: float, source: str) -> Quantity:
    return Quantity(name, utilisation, "-", 1.0, source, 1e-9, "at most", utilisation <= 1.0 + 1e-9)
