"""Figures 4-2, 4-6 and 4-8: failure envelopes from one lattice cell in every orientation (Appendices 2 and 3).

All criteria are proportional to the load, so the envelope in a direction of stress is 1 / utilisation of a unit
stress. The cell turns from 0 to 90 degrees under each of them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, at_most, near, value
from cosim.verify.plate import springs_of
from lattice.criteria.laws import bending_bottom, bending_top, compression, spalling, tension
from lattice.grid import Array
from lattice.ice import Ice
from lattice.strain import CellState
from lattice.unit_cell import cell_in_bending, cell_in_stress

PARAMETERS: dict[str, Any] = {
    "sigma_t": 0.6e6,
    "sigma_c": 5.0e6,
    "sigma_spall": -28.0e6,
    "E": 5.0e9,
    "nu": 1.0 / 3.0,
    "h": 1.0,
    "stiffness": "hrennikoff",
    "angles": 19,
    "directions": 360,
}
IN_PLANE = (tension, compression, spalling)
SOURCE = "van Vliet (2018), section 4.1 and Figure 4-2"


def utilisation(p: dict[str, Any], stress: Array, alpha: float, in_plane: bool) -> float:
    """Of the governing criterion under principal stresses [Pa] for a cell turned by alpha [rad]."""
    ice = Ice(
        E=p["E"],
        nu=p["nu"],
        h=p["h"],
        rho_i=900.0,
        rho_w=1025.0,
        sigma_t=p["sigma_t"],
        sigma_f=p["sigma_t"],
        sigma_c=p["sigma_c"],
        sigma_spall=p["sigma_spall"],
    )
    springs = springs_of(p, ice)
    load: Callable[..., CellState] = cell_in_stress if in_plane else cell_in_bending
    state = load(ice, springs, stress, alpha)
    criteria = IN_PLANE if in_plane else (bending_top, bending_bottom)
    return max(float(criterion(state, ice)[0]) for criterion in criteria)


def radius(p: dict[str, Any], direction: Array, alpha: float, in_plane: bool = True) -> float:
    """Length of the failing stress along a unit direction in (sigma_11, sigma_22) [Pa]."""
    return 1.0e6 / utilisation(p, 1.0e6 * direction, alpha, in_plane)


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Envelopes in plane and out of plane, and how far they depend on the direction; ``quick``: fewer of them."""
    count = 72 if quick else int(p["directions"])
    theta = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False) + 1e-3  # off the axes: no tie between criteria
    directions = np.column_stack((np.cos(theta), np.sin(theta)))
    angles = np.linspace(0.0, 0.5 * np.pi, int(p["angles"]))
    quantities, curves = [], {}
    for name, in_plane in (("in-plane", True), ("bending", False)):
        radii = np.array([[radius(p, e, a, in_plane) for a in angles] for e in directions[:: 1 if quick else 5]])
        spread = float((radii.max(axis=1) / radii.min(axis=1) - 1.0).max())
        curves[name] = np.array([radius(p, e, 0.0, in_plane) for e in directions])[:, None] * directions
        label = f"{name} envelope, cell turned by 0 ... 90 degrees: largest spread"
        quantities += [
            at_most(label, spread, "-", 1e-10, SOURCE),
            value(f"{name} envelope, sigma_11 and sigma_22", curves[name].T, "Pa"),
        ]
    return CaseResult("envelope", p, [*_points(p), *quantities], _figures(curves))


def _points(p: dict[str, Any]) -> list[Quantity]:
    """Uniaxial tension and compression, spalling under equal pressure, and the same in bending."""
    third = abs(p["nu"] - 1.0 / 3.0) < 1e-9  # (4.4) was fitted with nu = 1/3

    def point(name: str, direction: tuple[float, float], reference: float | None, in_plane: bool = True) -> Quantity:
        e = np.array(direction)
        tolerance = 1e-3 if "compression" in name else 1e-10  # the constants of (4.4) have three digits
        return near(name, radius(p, e, 0.3, in_plane), "Pa", reference, tolerance, SOURCE)

    diagonal = float(np.sqrt(0.5))
    return [
        point("uniaxial tension fails at", (1.0, 0.0), p["sigma_t"] if third else None),
        point("uniaxial compression fails at", (-1.0, 0.0), p["sigma_c"] if third else None),
        near(
            "sum of the stresses at spalling, equal pressure",
            -2.0 * diagonal * radius(p, np.full(2, -diagonal), 0.3),
            "Pa",
            p["sigma_spall"],
            1e-10,
            SOURCE,
        ),
        point("uniaxial bending fails at", (1.0, 0.0), p["sigma_t"] if third else None, False),
        point("uniaxial bending, other way, fails at", (-1.0, 0.0), p["sigma_t"] if third else None, False),
    ]


def _figures(curves: dict[str, Array]) -> list[Figure]:
    def axes_of(figure: Any, place: int, count: int, name: str, limits: tuple[float, float] | None) -> None:
        axes = figure.add_subplot(1, count, place)
        closed = np.vstack((curves[name], curves[name][:1])) / 1e6
        axes.plot(closed[:, 0], closed[:, 1])
        axes.axhline(0.0, color="k", linewidth=0.5)
        axes.axvline(0.0, color="k", linewidth=0.5)
        axes.set(aspect="equal", xlabel="sigma_11 [MPa]", ylabel="sigma_22 [MPa]", title=name)
        if limits:
            axes.set(xlim=limits, ylim=limits)

    def whole(figure: Any) -> None:
        axes_of(figure, 1, 1, "in-plane", None)

    def tensile(figure: Any) -> None:
        axes_of(figure, 1, 1, "in-plane", (-5.5, 1.5))

    def both(figure: Any) -> None:
        axes_of(figure, 1, 2, "in-plane", (-5.5, 1.5))
        axes_of(figure, 2, 2, "bending", None)

    return [
        Figure("figure_4-2", "Figure 4-2: failure envelope", whole),
        Figure("figure_4-6", "Figure 4-6: tensile part of the envelope", tensile),
        Figure("figure_4-8", "Figure 4-8: envelopes in the plane and in bending", both),
    ]
