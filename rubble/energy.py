"""Energy of the rubble: what the plates have, and where the rest went. All in joules.

The kinetic energy counts a plate with its added mass: contacts and drag take from both. The energy of weight and water
all around counts from ice that floats flat in the sheet. A dry top is no store, because the head that it lacks also
presses along a tilted top: its work is a term of its own, which ends when the top has flooded.
"""

from __future__ import annotations

import numpy as np

from rubble.geometry import area_moments, place, submerged
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Plate
from rubble.rows import KINDS


def energy_terms(layer: RubbleLayer) -> dict[str, float]:
    """Stores of the rubble now and sums since the start [J]; a gain is a negative loss, work done on plates is > 0."""
    moving, resting = layer.runner.energies(layer.store)
    books = {name: float(layer.runner.books[name][0]) for name in layer.runner.books.dtype.names or ()}
    pairs = {f"{word}_{kind}_loss": books[f"{word}_{kind}"] for kind in KINDS for word in ("impact", "friction")}
    return {
        "rubble_kinetic": moving,
        "rubble_potential": float(resting.sum()),
        "thrust_work": books["thrust"],
        "rubble_structure_work": float(layer.runner.moving.work[0]),
        "sheet_work": books["on_sheet"],
        "drag_loss": books["drag_loss"],
        "dry_top_loss": -books["dry_work"],
        **pairs,
        "stepping_loss": -books["stepping"],
        "correction_loss": -books["correction"],
        "breaking_again_loss": layer.runner.broken,
        "crushed_energy_loss": layer.crushed.energy,
        "cleared_energy_loss": layer.gone.energy,
    }


def mechanical_energy(layer: RubbleLayer) -> dict[str, float]:
    """Energy of all plates with their true mass [J], from another zero than above, by clipping instead of by edges.

    For plates that are turned in the x-z plane only. ``kinetic``, ``added`` of the water that moves with them,
    ``potential`` of weight and of water all around; ``drag``, what drag has taken so far, and ``dry``, the work of dry
    tops, by which the potential energy falls short.
    """
    kinetic = potential = 0.0
    for p in layer.blocks:
        r = p.rotation
        spin = p.omega @ (r @ p.spin @ r.T) @ p.omega
        kinetic += (p.mass * float(p.velocity @ p.velocity) + float(spin)) / 2
        potential += p.mass * layer.physics.g * float(p.position[2]) + _water_energy(p, layer.physics)
    books = layer.runner.books
    moving, _ = layer.runner.energies(layer.store)
    return {
        "kinetic": kinetic,
        "added": moving - kinetic,
        "potential": potential,
        "drag": float(books["drag_loss"][0]),
        "dry": float(books["dry_work"][0]),
    }


def _water_energy(plate: Plate, physics: RubblePhysics) -> float:
    """rho_w g times the integral of depth over the submerged part [J]; strips count with their own width."""
    total = 0.0
    for piece in plate.pieces:
        at = plate.position + plate.rotation @ piece.centre
        for part, width in zip(piece.prism.parts, piece.prism.widths, strict=True):
            wet = area_moments(submerged(place(np.ascontiguousarray(part), at[0], at[2], plate.angle, 0.0, 0.0)))
            total -= physics.rho_w * physics.g * width * wet.area * wet.z
    return total
