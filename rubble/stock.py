"""Energy books of the rubble: what the blocks have, and where the rest went. All in joules.

The kinetic energy counts a block with its added mass, in the plane and across: pymunk moves both, so contacts and drag
take from both. The energy of weight and water all around counts from ice that floats flat in the sheet. A dry top is
no store, because the head that it lacks also presses along a tilted top: its work is a term of its own, which ends when
the top has flooded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rubble.block import Block
from rubble.lateral import ACROSS, DRAGGED, PUSHED, RUBBED
from rubble.losses import CORRECTION, FRICTION, IMPACT, ON_SHEET, STEPPING, STOCK, WORK
from rubble.physics import RubblePhysics
from rubble.water import WATER_SUMS, water_energy

if TYPE_CHECKING:
    from rubble.layer import RubbleLayer

PAIRS = ("ice", "structure", "sheet")  #: what a block meets, in the order of `losses`


def energy_of(block: Block, physics: RubblePhysics) -> tuple[float, float]:
    """Kinetic energy of a block, and its energy of weight and water [J]."""
    body, edges = block.body, block.prism.edges
    turning = 0.5 * body.moment * body.angular_velocity**2 if np.isfinite(body.moment) else 0.0
    water = water_energy(edges, 0, len(edges), body.position.y, body.angle, physics.rho_w * physics.g)
    kinetic = 0.5 * body.mass * (float(body.velocity.length_squared) + block.v_y**2) + turning
    return float(kinetic), float(block.mass * (physics.g * body.position.y - physics.afloat) + water)


def books(layer: RubbleLayer) -> dict[str, float]:
    """Stores of the rubble now and sums since the start [J]; a gain is a negative loss, work done on blocks is > 0."""
    now, work, water, across = np.zeros(STOCK), np.zeros(WORK), np.zeros(WATER_SUMS), np.zeros(ACROSS)
    thrust = 0.0
    for s in layer.sections.values():
        now, work, water, across = now + s.stock(), work + s.work, water + s.losses[:WATER_SUMS], across + s.across_work
        thrust += s.thrust_work
    pairs = {
        f"{word}_{name}_loss": float(work[first + k])
        for k, name in enumerate(PAIRS)
        for word, first in (("impact", IMPACT), ("friction", FRICTION))
    }
    return {
        "rubble_kinetic": float(now[0]),
        "rubble_potential": float(now[1]),
        "thrust_work": thrust,
        "sheet_work": float(work[ON_SHEET]),
        "drag_loss": float(water[0]),
        "dry_top_loss": -float(water[3]),
        **pairs,
        "side_friction_structure_loss": float(across[RUBBED]),
        "side_friction_ice_loss": float(across[RUBBED + 1]),
        "side_drag_loss": float(across[DRAGGED]),
        "side_impact_loss": layer.side_impact,
        "side_push_loss": -float(across[PUSHED]),
        "stepping_loss": -float(work[STEPPING] + water[4]),
        "correction_loss": -float(work[CORRECTION]),
        "crushed_energy_loss": layer.crushed_energy,
        "cleared_energy_loss": layer.cleared_energy,
    }
