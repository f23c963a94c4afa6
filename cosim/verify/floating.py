"""Case `float`: draft, heave and pitch of a floating block against hydrostatics, added mass included."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, near
from rubble.arrays import Array
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

PARAMETERS: dict[str, Any] = {
    "length": 10.0,
    "h": 3.0,
    "width": 5.0,
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "g": 9.81,
    "added_mass": 0.2,
    "added_inertia": 0.2,
    "periods": 20,
}
SOURCE = "hydrostatics of a box: T = 2 pi sqrt((m + m_a) / (rho_w g A)), T = 2 pi sqrt((I + I_a) / (rho_w g V GM))"


def block(p: dict[str, Any], draft: float, drag: float, omega: float = 0.0) -> RubbleLayer:
    """One box at a given draft [m]."""
    physics = RubblePhysics(
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        g=p["g"],
        form_drag=drag,
        skin_drag=0.0,
        added_mass=p["added_mass"],
        added_inertia=p["added_inertia"],
        thickness=p["h"],
    )
    layer = RubbleLayer(physics, p["width"])
    x = p["length"] / 2.0
    outline = np.array([(-x, -draft), (x, -draft), (x, p["h"] - draft), (-x, p["h"] - draft)])
    layer.add_block(0, Slab(outline, np.array([-x, x]), np.array([p["width"]]), p["rho_i"]), (0.0, 0.0), omega)
    return layer


def period(layer: RubbleLayer, read: Any, expected: float, periods: int) -> float:
    """Mean time between upward passages of ``read(layer)`` through zero [s]."""
    dt, values = layer.physics.substep, []
    for _ in range(round((periods + 1.5) * expected / dt)):
        layer.advance(1)
        values.append(read(layer))
    x: Array = np.array(values)
    k = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    passages = (k - x[k] / (x[k + 1] - x[k])) * dt
    return float((passages[-1] - passages[0]) / (len(passages) - 1))


def mean_height(p: dict[str, Any], draft: float, heave: float, substeps: int) -> float:
    """Height of the centre, dropped from 0.9 of its draft into drag, over the last period of heave [m]."""
    layer = block(p, 0.9 * draft, 20.0)
    layer.advance(substeps)
    heights = []
    for _ in range(round(heave / layer.physics.substep)):
        layer.advance(1)
        heights.append(layer.table().position[0, 2])
    return float(np.mean(heights))


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Draft, heave and pitch; ``quick``: fewer periods."""
    draft, area = p["h"] * p["rho_i"] / p["rho_w"], p["length"] * p["width"]
    if not p["rho_i"] < p["rho_w"] or not min(p["length"], p["h"], p["width"]) > 0.0:
        raise ValueError("float: the block must have length, h, width > 0 and float, rho_i < rho_w")
    mass, volume = p["rho_i"] * area * p["h"], area * draft
    displaced = p["rho_w"] / p["rho_i"]
    heave = 2.0 * pi * sqrt(mass * (1.0 + p["added_mass"] * displaced) / (p["rho_w"] * p["g"] * area))
    gm = p["length"] ** 2 / (12.0 * draft) + draft / 2.0 - p["h"] / 2.0
    if gm <= 0.0:
        raise ValueError(f"float: a block {p['length']:g} m long and {p['h']:g} m thick turns over; make it longer")
    inertia = mass * (p["length"] ** 2 + p["h"] ** 2) / 12.0 * (1.0 + p["added_inertia"] * displaced)
    pitch = 2.0 * pi * sqrt(inertia / (p["rho_w"] * p["g"] * volume * gm))
    count = 5 if quick else int(p["periods"])
    rest = mean_height(p, draft, heave, 10_000 if quick else 40_000)
    level = p["h"] / 2.0 - draft
    small = 0.1 * (p["h"] - draft)
    return CaseResult(
        "float",
        p,
        [
            near("draft at rest", p["h"] / 2.0 - rest, "m", draft, 1e-3, SOURCE),
            near(
                "heave period",
                period(block(p, draft + small, 0.0), lambda a: a.table().position[0, 2] - level, heave, count),
                "s",
                heave,
                0.01,
                SOURCE,
            ),
            near(
                "pitch period",
                period(block(p, draft, 0.0, small / p["length"]), lambda a: a.table().angle[0], pitch, count),
                "s",
                pitch,
                0.01,
                SOURCE,
            ),
        ],
    )
