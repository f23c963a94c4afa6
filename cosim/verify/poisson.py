"""Chapter 3: Poisson effect of one cell with both stiffness sets (section 3.4), and Figures 3-3, 3-4.

The stiffnesses (3.8)-(3.11) give the contraction (1 + nu) / 4 = 0.3125 at nu = 1/4, where the thesis prints 0.32: its
elongation is 3.2 times its contraction. The printed value is therefore compared to one unit of its last digit.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cosim.verify import frequency_response
from cosim.verify.case import CaseResult, Figure, Quantity, at_most, limited, near, value
from cosim.verify.plate import TABLE_2_1, ice_of, plate_of
from cosim.verify.settings import meshes
from lattice import continuum, spectrum
from lattice.grid import Array
from lattice.ice import Ice
from lattice.stiffness import STIFFNESS_SETS
from lattice.unit_cell import cell_in_stress

PARAMETERS: dict[str, Any] = {key: number for key, number in TABLE_2_1.items() if key != "stiffness"} | {
    "nu": 0.15,
    "nu_cell": 0.25,
    "nodes": [19, 31],
    "load": [20.0, 50.0],
    "f_max": 10.0,
    "points": 200,
}
SOURCE = "van Vliet (2018), section 3.4"
CONTRACTION = {"equations-matching": (0.32, 0.01), "hrennikoff": (0.25, 0.005)}  #: at nu = 1/4, and tolerance


def contraction(ice: Ice, stiffness: str) -> float:
    """Contraction over elongation of one cell in uniaxial tension, Figure 3-2."""
    state = cell_in_stress(ice, STIFFNESS_SETS[stiffness](ice), np.array([1.0e5, 0.0]), 0.0)
    strains = state.strains
    return float(-strains.e22[0] / strains.e11[0])


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Contraction of one cell and response of the plate with each stiffness set; ``quick``: fewer frequencies."""
    quantities = _cells(p)
    sets = {name: {**p, "stiffness": name} for name in STIFFNESS_SETS}
    mesh = meshes(p["nodes"])[0]
    quantities += _low_frequency(p, sets, mesh)
    f = np.linspace(0.05, p["f_max"], 40 if quick else int(p["points"]))
    curves = {f"lattice, {name}": frequency_response.lattice_curve(q, mesh, f) for name, q in sets.items()}
    curves["continuum"] = frequency_response.navier_curve(p, f)
    quantities.append(value("frequency", f, "Hz"))
    quantities += [value(f"amplitude {name}, w and phi_x", np.abs(c), "-") for name, c in curves.items()]
    return CaseResult("poisson", p, quantities, [_figure(f, curves, i) for i in range(2)])


def _cells(p: dict[str, Any]) -> list[Quantity]:
    ice, out = replace(ice_of(p), nu=p["nu_cell"]), []
    for name in STIFFNESS_SETS:
        reference, tolerance = CONTRACTION[name]
        label = f"contraction over elongation at nu = {p['nu_cell']:g}, {name}"
        known = p["nu_cell"] == PARAMETERS["nu_cell"]
        out.append(
            near(
                label,
                contraction(ice, name),
                "-",
                reference if known else None,
                tolerance,
                f"{SOURCE}, two decimals",
                "absolute",
            )
        )
        third = contraction(replace(ice, nu=1.0 / 3.0), name)
        out.append(near(f"contraction over elongation at nu = 1/3, {name}", third, "-", 1.0 / 3.0, 1e-10, SOURCE))
    zero = contraction(replace(ice, nu=0.0), "hrennikoff")
    out.append(
        near(
            "equations-matching: contraction over elongation, closed form (1 + nu) / 4",
            contraction(ice, "equations-matching"),
            "-",
            0.25 * (1.0 + p["nu_cell"]),
            1e-10,
            "(3.8)-(3.11)",
        )
    )
    return [*out, at_most("contraction over elongation at nu = 0, hrennikoff", zero, "-", 1e-12, SOURCE)]


def _low_frequency(p: dict[str, Any], sets: dict[str, dict[str, Any]], mesh: tuple[int, int]) -> list[Quantity]:
    """Agreement with the continuum up to 0.5 Hz and shift of the resonances up to 3 Hz of both sets."""
    known = all(p[key] == PARAMETERS[key] for key in p if key not in ("f_max", "points", "nu_cell"))
    f = np.linspace(0.02, 0.5, 25)
    exact = frequency_response.navier_curve(p, f)
    modes = continuum.eigenfrequencies(ice_of(p), p["Lx"], p["Ly"], 20)
    modes = modes[modes <= 3.0]
    out, shifts = [], {}
    for name, q in sets.items():
        error = float(np.abs(frequency_response.lattice_curve(q, mesh, f) / exact - 1.0).max())
        label = f"up to 0.5 Hz, {name}: largest error"
        out.append(limited(label, error, "-", 0.02, SOURCE, known))
        shift = spectrum.eigenfrequencies(plate_of(q, mesh), len(modes)) / modes - 1.0
        shifts[name] = float(np.sqrt(np.mean(shift**2)))
        out.append(value(f"shift of the resonances up to 3 Hz, {name}", shift, "-"))
    ratio = shifts["equations-matching"] / shifts["hrennikoff"]
    label = "rms shift of the resonances, equations-matching over hrennikoff (deviation larger with hrennikoff)"
    return [*out, limited(label, ratio, "-", 1.0, SOURCE, known)]


def _figure(f: Array, curves: dict[str, Array], component: int) -> Figure:
    label = ("deflection", "rotation phi_x")[component]

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for (name, curve), style in zip(curves.items(), (":", "--", "-"), strict=True):
            axes.plot(f, np.abs(curve[:, component]), style, color="k" if style == "-" else None, label=name)
        axes.set(xlabel="frequency of the load [Hz]", ylabel=f"{label} / static [-]", yscale="log", xlim=(0, f[-1]))
        axes.legend(fontsize=8)

    number = f"3-{3 + component}"
    return Figure(f"figure_{number}", f"Figure {number}: {label} at the load, both stiffness sets", draw)
