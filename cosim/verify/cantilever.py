"""Tables 4-2, 4-3, 4-4 and Figure 4-18: in-situ cantilever beams without stress relief.

All with Poisson's ratio 1/3, sigma_c = 5 sigma_f and one mesh: 4 cells over the width of the beam (5 nodes, Figure
4-16a), plate twice as long as the beam and clamped. Mean and radius at the root are averages over the four
connections, as (4.24) and (4.25) ask. The eta_mean and R_eta printed for Table 4-4 are exchanged in the thesis.
``dt`` is the time step of Figure 4-18; 0 takes nine tenths of the stable one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.cantilever_failure import figure_18, history
from cosim.verify.case import CaseResult, Figure, Quantity, near, value
from lattice.grid import Array
from lattice.ice import Ice
from lattice.properties import brine_volume, youngs_modulus
from lattice.specimens import Piece, beam_strain, cantilever, factor_f

PARAMETERS: dict[str, Any] = {
    "L_b": 2.30,
    "w": 0.46,
    "h": 0.39,
    "E": 1.3e9,
    "nu": 1.0 / 3.0,
    "sigma_f": 0.186e6,
    "rho_i": 920.0,
    "rho_w": 1025.0,
    "ratio": 5.0,
    "cells": 4,
    "dynamic": True,
    "dt": 0.0,
}
#: change to the base case and f of Table 4-3
TABLE_4_3: dict[str, tuple[dict[str, float], float]] = {
    "base case": ({}, 0.80),
    "1.5 x length": ({"L_b": 1.5}, 0.80),
    "2 x thickness": ({"h": 2.0}, 0.84),
    "2 x Young's modulus": ({"E": 2.0}, 0.80),
    "0.5 x width": ({"w": 0.5}, 0.88),
}
TABLE_4_4 = {"L_b": 4.04, "w": 0.67, "h": 0.44, "E": 2.3e9}
FAILURE_LOAD = 1900.0  #: Table 4-4 [N]


def ice_of(p: dict[str, Any]) -> Ice:
    """Ice of the beams of chapter 4."""
    return Ice(E=p["E"], nu=p["nu"], h=p["h"], rho_i=p["rho_i"], rho_w=p["rho_w"])


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Root states and failure loads of the three tables, and the beam that fails in motion."""
    known = {**p, "dynamic": True, "dt": 0.0} == PARAMETERS
    figures = [_figure_17(p)]
    quantities = _table_4_2(p, known)
    if any(p[key] != PARAMETERS[key] for key in ("L_b", "w", "h", "E")):  # a beam of the user's own: f and deflection
        f = factor_f(ice_of(p), p["L_b"], p["w"], int(p["cells"]), p["ratio"])
        return CaseResult("cantilever", p, [*quantities, value("factor f", f, "-")], figures)
    quantities += [*_table_4_3(p, known), *_table_4_4(p, known)]
    if p["dynamic"]:
        times, deflection, failed = history({**p, **TABLE_4_4}, FAILURE_LOAD, quick)
        quantities += _figure_4_18(times, deflection, failed, known)
        figures.append(figure_18(times, deflection, failed))
    return CaseResult("cantilever", p, quantities, figures)


def _table_4_2(p: dict[str, Any], known: bool) -> list[Quantity]:
    piece = cantilever(ice_of(p), p["L_b"], p["w"], int(p["cells"]))
    load = p["sigma_f"] * p["w"] * p["h"] ** 2 / (6.0 * p["L_b"])  # (4.27)
    w = -load * float(piece.deflection()[piece.tip, 0].mean())
    E = youngs_modulus(brine_volume(2.7, -1.6))
    source = "van Vliet (2018), Table 4-2 and section 4.2.2"
    return [
        value("failure load (4.27)", load, "N"),
        near("tip deflection", w, "m", 2.0e-3 if known else None, 0.05, source),
        near("Young's modulus at 2.7 ppt and -1.6 C", E, "Pa", 1.3e9, 0.02, source),
    ]


