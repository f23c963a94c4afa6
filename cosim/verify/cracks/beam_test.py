"""Case `beam-test`: the strength of the layers with which the simulated beam breaks at the load of the real one.

Cantilever cut from the sheet, 18 x 6 x 3 m, 375 kN (van Vliet 2018, chapter 6: 750 kPa), with its root in the plate and
cells as large as the sheet's. Two readings: ice that softens, 750 kPa nominal; brittle ice with the stress
concentration of the root taken out, 967 kPa. The strength is found at one speed of the tip and judged at another.

What a softening section bears is found without the lattice: plane sections, layers that soften on a straight line over
w_c / d (Hillerborg et al. 1976), the largest moment over all curvatures without thrust. Nominal over layer strength is
1 where nothing softens and 3 for a plastic section without crushing.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from cosim.verify.case import CaseResult, Figure, Quantity, near, value
from lattice.cracks.beam import SLOWLY, Beam, BeamTest, cut_beam, layer_strength
from lattice.cracks.law import law_of
from lattice.grid import Array
from lattice.ice import Ice

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "nu": 1.0 / 3.0,
    "h": 3.0,
    "length": 18.0,
    "width": 6.0,
    "load": 375.0e3,
    "brittle": 967.0e3,
    "fracture_energy": 300.0,
    "sigma_c": 4.0e6,
    "d": [2.8, 1.9, 1.4],
    "energies": [20.0, 100.0, 300.0, 1000.0],
}
MU = 0.3  #: friction
SOURCE = "load of the beam test"


def ice_of(p: dict[str, Any], sigma: float) -> Ice:
    """Ice whose layers have this strength [Pa]."""
    return Ice(E=p["E"], nu=p["nu"], h=p["h"], rho_i=846.0, rho_w=1006.0, sigma_t=sigma, sigma_f=sigma,
               sigma_c=p["sigma_c"])  # fmt: skip


def strength_of_section(p: dict[str, Any], sigma: float, energy: float, d: float, layers: int = 1000) -> float:
    """Nominal bending strength 6 M / h^2 of a section of many layers of strength ``sigma`` [Pa]."""
    z = p["h"] * ((np.arange(layers) + 0.5) / layers - 0.5)
    first = sigma / p["E"]
    last = max(first, 2.0 * energy / (sigma * d))

    def stress(strain: Array) -> Array:
        softening = sigma * np.clip((last - strain) / max(last - first, 1e-12), 0.0, 1.0)
        found: Array = np.where(strain <= first, np.maximum(p["E"] * strain, -p["sigma_c"]), softening)
        return found

    def moment(curvature: float) -> float:
        middle = brentq(lambda e: stress(e + curvature * z).sum(), -1e-3 * curvature * p["h"], 0.5 * curvature * p["h"])
        mean = float((z * stress(middle + curvature * z)).mean())
        return mean * float(p["h"])

    elastic = 2.0 * first / p["h"]  # curvature at which the face begins to crack
    curvatures = elastic * np.geomspace(1.0, 200.0, 120)
    best = int(np.argmax([moment(c) for c in curvatures]))
    low, high = curvatures[max(best - 1, 0)], curvatures[min(best + 1, len(curvatures) - 1)]
    found = minimize_scalar(lambda c: -moment(c), bounds=(low, high), method="bounded")
    largest: float = 6.0 * max(-float(found.fun), moment(elastic)) / p["h"] ** 2
    return largest


def calibrated(p: dict[str, Any], nominal: float, energy: float, d: float) -> float:
    """Strength of the layers [Pa]."""
    load = nominal * p["width"] * p["h"] ** 2 / (6.0 * p["length"])
    ice = ice_of(p, nominal)
    return layer_strength(ice, MU, energy, Beam(p["length"], p["width"], load), d)


def load_of_beam(p: dict[str, Any], sigma: float, energy: float, d: float) -> float:
    """Load at which the simulated beam breaks when it is pushed down more slowly [N]."""
    cut, ice = cut_beam(Beam(p["length"], p["width"], p["load"]), d), ice_of(p, sigma)
    nominal = BeamTest(ice, law_of(ice, energy, MU, cut.grid.d), cut, 1.5 * SLOWLY).strength()
    load: float = nominal * p["width"] * p["h"] ** 2 / (6.0 * p["length"])
    return load


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Both readings on all meshes and the table over the fracture energy; ``quick``: one mesh, one energy."""
    measured = Beam(p["length"], p["width"], p["load"])
    nominal, sizes = measured.stress(p["h"]), p["d"][:1] if quick else p["d"]
    energies = [p["fracture_energy"]] if quick else p["energies"]
    quantities: list[Quantity] = [value("cell size", sizes, "m")]
    for name, strength, energy in (("softening", nominal, p["fracture_energy"]), ("brittle", p["brittle"], 0.0)):
        sigma = [calibrated(p, strength, energy, d) for d in sizes]
        load = [load_of_beam(p, s, energy, d) for s, d in zip(sigma, sizes, strict=True)]
        reference = np.full(len(sizes), p["load"] * strength / nominal)
        quantities += [
            value(f"strength of the layers, {name}", sigma, "Pa"),
            near(f"load of the beam, {name}", load, "N", reference, 0.02, SOURCE),
        ]
    table = np.array([calibrated(p, nominal, G, p["d"][0]) for G in energies])
    size = cut_beam(measured, p["d"][0]).grid.d
    section = [strength_of_section(p, s, G, size) / s for s, G in zip(table, energies, strict=True)]
    quantities += [
        value("fracture energy", energies, "J/m2"),
        value("strength of the layers over fracture energy", table, "Pa"),
        near(
            "nominal strength over that of the layers", nominal / table, "-", section, 0.08, "section without lattice"
        ),
    ]
    return CaseResult("beam-test", p, quantities, [_figure(np.array(energies), nominal / table, np.array(section))])


def _figure(energies: Array, ratio: Array, section: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        axes.semilogx(energies, section, "k-", label="section of many layers")
        axes.semilogx(energies, ratio, "o", mfc="none", label="beam on the lattice, with its root")
        axes.set(xlabel="fracture energy [J/m2]", ylabel="nominal strength / strength of the layers [-]")
        axes.legend()

    return Figure("strength", "What a softening beam bears", draw)
