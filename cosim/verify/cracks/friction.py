"""Case `crack-friction`: what slip under thrust takes is mu N times its way, and slip there and back gives none back.

Coulomb friction in a layer that is cracked through, and in the edge springs of a cracked cell that slips out of the
plane. The elastic part of each turn comes back, so a loop of amplitude g slips 4 (g - tau / G) after its first way.
The wrong twin is a spring whose force is limited, without slip as a state: it gives back on the way home what it took,
and a loop whose thrust is larger on the way home than on the way out makes energy.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, near, value
from cosim.verify.cracks.thrust import cracked_cell
from lattice.cracks.cells import RUBBING
from lattice.cracks.evaluate import evaluate
from lattice.cracks.law import CrackLaw, layer
from lattice.explicit.layout import U_X, W
from lattice.grid import Array

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "h": 3.0,
    "d": 2.8,
    "mu": 0.3,
    "stress": 1.0e6,
    "amplitude": 5.0e-3,
    "loops": 2,
}
SOURCE = "Coulomb: mu N times the way of slip"

FLAT = np.zeros((3, 4))  #: no strain from slopes


def path(amplitude: float, loops: int, steps: int) -> Array:
    """0, then ``loops`` times amplitude and -amplitude, then 0; ``steps`` from one turn to the next."""
    turns = [0.0, *([amplitude, -amplitude] * loops), 0.0]
    return np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in pairwise(turns)])


def way_of_slip(amplitude: float, loops: int, elastic: float) -> float:
    """Way of slip along `path`, with the elastic shear tau / G that comes back at each turn."""
    return (amplitude - elastic) + (2 * loops - 1) * 2.0 * (amplitude - elastic) + max(amplitude - 2.0 * elastic, 0.0)


def layer_loop(p: dict[str, Any], steps: int) -> tuple[Array, Array, float, float]:
    """Shear strain, shear stress [Pa], energy that rubbing took and work done [J/m3] of a cracked layer."""
    law = CrackLaw(E=p["E"], nu=0.0, sigma_c=np.inf, cohesion=700.0e3, mu=p["mu"], e_0=1e-4, e_f=1e-4)
    damage, crushed, slip, lost, tau = np.array([1.0, 0.0]), np.zeros(2), 0.0, 0.0, [0.0]
    gamma = np.concatenate(([0.0], path(p["amplitude"], p["loops"], steps)))
    for g in gamma[1:]:
        a = layer(-p["stress"] / p["E"], 0.0, g, damage, crushed, slip, law)
        slip, lost = a.slip, lost + a.rubbing
        tau.append(a.tau)
    return gamma, np.array(tau), lost, float(np.trapezoid(tau, gamma))


def cell_loop(p: dict[str, Any], steps: int) -> float:
    """Energy that rubbing took in a cracked cell whose far edge goes up and down by amplitude x d [J]."""
    law = CrackLaw(E=p["E"], nu=0.0, sigma_c=np.inf, cohesion=700.0e3, mu=p["mu"], e_0=1e-4, e_f=1e-4)
    (cracks, plate), x = cracked_cell(p), np.zeros((5, 4))
    x[U_X, 2:] = -p["stress"] / p["E"] * p["d"]
    for w in path(p["amplitude"] * p["d"], p["loops"], steps):
        x[W, 2:] = w
        evaluate(0, x, np.zeros((5, 4)), 2, plate, law, cracks, FLAT)
    return float(cracks.losses[:, RUBBING].sum())


def twin_loop(p: dict[str, Any]) -> float:
    """Work on a limited spring without slip as a state; thrust on the way home twice that of the way out [J/m3]."""
    G, limit = 0.5 * p["E"], p["mu"] * p["stress"]
    out = np.linspace(0.0, p["amplitude"], 4001)
    taken = float(np.trapezoid(np.clip(G * out, -limit, limit), out))
    return taken - float(np.trapezoid(np.clip(G * out, -2.0 * limit, 2.0 * limit), out))


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Loops of slip; ``quick``: fewer steps, which changes nothing but the trapezoids of the work."""
    steps, loops = 400 if quick else 4000, int(p["loops"])
    limit, G = p["mu"] * p["stress"], 0.5 * p["E"]
    if p["amplitude"] <= 2.0 * limit / G:
        raise ValueError(f"amplitude = {p['amplitude']:g} does not slip back: use more than {2.0 * limit / G:.3g}")
    gamma, tau, lost, work = layer_loop(p, steps)
    exact = limit * way_of_slip(p["amplitude"], loops, limit / G)
    stored = 0.5 * tau[-1] ** 2 / G
    _, plate = cracked_cell(p)
    most = 0.5 * p["d"] * limit * p["h"]  # of one of the two edge springs across the crack
    slipped = way_of_slip(p["amplitude"] * p["d"], loops, most / plate.shear)
    quantities: list[Quantity] = [
        near("layer: energy lost by slip", lost, "J/m3", exact, 1e-9, SOURCE),
        near("layer: work, less what is still stored", work - stored, "J/m3", exact, 1e-3 if quick else 1e-4, SOURCE),
        near(
            "cell: energy lost by slip out of the plane", cell_loop(p, steps), "J", 2.0 * most * slipped, 1e-9, SOURCE
        ),
        value(
            "limited spring without slip as a state: energy taken by a loop (wrong: it makes energy)",
            twin_loop(p),
            "J/m3",
        ),
    ]
    return CaseResult("crack-friction", p, quantities, [_figure(gamma, tau)])


def _figure(gamma: Array, tau: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        axes.plot(1e3 * gamma, 1e-6 * tau)
        axes.set(xlabel="shear strain [1e-3]", ylabel="shear stress [MPa]")

    return Figure("loop", "Loop of slip in a cracked layer under thrust", draw)
