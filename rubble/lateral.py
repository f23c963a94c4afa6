"""Motion of blocks across the sections: they clear sideways around the structure.

The structure presses a block along its normal, so the in-plane normal force F_x brings a side force F_y = F_x times
`lateral_ratio`. Water drag and friction resist. A rough surface resists against the direction of slip; with the block
also slipping at v_s in the plane, its share across is ``mu N v_y / hypot(v_y, v_s)``: full Coulomb friction for a block
that only moves sideways, little for one that slides past anyway.
"""

from __future__ import annotations

from math import hypot

from rubble.block import Block
from rubble.geometry import moments, place, submerged
from rubble.physics import RubblePhysics


def side_step(block: Block, physics: RubblePhysics, force: float, friction: float, slip: float, dt: float) -> None:
    """Move a block across by one window: ``force`` Fy on the block and friction limit mu N [N], slip v_s [m/s].

    Backward Euler for friction and drag, so neither turns the motion around.
    """
    if force == 0.0 and block.v_y == 0.0:
        return
    mass = float(block.body.mass)
    v = block.v_y + dt * force / mass
    speed = hypot(v, slip)
    if speed > 0.0:
        v *= max(0.0, 1.0 - dt * friction / (mass * speed))
    block.v_y = 0.0 if v == 0.0 else v / (1.0 + dt * side_drag(block, physics) * abs(v) / mass)
    block.y += dt * block.v_y


def push(block: Block, neighbour: Block | None) -> None:
    """Plastic impact across: both blocks go on with their common speed; without a neighbour the block stops.

    Momentum across is kept between blocks; sheet and structure take it up.
    """
    if neighbour is None:
        block.v_y = 0.0
        return
    m, n = float(block.body.mass), float(neighbour.body.mass)
    if (block.y - neighbour.y) * (block.v_y - neighbour.v_y) < 0.0:  # they approach each other
        block.v_y = neighbour.v_y = (m * block.v_y + n * neighbour.v_y) / (m + n)


def side_drag(block: Block, physics: RubblePhysics) -> float:
    """rho_w/2 C_d times the submerged side face: drag over v_y |v_y| [kg/m]."""
    (x, z), angle = block.body.position, block.body.angle
    wet = submerged(place(block.polygon, x, z, angle, 0.0, 0.0))
    return physics.rho_w / 2 * physics.form_drag * float(moments(wet)[0])
