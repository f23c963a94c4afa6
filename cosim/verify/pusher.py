"""Case `pusher`: a row of floating blocks, pushed from behind, passes the force on to the structure."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Quantity, near, value
from rubble.arrays import Array
from rubble.cut import plane
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import thrust

PARAMETERS: dict[str, Any] = {
    "blocks": [5, 10, 20],
    "length": 4.0,
    "h": 3.0,
    "width": 2.8,
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "g": 9.81,
    "force": 5.0e5,
    "iterations": 30,
    "window": 0.05,
}
SOURCE = "statics of a row: the wall carries what pushes it"


def pushed(p: dict[str, Any], count: int, seconds: float) -> Array:
    """Mean force on the wall in every window [N]."""
    physics = RubblePhysics(
        rho_i=p["rho_i"], rho_w=p["rho_w"], g=p["g"], thickness=p["h"], iterations=int(p["iterations"])
    )
    wall = np.array([(0.0, -30.0), (10.0, -30.0), (10.0, 30.0), (0.0, 30.0)])
    layer = RubbleLayer(physics, p["width"], solids=lambda _: plane([wall]))
    low, a = -p["h"] * p["rho_i"] / p["rho_w"], p["length"]
    for i in range(count):
        x = -a * i
        outline = np.array([(x - a, low), (x, low), (x, low + p["h"]), (x - a, low + p["h"])])
        layer.add_block(0, Slab(outline, np.array([x - a, x]), np.array([p["width"]]), p["rho_i"]))
    thrust(layer, count - 1, (p["force"], 0.0, 0.0))
    force = []
    for _ in range(round(seconds / p["window"])):
        layer.advance(round(p["window"] / physics.substep))
        force.append(float(layer.load_on_structure[:, 0].sum()))
    return np.array(force)


def settling_time(force: Array, expected: float, window: float) -> float:
    """End of the last window that is off by more than 1 % [s]."""
    off = np.flatnonzero(np.abs(force - expected) > 0.01 * expected)
    return window * float(off[-1] + 1) if len(off) else 0.0


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Force that rows of blocks pass on; ``quick``: two rows, 20 s."""
    if not p["force"] > 0.0 or not min(p["blocks"]) >= 1:
        raise ValueError("pusher: give a force > 0 and rows of one block or more")
    quantities: list[Quantity] = []
    for count in [int(n) for n in p["blocks"]][: 2 if quick else None]:
        seconds = 20.0 if quick else 60.0
        force = pushed(p, count, seconds)
        half = force[len(force) // 2 :]
        quantities += [
            near(
                f"{count} blocks: force on the wall, smallest and largest window of the second half",
                [half.min(), half.max()],
                "N",
                [p["force"]] * 2,
                0.01,
                SOURCE,
            ),
            value(f"{count} blocks: settling time to 1 %", settling_time(force, p["force"], p["window"]), "s"),
        ]
    return CaseResult("pusher", p, quantities)
