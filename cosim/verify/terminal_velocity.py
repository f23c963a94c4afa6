"""Case `terminal-velocity`: a block rises or sinks until form and skin drag balance its buoyancy."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Quantity, near
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

PARAMETERS: dict[str, Any] = {
    "length": 10.0,
    "h": 3.0,
    "width": 2.8,
    "rho": [846.0, 1166.0],
    "rho_w": 1006.0,
    "g": 9.81,
    "C_d": 1.0,
    "C_f": 0.002,
    "added_mass": 0.2,
}
SOURCE = "|rho_w - rho| g h L w = rho_w / 2 (C_d L w + 2 C_f h w) v^2"


def speed(p: dict[str, Any], rho: float) -> float:
    """Velocity upwards after a long time [m/s]."""
    physics = RubblePhysics(
        rho_i=rho,
        rho_w=p["rho_w"],
        g=p["g"],
        form_drag=p["C_d"],
        skin_drag=p["C_f"],
        added_mass=p["added_mass"],
        thickness=p["h"],
    )
    layer = RubbleLayer(physics, p["width"])
    x, h, z = p["length"] / 2.0, p["h"] / 2.0, -5000.0
    outline = np.array([(-x, z - h), (x, z - h), (x, z + h), (-x, z + h)])
    layer.add_block(0, Slab(outline, np.array([-x, x]), np.array([p["width"]]), rho))
    last = 0.0
    while True:
        layer.advance(200)
        now = float(layer.table().velocity[0, 2])
        if abs(now - last) <= 1e-6 * abs(now):
            return now
        last = now


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Speed of a rising and of a sinking block."""
    quantities: list[Quantity] = []
    for rho in p["rho"]:
        if rho == p["rho_w"] or not p["C_d"] > 0.0:
            raise ValueError("terminal-velocity: give densities other than the water's, and C_d > 0")
        skin = 1.0 + 2.0 * p["C_f"] * p["h"] / (p["C_d"] * p["length"])
        exact = sqrt(2.0 * abs(p["rho_w"] - rho) * p["g"] * p["h"] / (p["rho_w"] * p["C_d"] * skin))
        quantities.append(
            near(
                f"density {rho:g} kg/m3: velocity upwards",
                speed(p, rho),
                "m/s",
                exact if rho < p["rho_w"] else -exact,
                0.01,
                SOURCE,
            )
        )
    return CaseResult("terminal-velocity", p, quantities)
