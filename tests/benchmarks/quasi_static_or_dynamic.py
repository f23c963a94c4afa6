"""Quasi-static against dynamic crack propagation on the four basin floes, breaking only.

    python tests/benchmarks/quasi_static_or_dynamic.py [CASE ...]

Each floe runs twice from rest with the thesis's contact: on the implicit sheet, which finds the equilibrium after
every failed cell, and on the explicit sheet, where the crack runs with its waves and inertia. A third line is the
explicit sheet without material damping. The table gives the first failure, the crack that follows it (cells that
fail within a second, its extent, its mean speed, and the fastest advance of its tip over `CELLS` cells as share of the
speed of Rayleigh waves), the largest kinetic energy in that second as share of the energy stored before it, and the
events. On the implicit sheet a cascade has no duration: its speeds are those of the windows and mean nothing.
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from cosim.build import build_ice, build_sheet, build_structure
from cosim.scenario.loading import load_scenario
from cosim.scenario.scenario import Scenario
from coupling.contact import ContactLaw
from coupling.interface import NS, SheetForces, SimulationError
from coupling.sheet_port import SheetPort
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.ice import Ice
from lattice.sheet import Sheet
from lattice.stiffness import hrennikoff

SCENARIOS = Path(__file__).parents[2] / "scenarios"
CASES = {"floe_165m": 28.0, "floe_55m_centre": 21.0, "floe_55m_corner": 22.5, "floe_34x68m": 52.0}  #: end [s]
NO_RUBBLE = SheetForces(np.empty(0, np.int64), np.empty((0, 3)))
CELLS = 4  #: over which the fastest advance is taken; a single cell may lie ahead of the waves by a sub-step
AFTER = 1.0  #: time after the first failure that counts as the first crack [s]


@dataclass
class Run:
    """What a run gave."""

    sheet: Sheet
    events: list[str] = field(default_factory=list)
    cells: list[tuple[float, int]] = field(default_factory=list)  #: time and number of failed cells
    load: tuple[float, float] = (0.0, 0.0)  #: fx, fz before the first failure [N]
    kinetic: float = 0.0  #: largest within the first second [J]
    stored: float = 0.0  #: energy before the first failure [J]
    wall: float = 0.0


def sheet_of(scenario: Scenario, engine: str) -> Sheet:
    """The floe on the implicit sheet, or on the explicit one with or without material damping."""
    ice, structure = build_ice(scenario), build_structure(scenario)
    sheet = build_sheet(scenario, ice, structure)
    if engine == "quasi-static":
        return sheet
    damping = scenario.water.damping * math.sqrt(ice.k_f * ice.rho_i * ice.h)
    alpha = scenario.ice.material_damping if engine == "dynamic" else 0.0
    springs, window = hrennikoff(ice), scenario.coupling.window
    return ExplicitSheet(
        ExplicitEngine(sheet.grid, ice, springs, window, held_in_plane=sheet.engine.held, damping=damping, alpha=alpha)
    )


def run(case: str, engine: str, until: float) -> Run:
    """Window by window to the end."""
    scenario = load_scenario(SCENARIOS / f"van_vliet_2018_{case}", ["rubble.enabled=false"])
    out = Run(sheet_of(scenario, engine))
    law = ContactLaw(scenario.contact.strength, scenario.contact.friction)
    port = SheetPort(out.sheet, build_structure(scenario), law, scenario.drift.velocity)
    began, window = time.perf_counter(), scenario.window_ns
    for t_ns in range(0, round(until * NS), window):
        before = out.sheet.energy.stored
        broken = out.sheet.intact.copy()
        try:
            report = port.advance(t_ns, window, NO_RUBBLE, np.zeros(3))
        except SimulationError as error:
            out.events.append(f"ends: {error}")
            break
        record(out, report, (t_ns + window) / NS, np.flatnonzero(broken & ~out.sheet.intact), before)
    out.wall = time.perf_counter() - began
    return out


def record(out: Run, report, now: float, failed: np.ndarray, stored: float) -> None:
    """Adds a window to the run."""
    for e in report.events:
        if e.kind != "hand_over":
            out.events.append(f"{e.kind} {e.t_ns / NS:.2f} s {e.force[0] / 1e6:.2f}/{e.force[2] / 1e6:.2f} MN")
    if len(failed) and not out.cells:
        out.load, out.stored = (report.events[0].force[0], report.events[0].force[2]), stored
    if not isinstance(out.sheet, ExplicitSheet):
        out.cells += [(now, int(c)) for c in failed]
    else:
        out.cells = list(zip(out.sheet.failure_times, out.sheet.failed_cells, strict=True))
    if out.cells and now < out.cells[0][0] + AFTER:
        out.kinetic = max(out.kinetic, out.sheet.energy.now.kinetic)


def rayleigh_speed(ice: Ice) -> float:
    """Approximation of Viktorov (1967) with the shear wave speed [m/s]."""
    shear = math.sqrt(ice.E / (2.0 * (1.0 + ice.nu) * ice.rho_i))
    return (0.87 + 1.12 * ice.nu) / (1.0 + ice.nu) * shear


def crack(out: Run) -> dict[str, float]:
    """Extent and speed of the first crack."""
    g = out.sheet.grid
    t, c = np.array([x for x in out.cells if x[0] < out.cells[0][0] + AFTER]).T
    i, j = np.divmod(c.astype(int), g.ny - 1)
    reach = g.d * np.hypot(i - i[0], j - j[0])  # from the first cell
    tip = np.maximum.accumulate(reach)
    gain, wait = tip[CELLS:] - tip[:-CELLS], t[CELLS:] - t[:-CELLS]
    fastest = np.max(gain[wait > 0] / wait[wait > 0], initial=0.0)
    return {
        "cells": len(c),
        "length": g.d * (np.ptp(i) + 1),
        "width": g.d * (np.ptp(j) + 1),
        "speed": tip[-1] / (t[-1] - t[0]) if t[-1] > t[0] else math.nan,
        "fastest": float(fastest),
    }


def main(cases: list[str]) -> None:
    print(
        f"{'floe':16}{'propagation':22}{'first':>9}{'Fx/Fz':>11}{'cells':>6}{'extent x, y':>14}{'speed':>9}"
        f"{'tip':>6}{'kinetic':>9}{'failed':>7}{'pieces':>7}{'wall':>7}"
    )
    for case in cases:
        for engine in ("quasi-static", "dynamic", "dynamic, undamped"):
            out = run(case, engine, CASES[case])
            line(case, engine, out)


def line(case: str, engine: str, out: Run) -> None:
    """One line of the table and its events."""
    if not out.cells:
        print(f"{case:16}{engine:22}no failure; {out.wall:.0f} s")
        return
    k, R = crack(out), rayleigh_speed(out.sheet.ice)
    fx, fz = out.load[0] / 1e6, out.load[1] / 1e6
    print(
        f"{case:16}{engine:22}{out.cells[0][0]:7.3f} s{fx:6.2f}/{fz:.2f}{k['cells']:6.0f}"
        f"{k['length']:8.1f},{k['width']:5.1f}{k['speed']:7.0f} m/s{k['fastest'] / R:6.2f}"
        f"{out.kinetic / out.stored:9.3f}{len(out.cells):7d}{out.sheet.parts:7d}{out.wall:6.0f} s",
        flush=True,
    )
    for event in out.events:
        print(f"{'':16}{event}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:] or list(CASES))
