"""All blocks as arrays, and their balances, gathered over the sections."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from rubble.block import Block
from rubble.geometry import Array, IntArray, moments, place, place_all, submerged
from rubble.physics import RubblePhysics
from rubble.section import Section
from rubble.water import SHARES


@dataclass(frozen=True, slots=True)
class Table:
    """All blocks as arrays, in the order of their numbers; meanings and units as in `coupling.interface.BlockTable`."""

    id: IntArray
    fragment: IntArray
    section: IntArray
    phase: IntArray
    mass: Array
    width: Array
    position: Array
    angle: Array
    velocity: Array
    omega: Array
    load: Array
    outline: Array
    offset: IntArray


def gather(sections: Mapping[int, Section]) -> Table:
    """The table of all blocks."""
    blocks = [b for s in sections.values() for b in s.blocks]
    ids = np.array([b.id for b in blocks], np.int64)
    order = np.argsort(ids)
    state = np.concatenate([np.zeros((0, 6)), *(s.state for s in sections.values())])[order]
    y, v_y = np.array([(b.y, b.v_y) for b in blocks]).reshape(-1, 2)[order].T
    polygons = np.concatenate([np.zeros((0, 2)), *(s.polygons for s in sections.values())])
    count = np.concatenate([np.zeros(0, np.int64), *(np.diff(s.corners) for s in sections.values())])
    start, count = (np.cumsum(count) - count)[order], count[order]
    offset = np.concatenate([[0], np.cumsum(count)]).astype(np.int64)
    corner = np.repeat(start - offset[:-1], count) + np.arange(offset[-1])
    number = np.repeat(np.array(list(sections), np.int64), [len(s.blocks) for s in sections.values()])
    return Table(
        id=ids[order],
        fragment=np.array([b.fragment for b in blocks], np.int64)[order],
        section=number[order],
        phase=np.array([b.phase for b in blocks], np.int64)[order],
        mass=np.array([b.mass for b in blocks])[order],
        width=np.array([b.prism.width for b in blocks])[order],
        position=np.stack([state[:, 0], y, state[:, 1]], -1),
        angle=state[:, 2].copy(),
        velocity=np.stack([state[:, 3], v_y, state[:, 4]], -1),
        omega=state[:, 5].copy(),
        load=np.array([b.load for b in blocks]).reshape(-1, 3)[order],
        outline=place_all(polygons[corner], offset, state),
        offset=offset,
    )


def momentum(blocks: list[Block]) -> Array:
    """True mass times velocity of blocks (3,) [N s], summed in the order of their numbers."""
    rows = [b.mass * np.array([b.body.velocity.x, b.v_y, b.body.velocity.y]) for b in blocks]
    return np.sum(rows, axis=0) if rows else np.zeros(3)


def budget(sections: Iterable[Section], window: float) -> dict[str, Array]:
    """Mean forces on all blocks, x and z, over the last window of length ``window`` [s], each (2,) [N].

    ``flooded_rubble`` weight and the pressure of water as if all tops were flooded, ``dry_tops`` what tops that are not
    add to it, ``drag``, ``inertia`` minus the gain of momentum with added mass, ``on_sheet`` the force that the blocks
    exert on the sheet. What these do not carry presses on the structure.
    """
    forces = np.zeros((5, 2))
    for s in sections:
        forces[:3] += s.losses[-SHARES:].reshape(3, 2)
        forces[0] += window * s.dead_load
        forces[3] -= s.momentum_gain
        forces[4] += s.sheet_sums[5:7]
    names = ("flooded_rubble", "dry_tops", "drag", "inertia", "on_sheet")
    return dict(zip(names, forces / window if window else forces, strict=True))


def energy(blocks: list[Block], physics: RubblePhysics) -> dict[str, float]:
    """Energy of blocks [J]: kinetic (true mass, in the plane and across), added (of the water that moves with them),
    potential (weight, and work against the pressure of water all around).
    """
    kinetic = added = potential = 0.0
    for b in blocks:
        v2, om2 = float(b.body.velocity.length_squared), float(b.body.angular_velocity) ** 2
        kinetic += (b.mass * (v2 + b.v_y**2) + b.prism.inertia * om2) / 2
        added += ((b.body.mass - b.mass) * v2 + (b.body.moment - b.prism.inertia) * om2) / 2
        potential += b.mass * physics.g * b.body.position.y + _water_energy(b, physics)
    return {"kinetic": kinetic, "added": added, "potential": potential}


def _water_energy(block: Block, physics: RubblePhysics) -> float:
    """rho_w g times the integral of depth over the submerged part [J]; strips count with their own width."""
    (x, z), angle = block.body.position, block.body.angle
    total = 0.0
    for part, width in zip(block.prism.parts, block.prism.widths, strict=True):
        area, _, depth, _ = moments(submerged(place(part, x, z, angle, 0.0, 0.0)))
        total -= physics.rho_w * physics.g * width * area * depth
    return total
