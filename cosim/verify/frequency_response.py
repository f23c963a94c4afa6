"""Figures 2-16, 2-17 and 2-19 to 2-22: deflection and rotation at a sinusoidal point load against its frequency.

The thesis states neither the load point nor the damping coefficients. Mode 2 has no deflection at the load (below
Figure 2-15), so the load lies at y = Ly/2; x = Lx/3 is a node of every mesh and turns. Hydrodynamic damping is given
as a fraction of sqrt(k_s rho h), of which 2 is the critical damping of the ice on the water alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, limited, near, value
from cosim.verify.plate import TABLE_2_1, ice_of, load_node, plate_of
from cosim.verify.settings import meshes
from lattice import continuum, spectrum
from lattice.grid import Array

PARAMETERS: dict[str, Any] = {
    **TABLE_2_1,
    "nodes": [[19, 31], [31, 51], [61, 101]],
    "load": [20.0, 50.0],
    "c": [0.02, 0.2, 2.0],
    "alpha": [1e-3, 1e-2, 1e-1],
    "f_max": 10.0,
    "points": 200,
}
SOURCE = "Navier solution, van Vliet (2018), Appendix 1"


def lattice_curve(p: dict[str, Any], nodes: tuple[int, int], f: Array, c: float = 0.0, alpha: float = 0.0) -> Array:
    """Amplitudes (w, phi_x) at the load over the static ones, complex (frequencies, 2)."""
    plate = plate_of(p, nodes)
    out = spectrum.response(plate, load_node(p, plate.grid), _omega(f), c * _scale(p), alpha)[:, :2]
    return np.asarray(out[1:] / out[0])


def navier_curve(p: dict[str, Any], f: Array, c: float = 0.0, alpha: float = 0.0) -> Array:
    """Response of the continuum plate at frequencies ``f`` [Hz], complex: deflection and rotation, (2, f)."""
    at = np.array([p["load"]])
    sides = p["Lx"], p["Ly"]
    out = continuum.navier(ice_of(p), sides, tuple(p["load"]), at, _omega(f), c * _scale(p), alpha)[:, 0, :2]
    return np.asarray(out[1:] / out[0])


def _omega(f: Array) -> Array:
    """Angular frequencies with the static load in front."""
    return 2.0 * np.pi * np.concatenate(([0.0], f))


def _scale(p: dict[str, Any]) -> float:
    return continuum.hydrodynamic_damping(ice_of(p), 1.0)


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Response of lattice and plate over frequency; ``quick``: fewer frequencies."""
    mesh = meshes(p["nodes"])
    standard = p == {**PARAMETERS, "points": p["points"], "f_max": p["f_max"]}
    f = np.linspace(0.05, p["f_max"], 40 if quick else int(p["points"]))
    quantities = [
        _low_frequency(p, mesh[0], standard),
        _resonances(p, mesh[0], standard),
        *_damped(p, mesh[0], standard),
    ]
    if len(mesh) > 1:
        quantities += _order(p, [mesh[0], mesh[-1]], standard)
    curves = _curves(p, mesh[:2], f)
    quantities.append(value("frequency", f, "Hz"))
    quantities += [value(f"amplitude {name}, w and phi_x", np.abs(curve), "-") for name, curve in curves.items()]
    return CaseResult("frequency-response", p, quantities, _figures(f, curves))


def _low_frequency(p: dict[str, Any], nodes: tuple[int, int], check: bool) -> Quantity:
    f = np.linspace(0.02, 0.5, 25)
    ratio = lattice_curve(p, nodes, f) / navier_curve(p, f)
    name, error = f"undamped {nodes[0]}x{nodes[1]} up to 0.5 Hz, largest error", float(np.abs(ratio - 1.0).max())
    return limited(name, error, "-", 0.01, SOURCE, check)


def _resonances(p: dict[str, Any], nodes: tuple[int, int], check: bool) -> Quantity:
    exact = continuum.eigenfrequencies(ice_of(p), p["Lx"], p["Ly"], 20)
    exact = exact[exact <= 3.0]
    shift = spectrum.eigenfrequencies(plate_of(p, nodes), len(exact)) / exact - 1.0 if len(exact) else [0.0]
    name = f"shift of the resonances up to 3 Hz, {nodes[0]}x{nodes[1]}"
    return limited(name, shift, "-", 0.006, SOURCE, check)


