"""A fragment is handed over: its blocks go into the layer, and what arrives is set against what left."""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, Fragment, HandOver
from coupling.rubble_port.births import BlockBirth, births, centre_of, momenta_of
from rubble.block import Block, Slab, energy_of
from rubble.geometry import area_moments, contiguous
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics

#: share of h^2 below which what is left of a trimmed block counts as crushed: a sliver as long as the ice is thick
#: would be thinner than a fifth of the overlap that contacts leave alone (0.5 % of h), so no contact would hold it
SMALLEST = 1e-3


class Arrivals:
    """Puts blocks into a layer and counts the energy with which they are born."""

    def __init__(self, physics: RubblePhysics, columns_per_section: int):
        self._physics, self._columns = physics, columns_per_section
        self.fragments = 0
        self.born = np.zeros(2)  #: kinetic energy, and that of weight and water, of all blocks when they were born [J]

    def add(self, layer: RubbleLayer, fragment: Fragment) -> HandOver:
        """Turns a fragment into blocks where and as it moves now."""
        h = self._physics.thickness
        about, mass = centre_of(fragment), float(fragment.mass.sum())
        (left, scale), arrived, changed = momenta_of(fragment, h, about), np.zeros(4), np.zeros(4)
        trimmed, count = mass, 0
        for birth in births(fragment, h, self._columns):
            block = self._place(layer, birth)
            changed += birth.momenta(about)
            if block is not None:
                arrived, changed = arrived + _momenta(block, about), changed - _as_born(block, birth, about)
                trimmed, count = trimmed - block.mass, count + 1
        self.fragments += 1
        error = np.abs(arrived + changed - left) / np.maximum(scale, 1e-9)
        return HandOver(
            blocks=count,
            mass=mass,
            trimmed=trimmed,
            momentum_error=float(error[:3].max()),
            angular_momentum_error=float(error[3]),
            angular_momentum_change=float(abs(changed[3]) / max(scale[3], 1e-9)),
        )

    def _place(self, layer: RubbleLayer, b: BlockBirth) -> Block | None:
        """Puts one block into its section, outside the structure; None if nothing is left of it."""
        key = layer.key_at(b.y)
        polygon = layer.trim(b.polygon, key) if b.mass > 0.0 else np.empty((0, 2))
        if len(polygon) < 3 or area_moments(contiguous(polygon)).area < SMALLEST * self._physics.thickness**2:
            return None
        slab = Slab(polygon, b.cuts, b.widths, self._physics.rho_i, b.angle)
        head = b.flooded if self._physics.filling_rate > 0.0 else None
        number = layer.add_block(
            key, slab, b.velocity.tolist(), b.omega, y=b.y, fragment=self.fragments, flooded=head, alone=False
        )
        block = layer.block(number)
        self.born += energy_of(block, self._physics)
        return block


def _momenta(block: Block, about: Array) -> Array:
    """Momentum x, y, z of a block and angular momentum about a point in the x-z plane, as it moves (4,)."""
    v = block.body.velocity
    p = block.mass * np.array([v.x, block.v_y, v.y])
    arm = np.array(block.body.position) - about
    return np.array([*p, arm[0] * p[2] - arm[1] * p[0] + block.prism.inertia * block.body.angular_velocity])


def _as_born(block: Block, birth: BlockBirth, about: Array) -> Array:
    """The same for the ice of a block, where it is, with the motion of its nodes (4,)."""
    p, arm = block.mass * birth.velocity, np.array(block.body.position) - about
    return np.array([*p, arm[0] * p[2] - arm[1] * p[0] + block.prism.inertia * birth.omega])
