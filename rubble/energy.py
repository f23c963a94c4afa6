"""Energy of the rubble: what the blocks have, and where the rest went. All in joules.

The kinetic energy counts a block with its added mass, in the plane and laterally: pymunk moves both, so contacts and
drag take from both. The energy of weight and water all around counts from ice that floats flat in the sheet. A dry top
is no store, because the head that it lacks also presses along a tilted top: its work is a term of its own, which ends
when the top has flooded.
"""

from __future__ import annotations

from collections.abc import Callable

from rubble.arrays import Records
from rubble.block import Block
from rubble.geometry import area_moments, place, submerged
from rubble.layer import RubbleLayer
from rubble.losses import PAIRS
from rubble.physics import RubblePhysics
from rubble.sums import SectionSums


def energy_terms(layer: RubbleLayer) -> dict[str, float]:
    """Stores of the rubble now and sums since the start [J]; a gain is a negative loss, work done on blocks is > 0."""
    now = [s.energy() for s in layer.sections.values()]

    def summed(table: Callable[[SectionSums], Records], field: str, row: int = 0) -> float:
        return sum((float(table(s.sums)[field][row]) for s in layer.sections.values()), 0.0)

    pairs = {
        f"{word}_{name}_loss": summed(lambda s: s.loss, word, k)
        for k, name in enumerate(PAIRS)
        for word in ("impact", "friction")
    }
    return {
        "rubble_kinetic": sum((float(e["kinetic"][0]) for e in now), 0.0),
        "rubble_potential": sum((float(e["potential"][0]) for e in now), 0.0),
        "thrust_work": sum((s.sums.thrust_work for s in layer.sections.values()), 0.0),
        "sheet_work": summed(lambda s: s.step, "on_sheet"),
        "drag_loss": summed(lambda s: s.water, "drag_loss"),
        "dry_top_loss": -summed(lambda s: s.water, "dry_work"),
        **pairs,
        "side_friction_structure_loss": summed(lambda s: s.lateral, "rubbed_structure"),
        "side_friction_ice_loss": summed(lambda s: s.lateral, "rubbed_ice"),
        "side_drag_loss": summed(lambda s: s.lateral, "dragged"),
        "side_impact_loss": layer.lateral_impact,
        "side_push_loss": -summed(lambda s: s.lateral, "pushed"),
        "stepping_loss": -(summed(lambda s: s.step, "stepping") + summed(lambda s: s.water, "stepping")),
        "correction_loss": -summed(lambda s: s.step, "correction"),
        "crushed_energy_loss": layer.crushed.energy,
        "cleared_energy_loss": layer.gone.energy,
    }


def mechanical_energy(layer: RubbleLayer) -> dict[str, float]:
    """Energy of all blocks with their true mass [J], from another zero than above, by clipping instead of by edges.

    ``kinetic`` in the plane and lateral, ``added`` of the water that moves with them, ``potential`` of weight and of
    water all around; ``drag``, what drag in the plane has taken so far, and ``dry``, the work of dry tops, by which the
    potential energy falls short.
    """
    kinetic = added = potential = 0.0
    for b in layer.blocks:
        v2, om2 = float(b.body.velocity.length_squared), float(b.body.angular_velocity) ** 2
        kinetic += (b.mass * (v2 + b.v_y**2) + b.prism.inertia * om2) / 2
        added += ((b.body.mass - b.mass) * v2 + (b.body.moment - b.prism.inertia) * om2) / 2
        potential += b.mass * layer.physics.g * b.body.position.y + _water_energy(b, layer.physics)
    water = [s.sums.water for s in layer.sections.values()]
    drag, dry = sum(float(w["drag_loss"][0]) for w in water), sum(float(w["dry_work"][0]) for w in water)
    return {"kinetic": kinetic, "added": added, "potential": potential, "drag": drag, "dry": dry}


def _water_energy(block: Block, physics: RubblePhysics) -> float:
    """rho_w g times the integral of depth over the submerged part [J]; strips count with their own width."""
    (x, z), angle = block.body.position, block.body.angle
    total = 0.0
    for part, width in zip(block.prism.parts, block.prism.widths, strict=True):
        wet = area_moments(submerged(place(part, x, z, angle, 0.0, 0.0)))
        total -= physics.rho_w * physics.g * width * wet.area * wet.z
    return total