def _damped(p: dict[str, Any], nodes: tuple[int, int], check: bool) -> list[Quantity]:
    """Largest error up to 3 Hz, as part of the amplitude (deflection) and of the static amplitude (both)."""
    f, c = np.linspace(0.05, 3.0, 60), max(p["c"])
    ours, exact = np.abs(lattice_curve(p, nodes, f, c)), np.abs(navier_curve(p, f, c))
    name = f"c = {c:g} sqrt(k_s rho h) up to 3 Hz, largest error of"
    errors = {
        f"{name} w": float(np.abs(ours / exact - 1.0)[:, 0].max()),
        f"{name} w, part of static": float(np.abs(ours - exact)[:, 0].max()),
        f"{name} phi_x, part of static": float(np.abs(ours - exact)[:, 1].max()),
    }
    return [limited(n, e, "-", 0.02, SOURCE, check) for n, e in errors.items()]


def _order(p: dict[str, Any], mesh: list[tuple[int, int]], check: bool) -> list[Quantity]:
    """Order of the error in what the motion adds to the static response, which is free of the point singularity."""
    omega, c = _omega(np.array([0.4, 0.8])), max(p["c"]) * _scale(p)
    at = np.array([p["load"]])
    exact = continuum.navier(ice_of(p), (p["Lx"], p["Ly"]), tuple(p["load"]), at, omega, c)[:, 0, :2]
    errors, d = [], []
    for nodes in mesh:
        plate = plate_of(p, nodes)
        ours = spectrum.response(plate, load_node(p, plate.grid), omega, c)[:, :2]
        errors.append(np.abs((ours[1:] - ours[0]) / (exact[1:] - exact[0]) - 1.0).ravel())
        d.append(plate.grid.d)
    order = np.log(errors[0] / errors[1]) / np.log(d[0] / d[1])
    name = f"order of convergence {mesh[0][0]}x{mesh[0][1]} to {mesh[1][0]}x{mesh[1][1]}"
    expected = np.full(len(order), 2.0) if check else None
    return [near(name, order, "-", expected, 0.15, "second-order lattice", "absolute")]


def _curves(p: dict[str, Any], mesh: list[tuple[int, int]], f: Array) -> dict[str, Array]:
    """Name -> amplitudes; a variant is followed by its continuum."""
    curves = {f"lattice {n[0]}x{n[1]}": lattice_curve(p, n, f) for n in mesh}
    curves["continuum"] = navier_curve(p, f)
    for symbol, key in (("c", "c"), ("alpha", "alpha")):
        for factor in p[key]:
            damping = {key: factor}
            curves[f"lattice {symbol}={factor:g}"] = lattice_curve(p, mesh[0], f, **damping)
            curves[f"continuum {symbol}={factor:g}"] = navier_curve(p, f, **damping)
    return curves


def _figures(f: Array, curves: dict[str, Array]) -> list[Figure]:
    groups = {
        "mesh": [n for n in curves if "=" not in n],
        "hydrodynamic damping": [n for n in curves if " c=" in n],
        "material damping": [n for n in curves if "alpha" in n],
    }
    numbers = {"mesh": ("2-16", "2-17"), "hydrodynamic damping": ("2-19", "2-20"), "material damping": ("2-21", "2-22")}
    figures = []
    for group, names in groups.items():
        for component, label in enumerate(("deflection", "rotation phi_x")):
            number = numbers[group][component]
            figures.append(
                Figure(
                    f"figure_{number}",
                    f"Figure {number}: {label} at the load, {group} varied",
                    _draw(f, {n: np.abs(curves[n][:, component]) for n in names}, label),
                )
            )
    return figures


def _draw(f: Array, lines: dict[str, Array], label: str) -> Any:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for i, (name, amplitude) in enumerate(lines.items()):
            exact = name.startswith("continuum")
            colour = f"C{i // 2}" if "=" in name else ("k" if exact else f"C{i}")
            axes.plot(f, amplitude, "-" if exact else ":", color=colour, linewidth=1.0 if exact else 1.8, label=name)
        axes.set(xlabel="frequency of the load [Hz]", ylabel=f"{label} / static [-]", yscale="log", xlim=(0, f[-1]))
        axes.legend(fontsize=8)

    return draw