def _table_4_3(p: dict[str, Any], known: bool) -> list[Quantity]:
    out = []
    for name, (change, reference) in TABLE_4_3.items():
        case = {**p, **{key: p[key] * factor for key, factor in change.items()}}
        f = factor_f(ice_of(case), case["L_b"], case["w"], int(p["cells"]), p["ratio"])
        out.append(near(f"factor f, {name}", f, "-", reference if known else None, 0.05, "van Vliet (2018), Table 4-3"))
    return out


def _table_4_4(p: dict[str, Any], known: bool) -> list[Quantity]:
    case = {**p, **TABLE_4_4}
    piece = cantilever(ice_of(case), case["L_b"], case["w"], int(p["cells"]))
    q = piece.deflection() * FAILURE_LOAD
    w = at_distance(piece, q, np.array([3.8, 2.0, 0.1]))
    _, mean, radius = beam_strain(piece, q, case["L_b"], case["w"], p["ratio"])
    f = factor_f(ice_of(case), case["L_b"], case["w"], int(p["cells"]), p["ratio"])
    source = "van Vliet (2018), Table 4-4 and Figure 4-18"

    def check(name: str, number: float, unit: str, reference: float, tolerance: float) -> Quantity:
        return near(name, number, unit, reference if known else None, tolerance, source)

    return [
        check("w1 at 1900 N", w[0], "m", 4.7e-3, 0.03),
        check("w2 at 1900 N", w[1], "m", 1.9e-3, 0.03),
        value("w3 at 1900 N (thesis 0.18 mm)", w[2], "m", source),
        check("factor f, Table 4-4", f, "-", 0.80, 0.05),
        value("eta_mean (printed as R_eta, 3.11e-4)", abs(mean[0]), "1/m", source),
        value("R_eta (printed as eta_mean, 5.73e-4)", radius[0], "1/m", source),
    ]


def at_distance(piece: Piece, q: Array, x: Array) -> Array:
    """Downward deflection on the centre line at distances x from the root, (points,) [m]."""
    column, first, count = piece.root
    line = -q[:, 0].reshape(piece.grid.nx, piece.grid.ny)[column:, first + count // 2]
    return np.interp(x, piece.grid.d * np.arange(len(line)), line)


def _figure_4_18(times: Array, deflection: Array, failed: float, known: bool) -> list[Quantity]:
    source = "van Vliet (2018), Figure 4-18"
    before = np.array([np.interp(failed, times, deflection[:, i]) for i in range(3)])
    one_digit = f"{source}, printed with one digit"
    return [
        near("time of failure", failed, "s", 0.7 if known else None, 0.05, one_digit, "absolute"),
        near("w1, w2 at failure, dynamic", before[:2], "m", [4.7e-3, 1.9e-3] if known else None, 0.05, source),
        near(
            "w1, w2 go down and w3 goes up after failure",
            np.sign(deflection[-1] - before),
            "-",
            [1.0, 1.0, -1.0] if known else None,
            0.0,
            source,
        ),
        value("time of Figure 4-18", times, "s"),
        value("w1, w2, w3 of Figure 4-18", deflection.T, "m"),
    ]


def _figure_17(p: dict[str, Any]) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for cells in (4, 6, 8):
            piece = cantilever(ice_of(p), p["L_b"], p["w"], cells)
            left = beam_strain(piece, piece.deflection(), p["L_b"], p["w"], p["ratio"])[0]
            axes.plot((2.0 * np.arange(cells) + 1.0) / cells - 1.0, left, "o-", label=f"{cells} cells over the width")
        x = np.linspace(-0.9, 0.9, 181)
        axes.plot(x, 0.4 * (1.0 / np.sqrt(1.0 - x) + 1.0 / np.sqrt(1.0 + x)), "k--", label="(4.30) with f = 0.8")
        axes.set(xlabel="2 x / w [-]", ylabel="left side of (4.29) [-]", ylim=(0, None))
        axes.legend()

    return Figure("figure_4-17", "Figure 4-17: strain along the root of the beam", draw)
