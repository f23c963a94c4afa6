"""Test rigs on blocks: what verification needs and a run never uses."""

from __future__ import annotations

import pymunk

from rubble.layer import RubbleLayer


class Hinge:
    """A moment-free connection of a block with a point that moves at a given velocity."""

    def __init__(
        self,
        layer: RubbleLayer,
        section: int,
        block: int,
        x: float,
        z: float,
        velocity: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """At (x, z) [m]; ``velocity`` [m/s]."""
        own = layer.section(section)
        self.body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        self.body.position, self.body.velocity = (x, z), velocity
        joint = pymunk.PivotJoint(self.body, layer.block(block).body, (x, z))
        joint.collide_bodies = False
        own.space.add(self.body, joint)
        own.changed()

    @property
    def position(self) -> tuple[float, float]:
        """Where the hinge is now, x and z [m]."""
        return float(self.body.position.x), float(self.body.position.y)


def thrust(layer: RubbleLayer, block: int, fx: float, fz: float = 0.0, moment: float = 0.0) -> None:
    """Press a block with a constant force [N] at its centre and a moment [N m]."""
    layer.block(block).thrust = (fx, fz, moment)
    for section in layer.sections.values():
        section.changed()


def lock_rotation(layer: RubbleLayer, block: int) -> None:
    """Let a block move without turning."""
    layer.block(block).body.moment = float("inf")
