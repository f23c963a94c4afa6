"""Case `cone`: the force of one plate on the cone at a distance |y| from the axis, against three-dimensional mechanics.

The plate is pressed on the cone by its buoyancy and a thrust H along x, and slides on it, free to go wherever the cone
lets it. With the unit normal n of the cone, the unit slip s (n s = 0) and the friction coefficient mu, the cone presses
on the plate with ``N (n - mu s)``. Nothing accelerates it along n, but for the bend of its way, which is slow here:
``n (W + N (n - mu s)) = 0``, W = (H, 0, buoyancy - weight), so N = -n W. A face that did not recede when the plate
slides round the cone would press with another force: the balance in the section alone is refused.
"""

from __future__ import annotations

from math import radians
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, near
from coupling.structure import Revolved, cone
from rubble.arrays import Array
from rubble.cut import revolved
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import lock_rotation, thrust

PARAMETERS: dict[str, Any] = {
    "radius": 15.0,
    "slope": 45.0,
    "y": [0.0, 0.5, 0.8, -0.8],
    "mu": 0.1,
    "thrust": 3.0,
    "across": [0.0, 0.2],
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "g": 9.81,
}
SOURCE = "mechanics of a body that slides on a cone, in three dimensions"
WIDTH, SIZE = 0.1, 1.0


def pressed_block(p: dict[str, Any], structure: Revolved, y: float) -> tuple[RubbleLayer, int, float]:
    """A round plate on the cone in the plane y that does not turn: its layer, its number, its buoyant lift [N]."""
    physics = RubblePhysics(
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        g=p["g"],
        mu_structure=p["mu"],
        form_drag=0.0,
        skin_drag=0.0,
        thickness=0.1,
        substep=5e-4,
    )
    layer = RubbleLayer(
        physics,
        WIDTH,
        origin=y,
        solids=lambda at: revolved(convex_parts(*structure.section(at, structure.bottom, structure.top, 1e-3))),
    )
    z, angle = -1.5, 2.0 * np.pi * (np.arange(24) + 0.5) / 24
    n = structure.normal(y, z)
    m = n[[0, 2]] / np.hypot(n[0], n[2])
    round_ = SIZE * np.column_stack([np.cos(angle), np.sin(angle)])
    middle = np.array([float(structure.face_x(y, z)), z]) + (float((-round_ @ m).max()) - 1e-4) * m
    outline = middle + round_
    ends = np.array([outline[:, 0].min(), outline[:, 0].max()])
    number = layer.add_block(0, Slab(outline, ends, np.array([WIDTH]), p["rho_i"]), y=y)
    lift = (p["rho_w"] / p["rho_i"] - 1.0) * p["g"] * layer.mass
    thrust(layer, number, (p["thrust"] * lift, 0.0, 0.0))
    lock_rotation(layer, number)
    return layer, number, lift


def slide(p: dict[str, Any], y: float, across: float) -> tuple[Array, Array, Array]:
    """Measured and exact force on the structure (3,), and that of the section's balance, means while it slides [N]."""
    structure = cone(radians(p["slope"]), p["radius"], toe_depth=0.9 * p["radius"] * np.tan(radians(p["slope"])))
    layer, number, lift = pressed_block(p, structure, y)
    layer.block(number).velocity[:] = _along(structure, y, float(np.copysign(across, y)))
    measured, exact, section = [], [], []
    n = structure.normal(y, -1.5)
    for _ in range(600):
        layer.advance(1)
        now, at = layer.table(), layer.contact_centres()[0]
        if np.isfinite(at).all():  # where the face curves away the plate may leave it for a sub-step or two
            n = structure.normal(at[1], at[2])
        measured.append(now.load[0])
        bend = _bend(n, float(np.hypot(at[0], at[1])), now.velocity[0]) * layer.mass if np.isfinite(at).all() else 0.0
        exact.append(_load(p, n, now.velocity[0], lift, n, bend))
        section.append(_load(p, n, now.velocity[0], lift, np.array([n[0], 0.0, n[2]])))
    return np.mean(measured[200:], axis=0), np.mean(exact[200:], axis=0), np.mean(section[200:], axis=0)


def _along(structure: Revolved, y: float, across: float) -> Array:
    """A velocity (3,) on the cone, on one level, with the part ``across`` along y [m/s]."""
    n = structure.normal(y, -1.5)
    level = np.array([-n[1], n[0], 0.0]) / n[0]
    return np.asarray(across * level)


def _bend(n: Array, radius: float, velocity: Array) -> float:
    """Acceleration along -n of what goes round the axis of a cone [m/s2]: v^2 times the part of n across, over r."""
    across = float(np.hypot(n[0], n[1]))
    return float(velocity @ np.array([-n[1], n[0], 0.0])) ** 2 / across / radius


def _load(p: dict[str, Any], n: Array, velocity: Array, lift: float, balance: Array, bend: float = 0.0) -> Array:
    """Force on the structure (3,) of a plate that slides; it needs the force ``bend`` along -balance to follow it."""
    slip = velocity - (velocity @ n) * n
    contact = n - p["mu"] * slip / max(float(np.linalg.norm(slip)), 1e-12)
    load = np.array([p["thrust"] * lift, 0.0, lift])
    return np.asarray((load @ balance + bend) / (contact @ balance) * contact)


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Force of a plate at every ``y`` and speed ``across``, measured and by mechanics, with a twin that is refused."""
    if not max(abs(y) for y in p["y"]) <= 0.85:
        raise ValueError("cone: y is a share of the radius, at most 0.85: the block stands 1.5 m below water")
    quantities = []
    for y in p["y"]:
        for across in p["across"]:
            measured, exact, section = slide(p, y * p["radius"], across)
            size = float(np.linalg.norm(exact))
            error, twin = np.abs(measured - exact).max() / size, np.abs(measured - section).max() / size
            name = f"y = {y:g} R, outwards at {across:g} m/s: "
            quantities += [
                near(f"{name}Fx, Fz", measured[[0, 2]], "N", exact[[0, 2]], 0.01, SOURCE),
                near(f"{name}largest difference, part of the force", error, "-", 0.0, 0.01, SOURCE, "absolute"),
            ]
            if y != 0.0:
                refused = float(twin > 0.05)
                quantities.append(
                    near(f"{name}a face that does not recede is refused (1 = yes)", refused, "-", 1.0, 0.0, SOURCE)
                )
    return CaseResult("cone", p, quantities)
