"""Case `crack-thrust`: the moment that a cracked section carries because it is pressed together.

A section that is cracked through and turned open carries its thrust N in a crushed block at its edge, of depth
N / sigma_c, so that M = N (h/2 - N / (2 sigma_c)): the rectangular stress block of a section without tension
(EN 1992-1-1, 3.1.7; compressive membrane action: Rankin and Long 1997; ice sheets: Bazant and Li 1995). The layers of
a lattice cell are set against it and against 81 layers of equal weight. The wrong twin has all its thrust at middle
thickness.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from scipy.optimize import brentq

from cosim.verify.case import CaseResult, Figure, at_most, near, value
from lattice.cracks.cells import M_N, N_N, Cracks, Plate, place, resultants, room_for
from lattice.cracks.evaluate import evaluate
from lattice.cracks.kinematics import Strain
from lattice.cracks.law import CrackLaw, N, layer
from lattice.explicit.layout import PHI_X, U_X
from lattice.grid import Array

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "h": 3.0,
    "d": 2.8,
    "sigma_c": 4.0e6,
    "curvature": 5.0e-3,
    "thrust": [0.02, 0.05, 0.1, 0.142, 0.2, 0.3, 0.4, 0.6, 0.8],
}
SOURCE = "M = N (h/2 - N / (2 sigma_c)), rectangular stress block"
LAYERS = 81

FLAT = np.zeros((3, 4))  #: no strain from slopes


def law_of(p: dict[str, Any]) -> CrackLaw:
    """A brittle law without Poisson effect; the crack is there before."""
    e_0 = 430.0e3 / p["E"]
    return CrackLaw(E=p["E"], nu=0.0, sigma_c=p["sigma_c"], cohesion=700.0e3, mu=0.3, e_0=e_0, e_f=e_0)


def cracked_cell(p: dict[str, Any]) -> tuple[Cracks, Plate]:
    """One cell of the lattice, cracked through across x."""
    cracks = room_for(1)
    cracks.axis[0] = 1.0
    cracks.damage[..., N] = 1.0
    return cracks, Plate(p["d"], p["h"], 0.5 * p["E"] * p["h"], 0.05 * p["E"] * p["h"])


def cell_section(strain: float, p: dict[str, Any]) -> tuple[float, float]:
    """Thrust [N/m] and moment [N] of a lattice cell at a membrane strain and the curvature of the case."""
    (cracks, plate), x = cracked_cell(p), np.zeros((5, 4))  # two rows of two nodes
    x[U_X, 2:], x[PHI_X, 2:] = strain * p["d"], p["curvature"] * p["d"]
    evaluate(0, x, np.zeros((5, 4)), 2, plate, law_of(p), cracks, FLAT)
    force = resultants(place(0), Strain(strain, 0.0, 0.0, p["curvature"], 0.0, 0.0), cracks.linear)
    return -force[N_N], force[M_N]


def layered_section(strain: float, p: dict[str, Any], heights: Array) -> tuple[float, float]:
    """The same for layers of equal weight at the given heights [m]."""
    thrust = moment = 0.0
    for z in heights:
        a = layer(strain + z * p["curvature"], 0.0, 0.0, np.array([1.0, 0.0]), np.zeros(2), 0.0, law_of(p))
        weight = p["h"] / len(heights)
        thrust, moment = thrust - weight * a.s_n, moment + weight * z * a.s_n
    return thrust, moment


def moment_at(thrust: float, section: Any) -> float:
    """Moment [N] of a section ``section(strain) -> (thrust, moment)`` where it carries this thrust [N/m]."""
    if thrust == 0.0:
        return float(section(1.0)[1])
    return float(section(brentq(lambda e: section(e)[0] - thrust, -0.1, 0.1, xtol=1e-12))[1])


def run(p: dict[str, Any], quick: bool) -> CaseResult:  # noqa: ARG001  it takes a second either way
    """Moments over thrusts, of the lattice's cell, of many layers and of the wrong twin."""
    full = p["sigma_c"] * p["h"]
    thrust = full * np.array(p["thrust"])
    if not (thrust > 0.0).all() or not (thrust < full).all():
        raise ValueError(f"thrust = {p['thrust']}: shares of the strength of the section, between 0 and 1")
    exact = thrust * (0.5 * p["h"] - thrust / (2.0 * p["sigma_c"]))
    heights = p["h"] * ((np.arange(LAYERS) + 0.5) / LAYERS - 0.5)
    ours, fine = partial(cell_section, p=p), partial(layered_section, p=p, heights=heights)
    moment, finer = ([moment_at(t, section) for t in thrust] for section in (ours, fine))
    middle = [layered_section(-t / p["h"] / p["E"], p, np.zeros(1))[1] for t in thrust]
    return CaseResult(
        "crack-thrust",
        p,
        [
            value("thrust", thrust, "N/m"),
            near("moment, cell of the lattice", moment, "N", exact, 0.02, SOURCE),
            near(f"moment, {LAYERS} layers", finer, "N", exact, 0.005, SOURCE),
            near("moment, cell against many layers", moment, "N", finer, 0.02, f"{LAYERS} layers"),
            at_most(
                "moment without thrust, part of the largest", moment_at(0.0, ours) / exact.max(), "-", 1e-9, SOURCE
            ),
            value("moment of a hinge at middle thickness (wrong)", middle, "N"),
        ],
        [_figure(thrust, exact, np.array(moment), np.array(middle))],
    )


def _figure(thrust: Array, exact: Array, moment: Array, middle: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        axes.plot(1e-6 * thrust, 1e-6 * exact, "k-", label="M = N (h/2 - N / 2 sigma_c)")
        axes.plot(1e-6 * thrust, 1e-6 * moment, "o", mfc="none", label="cell of the lattice")
        axes.plot(1e-6 * thrust, 1e-6 * middle, "x", label="hinge at middle thickness (wrong)")
        axes.set(xlabel="thrust N [MN/m]", ylabel="moment M [MN]")
        axes.legend()

    return Figure("moment", "Moment of a cracked section over its thrust", draw)
