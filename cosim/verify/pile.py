"""Case `pile`: blocks that float up into a bin press on it with their buoyant weight, and come to rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, at_most, near, value
from rubble.arrays import Array
from rubble.cut import plane
from rubble.energy import mechanical_energy
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

PARAMETERS: dict[str, Any] = {
    "blocks": 24,
    "length": 4.0,
    "h": 1.5,
    "width": 2.8,
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "g": 9.81,
    "mu": 0.1,
    "seed": 1,
    "time": 90.0,
}
SOURCE = "sum of (rho_w - rho_i) g V; a settled pile is at rest"


def bin_of(width: float) -> list[Array]:
    """An upturned bin under water: lid in 8 m depth and two walls."""

    def solid(x0: float, z0: float, x1: float, z1: float) -> Array:
        return np.array([(x0, z0), (x1, z0), (x1, z1), (x0, z1)])

    return [solid(-width, -10, width, -8), solid(-width - 2, -200, -width, -8), solid(width, -200, width + 2, -8)]


def tumble(p: dict[str, Any]) -> RubbleLayer:
    """Blocks at odd angles below the bin, about to float up."""
    physics = RubblePhysics(
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        g=p["g"],
        mu_ice_ice=p["mu"],
        mu_structure=p["mu"],
        form_drag=5.0,
        thickness=p["h"],
    )
    layer = RubbleLayer(physics, p["width"], solids=lambda _: plane(bin_of(10.0)))
    random, size = np.random.default_rng(int(p["seed"])), np.array([p["length"], p["h"]])
    outline = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * size / 2.0
    for i in range(int(p["blocks"])):
        x, z, angle = -6.0 + 6.0 * (i % 3), -13.0 - 4.5 * (i // 3), random.uniform(-0.5, 0.5)
        middle = x * np.cos(angle) + z * np.sin(angle)
        layer.add_block(
            0,
            Slab(
                place(outline, x, z, angle, 0.0, 0.0),
                middle + np.array([-0.5, 0.5]) * size[0],
                np.array([p["width"]]),
                p["rho_i"],
                angle,
            ),
        )
    return layer


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Force on the bin and rest of the pile; ``quick``: 60 s."""
    layer = tumble(p)
    layer.advance(round((60.0 if quick else p["time"]) / layer.physics.substep))
    layer.advance(200)
    weight = layer.mass * (p["rho_w"] / p["rho_i"] - 1.0) * p["g"]
    force, table, energy = layer.load_on_structure.sum(axis=0), layer.table(), mechanical_energy(layer)
    depth = float(-table.position[:, 2] @ table.mass) / layer.mass
    moving = (energy["kinetic"] + energy["added"]) / (weight * depth)
    return CaseResult(
        "pile",
        p,
        [
            near("upward force on the structure", force[2], "N", weight, 1e-3, SOURCE),
            at_most("sideways force, part of the buoyant weight", force[0] / weight, "-", 1e-3, SOURCE),
            at_most("kinetic energy, part of the potential energy", moving, "-", 1e-6, SOURCE),
            value("mean depth", depth, "m"),
        ],
    )
