"""Case `cone`: the force of one block on the cone at a distance |y| from the axis, against three-dimensional statics.

The block is pressed on the cone by its buoyancy and a thrust H along x, and slides on it. With the unit normal n of the
cone, the unit slip s (n s = 0) and the friction coefficient mu, the cone presses on the block with ``N (n - mu s)``.
Neighbours carry what acts across, so the balance in the section along the face's normal m (in the plane) gives N:
``m (W + N (n - mu s)) = 0``, W = (H, 0, buoyancy - weight). The structure receives ``-N (n - mu s)``: Fx, Fy, Fz.
"""

from __future__ import annotations

from math import radians
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, near
from coupling.rubble_port import OUTLINE_TOLERANCE
from coupling.structure import Revolved, cone
from rubble.arrays import Array
from rubble.piece import Slab
from rubble.cut import revolved
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
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
SOURCE = "equilibrium of a block on a cone in three dimensions"
WIDTH, SIZE = 1.0, 1.0


def pressed_block(p: dict[str, Any], structure: Revolved, y: float) -> tuple[RubbleLayer, int, float]:
    """A round block on the cone in the plane y that does not turn: its layer, its number, its buoyant lift [N]."""
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
        solids=lambda at: revolved(
            convex_parts(*structure.section(at, structure.bottom, structure.top, OUTLINE_TOLERANCE))
        ),
    )
    z, angle = -1.5, 2.0 * np.pi * (np.arange(128) + 0.5) / 128
    n = structure.normal(y, z)
    m = n[[0, 2]] / np.hypot(n[0], n[2])
    middle = np.array([float(structure.face_x(y, z)), z]) + (SIZE - 1e-4) * m
    outline = middle + SIZE * np.column_stack([np.cos(angle), np.sin(angle)])
    ends = np.array([outline[:, 0].min(), outline[:, 0].max()])
    number = layer.add_block(0, Slab(outline, ends, np.array([WIDTH]), p["rho_i"]), y=y)
    lift = (p["rho_w"] / p["rho_i"] - 1.0) * p["g"] * layer.mass
    lock_rotation(layer, number)
    thrust(layer, number, p["thrust"] * lift)
    return layer, number, lift


def slide(p: dict[str, Any], y: float, across: float) -> tuple[Array, Array]:
    """Measured and exact force on the structure (3,), mean over windows in which the block slides [N]."""
    structure = cone(radians(p["slope"]), p["radius"], toe_depth=0.9 * p["radius"] * np.tan(radians(p["slope"])))
    layer, number, lift = pressed_block(p, structure, y)
    measured, exact = [], []
    for _ in range(800):
        layer.block(number).y, layer.block(number).v_y = y, across
        before = layer.table()
        layer.advance(1)
        now = layer.table()
        measured.append(now.load[0])
        centre = 0.5 * (before.position[0] + now.position[0])[[0, 2]]
        velocity = 0.5 * (before.velocity[0] + now.velocity[0])
        exact.append(_statics(p, structure, y, centre, velocity, across, lift))
    return np.mean(measured[100:], axis=0), np.mean(exact[100:], axis=0)


def _statics(
    p: dict[str, Any], structure: Revolved, y: float, centre: Array, velocity: Array, across: float, lift: float
) -> Array:
    """Force on the structure (3,) of a round block at ``centre`` that slides with ``velocity``, across at a speed."""
    z = np.linspace(centre[1] - SIZE, centre[1] + SIZE, 2001)
    gap = np.hypot(structure.face_x(y, z) - centre[0], z - centre[1])
    n = structure.normal(y, z[np.nanargmin(gap)])
    m = np.array([n[0], 0.0, n[2]]) / np.hypot(n[0], n[2])
    t = np.array([-m[2], 0.0, m[0]])
    level = np.cross(t, n)  # the direction on the surface at right angles to the section's face
    slip = (velocity @ t) * t + across / level[1] * level
    s = slip / max(float(np.linalg.norm(slip)), 1e-12)
    contact = n - p["mu"] * s
    load = np.array([p["thrust"] * lift, 0.0, lift])
    return np.asarray(load @ m / (contact @ m) * contact)


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Force of a block at every ``y`` and speed ``across``, measured and by statics."""
    if not max(abs(y) for y in p["y"]) <= 0.85:
        raise ValueError("cone: y is a share of the radius, at most 0.85: the block stands 1.5 m below water")
    quantities = []
    for y in p["y"]:
        for across in p["across"]:
            measured, exact = slide(p, y * p["radius"], across)
            error = np.abs(measured - exact).max() / np.linalg.norm(exact)
            name = f"y = {y:g} R, sideways at {across:g} m/s: "
            quantities += [
                near(f"{name}Fx, Fz", measured[[0, 2]], "N", exact[[0, 2]], 0.01, SOURCE),
                near(f"{name}Fy", measured[1], "N", exact[1], 0.01, SOURCE),
                near(f"{name}largest difference, part of the force", error, "-", 0.0, 0.01, SOURCE, "absolute"),
            ]
    return CaseResult("cone", p, quantities)
