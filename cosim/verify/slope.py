"""Case `slope`: a block on a slope in air, and one that floats up under a slope: rest, threshold, acceleration."""

from __future__ import annotations

from math import atan, cos, degrees, radians, sin
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Quantity, at_most, near
from coupling.structure import plane_slope
from rubble.cut import plane as plane_cut
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab

PARAMETERS: dict[str, Any] = {
    "mu": [0.1, 0.35],
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "g": 9.81,
    "added_mass": 0.2,
    "above": 10.0,
    "iterations": 30,
}
SOURCE = "Coulomb friction: tan(threshold) = mu, a = W (sin - mu cos) / (m + m_a)"
LENGTH, HEIGHT, WIDTH, TIME = 4.0, 1.0, 2.0, 3.0


def slide(p: dict[str, Any], mu: float, slope: float, wet: bool) -> tuple[float, float]:
    """Speed along the slope after TIME and at half of it [m/s] of a block at rest on (or under) a slope [deg]."""
    physics = RubblePhysics(
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        g=p["g"],
        mu_structure=mu,
        form_drag=0.0,
        skin_drag=0.0,
        added_mass=p["added_mass"],
        iterations=int(p["iterations"]),
        thickness=HEIGHT,
    )
    a, up = radians(slope), -1.0 if wet else 1.0
    plane = plane_slope(a, top=120.0, toe_depth=120.0, breaking="downward" if wet else "upward")
    layer = RubbleLayer(
        physics,
        WIDTH,
        solids=lambda y: plane_cut(convex_parts(plane.section(y, plane.bottom, plane.top, 0.01)[0], back=1e4)),
    )
    z = up * 100.0
    box = np.array([(-LENGTH / 2, 0.0), (LENGTH / 2, 0.0), (LENGTH / 2, HEIGHT), (-LENGTH / 2, HEIGHT)])
    turn = a if not wet else np.pi - a  # its lower side on the face, its upper side away from the structure
    x, z = float(plane.face_x(0.0, z)) + physics.slop / 2 * sin(a), z - up * physics.slop / 2 * cos(a)  # in contact
    outline = place(box, x, z, turn, 0.0, 0.0)
    middle = x * np.cos(turn) + z * np.sin(turn)
    layer.add_block(0, Slab(outline, middle + np.array([-LENGTH / 2, LENGTH / 2]), np.array([WIDTH]), p["rho_i"], turn))
    speeds = []
    for _ in range(2):
        layer.advance(round(TIME / 2 / physics.substep))
        v = layer.table().velocity[0]
        speeds.append(float(np.hypot(v[0], v[2])))
    return speeds[1], speeds[0]


def threshold(p: dict[str, Any], mu: float, wet: bool, width: float) -> float:
    """Slope at which the block begins to slide, by bisection to ``width`` [deg]."""
    low, high = 0.9 * degrees(atan(mu)), 1.1 * degrees(atan(mu))
    while high - low > width:
        middle = (low + high) / 2
        late, early = slide(p, mu, middle, wet)
        low, high = (low, middle) if late > 1e-5 and late > 1.5 * early else (middle, high)
    return (low + high) / 2


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Threshold, rest below it and acceleration above it; ``quick``: a wider bracket of the threshold."""
    quantities: list[Quantity] = []
    for mu in p["mu"]:
        for wet in (False, True):
            where = f"mu = {mu:g}, " + ("buoyant block under a slope" if wet else "block on a slope in air")
            limit = degrees(atan(mu))
            quantities.append(
                near(
                    f"{where}: threshold",
                    threshold(p, mu, wet, 0.01 if quick else 0.002),
                    "deg",
                    limit,
                    0.01,
                    SOURCE,
                    "absolute",
                )
            )
            quantities.append(
                at_most(f"{where}: speed 0.01 degree below it", slide(p, mu, limit - 0.01, wet)[0], "m/s", 1e-6, SOURCE)
            )
            late, early = slide(p, mu, limit + p["above"], wet)
            a = radians(limit + p["above"])
            drive = (
                p["g"]
                * (p["rho_w"] / p["rho_i"] - 1.0 if wet else 1.0)
                / (1.0 + p["added_mass"] * p["rho_w"] / p["rho_i"])
            )
            quantities.append(
                near(
                    f"{where}: acceleration {p['above']:g} degrees above it",
                    (late - early) / TIME * 2,
                    "m/s2",
                    drive * (sin(a) - mu * cos(a)),
                    1e-3,
                    SOURCE,
                )
            )
    return CaseResult("slope", p, quantities)
