"""A pymunk space with the settings of a load simulation, and with a memory that survives pickling.

Settings that change loads: collision persistence 1 (reported impulses = momentum balance), slop a small share of the
thickness, a constant sub-step, the first 16 shape ids unused (contacts of a pair among the first shapes would share a
hash and lose their history), no gravity: weight and water act as forces, so that added mass can stand in the mass.
"""

from __future__ import annotations

from typing import Any

import pymunk

from rubble.arrays import Array
from rubble.physics import RubblePhysics


class Space(pymunk.Space):
    """Space whose shapes keep their numbers when it is pickled: contacts find their history again."""

    def __getstate__(self) -> Any:
        state = super().__getstate__()
        special = []
        for key, value in state["special"]:
            if key == "shapes":
                for shape in sorted(value, key=lambda s: s._hashid):
                    special += [("shapeIDCounter", shape._hashid), ("shapes", [shape])]
            else:
                special.append((key, value))
        state["special"] = special
        return state


class Solid(pymunk.Poly):
    """A piece of the structure; its many corners are pickled as one array."""

    def __init__(self, body: pymunk.Body, corners: Array, elasticity: float, kind: int, category: int) -> None:
        super().__init__(body, corners.tolist())
        self._made_of = body, corners, elasticity, kind, category
        self.elasticity, self.collision_type = elasticity, kind
        self.filter = pymunk.ShapeFilter(categories=category)

    def __reduce__(self) -> Any:
        return Solid, self._made_of


def new_space(physics: RubblePhysics) -> Space:
    """An empty space."""
    space = Space()
    space.collision_persistence = 1
    space.collision_slop = physics.slop
    space.iterations = int(physics.iterations)
    unused = [pymunk.Circle(space.static_body, 1.0) for _ in range(16)]
    space.add(*unused)
    space.remove(*unused)
    return space
