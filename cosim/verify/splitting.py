"""Figure 4-13 and the Resolute test, Table 4-1 and Figure 4-14: splitting of an edge-cracked square plate.

"60x60 nodes" of the thesis are 60 x 60 cells here. Poisson's ratio is 1/3: the 0.33 of Table 4-1 brings in shear
springs that resist rotation. Loading is slow, so the plate is in equilibrium until the first cell fails; at constant
load the crack then runs through.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, limited, near, value
from lattice.criteria.laws import crack_tip_splitting
from lattice.edge_crack import normalised_load
from lattice.grid import Array
from lattice.ice import Ice
from lattice.specimens import EdgeCrack

PARAMETERS: dict[str, Any] = {
    "L": 30.0,
    "h": 1.8,
    "a": 9.0,
    "rate": 303.0,
    "E": 8.7e9,
    "nu": 1.0 / 3.0,
    "K_IC": 238.0e3,
    "ratio": 5.0,
    "cells": 60,
}
RATIOS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
SOURCE = "van Vliet (2018), section 4.2.1"


def _ice(p: dict[str, Any], d: float) -> Ice:
    sigma_t = float(np.sqrt(2.0 / (np.pi * d)) * p["K_IC"])  # (4.22) stands for sigma_t, (4.23)
    return Ice(
        E=p["E"],
        nu=p["nu"],
        h=p["h"],
        rho_i=920.0,
        rho_w=1025.0,
        sigma_t=sigma_t,
        sigma_c=p["ratio"] * sigma_t,
        K_IC=p["K_IC"],
    )


def critical(p: dict[str, Any], cells: int, cut: int) -> tuple[float, Array]:
    """Force at which a crack of ``cut`` cells runs on [N] and the opening along the crack line then [m]."""
    ice = _ice(p, p["L"] / cells)
    specimen = EdgeCrack(ice, p["L"], cells, cut)
    u = specimen.displacement()
    force = 1.0 / float(crack_tip_splitting(specimen.tip_state(u), ice)[0])
    return force, force * specimen.opening(u)


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Load at which the crack runs and its opening; ``quick``: a coarser exact solution."""
    cells = int(p["cells"])
    cut = round(p["a"] / p["L"] * cells)
    EdgeCrack(_ice(p, p["L"] / cells), p["L"], cells, cut)  # refuses a crack that leaves the plate
    known = p == PARAMETERS
    force, opening = critical(p, cells, cut)
    quantities = _resolute(p, force, opening, cut, known)
    normalised, more = _normalised(p, cells, quick)
    quantities += more
    history = _history(p, cells, cut, force)
    quantities += [
        value("time of Figure 4-14", history[:, 0], "s"),
        value("CMOD, COD, CTOD of Figure 4-14", history[:, 1:].T, "m"),
    ]
    return CaseResult("splitting", p, quantities, [_figure_13(normalised), _figure_14(history)])


def _resolute(p: dict[str, Any], force: float, opening: Array, cut: int, known: bool) -> list[Quantity]:
    start, mouth, middle, tip = force / p["rate"], opening[0], opening[cut // 2], opening[cut]
    soft = p["E"] / 5.0e9

    def check(name: str, number: float, unit: str, reference: float, tolerance: float) -> Quantity:
        return near(name, number, unit, reference if known else None, tolerance, SOURCE)

    return [
        check("start of the crack", start, "s", 1186.0, 0.005),
        value("force at the start", force, "N"),
        check("CMOD at the start", mouth, "m", 722e-6, 0.05),
        value("COD at the start", middle, "m"),
        check("CTOD at the start", tip, "m", 19e-6, 0.05),
        check("CMOD with E = 5 GPa", mouth * soft, "m", 1255e-6, 0.05),
        check("CTOD with E = 5 GPa", tip * soft, "m", 33e-6, 0.05),
    ]


def _normalised(p: dict[str, Any], cells: int, quick: bool) -> tuple[dict[str, Array], list[Quantity]]:
    """F / (h K_IC sqrt(L)) of (4.26) against a / L, for two cell sizes and LEFM."""
    scale = p["h"] * p["K_IC"] * np.sqrt(p["L"])
    curves = {
        f"lattice, {n} cells": np.array([critical(p, n, round(r * n))[0] for r in RATIOS]) / scale
        for n in (cells // 2, cells)
    }
    curves["LEFM"] = normalised_load(np.array(RATIOS), 80 if quick else 120)
    fine = curves[f"lattice, {cells} cells"]
    error = fine / curves["LEFM"] - 1.0
    rise = float(np.maximum(np.diff(fine[1:]), 0.0).max())
    inside = np.array([0.2 <= r <= 0.7 for r in RATIOS])
    source = "LEFM, energy release rate of a crack without width"
    name = f"F(a/L) against LEFM, a/L = 0.2 ... 0.7, {cells} cells: relative difference"
    full = p["cells"] == PARAMETERS["cells"] and abs(p["nu"] - 1.0 / 3.0) < 1e-9
    quantities = [
        value("a/L", RATIOS, "-"),
        *(value(f"normalised load, {n}", c, "-") for n, c in curves.items()),
        limited(name, error[inside], "-", 0.01, source, full),
        limited(
            "rise of F with a/L beyond 0.2 (falling: the crack runs unstably)",
            rise,
            "-",
            0.0,
            "van Vliet (2018), Figure 4-13",
            full,
        ),
    ]
    return curves, quantities


def _history(p: dict[str, Any], cells: int, cut: int, force: float) -> Array:
    """Time and the three openings: equilibrium up to the start, then cell by cell at the same load."""
    start, rows = force / p["rate"], []
    for length in range(cut, cells - 3):
        limit, opening = critical(p, cells, length)
        if length > cut and limit > force:
            break
        at_start = opening * (force / limit)
        three = at_start[[0, cut // 2, cut]]
        rows += [[0.0, 0.0, 0.0, 0.0], [start, *three]] if length == cut else [[start, *three]]
    return np.array(rows)


def _figure_13(curves: dict[str, Array]) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        fine = np.linspace(0.08, 0.82, 75)
        axes.plot(fine, normalised_load(fine, 120), "k-", label="LEFM (energy release rate)")
        for marker, (name, curve) in zip("os", list(curves.items())[:2], strict=True):
            axes.plot(RATIOS, curve, marker, mfc="none", label=name)
        axes.set(xlabel="a / L [-]", ylabel="F / (h K_IC sqrt(L)) [-]", ylim=(0, None))
        axes.legend()

    return Figure("figure_4-13", "Figure 4-13: load at which the crack runs", draw)


def _figure_14(history: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for column, name in enumerate(("CMOD", "COD", "CTOD"), 1):
            axes.plot(history[:, 0], 1e6 * history[:, column], label=name)
        axes.set(xlabel="time [s]", ylabel="opening [micrometre]", ylim=(0, 2500))
        axes.legend()

    return Figure("figure_4-14", "Figure 4-14: opening of the crack, Resolute test", draw)
