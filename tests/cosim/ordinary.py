"""Ordinary cases by number: what an engineer might ask, at random, without a doubt that `cosim check` would tell.

A case is drawn again until it has neither fault nor doubt (but for its 5 s, which are few) and at most `MOST` nodes, so
that coarse meshes still show the lengths over which ice bends. A case at 1:25 is the exact Froude copy of one that is
ordinary at full scale: E, strengths, fracture energy, times and all defaults are scaled with it.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from cosim.scenario.errors import ScenarioError
from cosim.scenario.froude import froude_copy
from cosim.scenario.judge import doubts_of
from cosim.scenario.loading import load_scenario

MOST = 1200  #: nodes
MODEL = Fraction(1, 25)  #: scale of a basin
#: of sea ice; the tensile and shear strength are those of open cracks
CHOICES: dict[str, tuple[Any, ...]] = {
    "kind": ("cone", "cone", "plane"),
    "breaking": ("upward", "downward"),
    "h": (0.1, 0.3, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0),
    "v": (0.05, 0.1, 0.3, 0.6, 1.0),
    "slope": (20, 31, 45, 52, 60, 75),
    "contact": ("overlap", "crushing"),
    "E": (1, 3, 5, 8, 10),
    "cracks": ("closing", "closing", "open"),
    "propagation": ("quasi-static", "quasi-static", "dynamic"),
    "cells": (5.5, 9.0),  # in the characteristic length
    "diameter": (4, 8, 10, 14, 20, 30, 70),
    "sides": ("held", "free"),
    "scale": (1, 1, 1, 25),
}
ICE = """[scenario]
title = "ordinary {number}"
duration = "5 s"
[ice]
thickness = "{h} m"
density = "900 kg/m^3"
youngs_modulus = "{E} GPa"
poisson_ratio = 0.3333333333333333
flexural_strength = "500 kPa"
tensile_strength = "500 kPa"
compressive_strength = "2.5 MPa"
shear_strength = "600 kPa"
[water]
density = "1025 kg/m^3"
[sheet]
length = "{length:.9g} m"
width = "{width:.9g} m"
nodes = [{nx}, {ny}]
back = "held"
sides = "{sides}"
[contact]
model = "{contact}"
strength = "2.5 MPa"
friction = 0.15
[drift]
velocity = "{v} m/s"
[fracture]
cracks = "{cracks}"
propagation = "{propagation}"
[structure]
kind = "{kind}"
breaking = "{breaking}"
slope = "{slope} deg"
toe_depth = "{toe:.9g} m"
"""
CONE = 'waterline_radius = "{radius} m"\nneck_radius = "{neck} m"\n'


@dataclass(frozen=True)
class Ordinary:
    """One case."""

    number: int
    drawn: dict[str, Any]
    text: str
    nodes: int

    def write(self, folder: Path) -> Path:
        """The file of the case in a folder."""
        file = folder / f"ordinary_{self.number}.toml"
        file.write_text(self.text)
        return file


def ordinary(number: int, folder: Path) -> Ordinary:
    """The case of this number; ``folder`` is for files on the way."""
    chance = random.Random(number)
    while True:
        drawn = {name: chance.choice(values) for name, values in CHOICES.items()}
        text, nodes = _text(number, drawn)
        file = folder / f"drawn_{number}.toml"
        file.write_text(text)
        try:
            scenario = load_scenario(file)
        except ScenarioError:
            continue
        if nodes <= MOST and all(doubt.key == "scenario.duration" for doubt in doubts_of(scenario.model)):
            break
    if drawn["scale"] != 1:
        text = froude_copy(scenario, MODEL).text
    file.unlink()
    return Ordinary(number, drawn, text, nodes)


def _text(number: int, c: dict[str, Any]) -> tuple[str, int]:
    """The file at full scale, and its number of nodes."""
    bending = (c["E"] * 1e9 * c["h"] ** 3 / (12.0 * (1.0 - 1.0 / 9.0) * 1025.0 * 9.81)) ** 0.25
    cone = c["kind"] == "cone"
    d = max(bending / c["cells"], c["h"] / 2.5)
    long, wide, sides = 6.0 * bending, 2.0 * bending, "roller"
    if cone:
        d, sides = min(d, c["diameter"] / 4.1), c["sides"]
        long, wide = 4.0 * bending, c["diameter"] + 3.1 * bending
    nx, ny = round(long / d) + 1, 2 * round(0.5 * wide / d) + 1
    values = {**c, "number": number, "nx": nx, "ny": ny, "length": (nx - 1) * d, "width": (ny - 1) * d, "sides": sides}
    values |= {"toe": c["h"] + 2.0, "radius": 0.5 * c["diameter"], "neck": 0.25 * c["diameter"]}
    return (ICE + (CONE if cone else "")).format(**values), nx * ny
