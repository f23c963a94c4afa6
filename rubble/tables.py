"""Tables of a section for the kernels, laid out from its blocks whenever bodies have come, gone or changed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pymunk

from rubble.arrays import Array, Records, filled, gathered
from rubble.block import Block
from rubble.bodies import FORCE, LATERAL, LOAD, STATE, Bodies, Outlines, read_bodies
from rubble.overload import Strength
from rubble.phases import AXIS, STATUS
from rubble.physics import RubblePhysics
from rubble.pointers import address, body_layout
from rubble.pressure import EDGE
from rubble.slots import SHEET_SLOT, STRUCTURE_SLOT, Slots, slot_table
from rubble.water import Hulls

_BODY = body_layout()


@dataclass(frozen=True)
class Tables:
    """One row per block, in the order of their numbers; only the states count the sheet as well."""

    bodies: Bodies
    hulls: Hulls
    outlines: Outlines
    slots: Slots
    strength: Strength
    moved: Array  #: (n,) mass with added mass [kg]
    mass: Array  #: (n,) true mass [kg]
    thrust: Array | None  #: (n, 3) constant force and moment beside the weight, if there is any [N, N, N m]
    lateral: Records  #: (n,) LATERAL; the blocks hold its rows
    load: Records  #: (n,) LOAD: mean force on the structure over the last window [N]
    axes: Records  #: (n,) AXIS
    status: Records  #: (n,) STATUS

    @property
    def state(self) -> Records:
        """(n,) STATE of the blocks; a view."""
        return self.bodies.state[: self.bodies.blocks]


def lay_out(blocks: Sequence[Block], sheet: pymunk.Body | None, still: pymunk.Body, physics: RubblePhysics) -> Tables:
    """The tables of blocks, the sheet's body and the structure's; the blocks move into them."""
    status = np.zeros(len(blocks), STATUS)
    status["aligned"], status["sliding"] = [b.aligned for b in blocks], [b.sliding for b in blocks]
    bodies = _bodies(blocks, sheet)
    slots = [*range(len(blocks)), SHEET_SLOT][: len(bodies.address)]
    tables = Tables(
        bodies=bodies,
        hulls=_hulls(blocks, physics.g),
        outlines=_outlines(blocks),
        slots=slot_table([address(still._body), *bodies.address.tolist()], [STRUCTURE_SLOT, *slots]),
        strength=_strength(blocks, physics),
        moved=np.array([b.body.mass for b in blocks], np.float64),
        mass=np.array([b.mass for b in blocks], np.float64),
        thrust=np.array([b.thrust for b in blocks]) if any(any(b.thrust) for b in blocks) else None,
        lateral=filled(LATERAL, [b.lateral.tolist() for b in blocks]),
        load=filled(LOAD, [b.load.tolist() for b in blocks]),
        axes=_axes(blocks, physics.thickness),
        status=status,
    )
    for i, block in enumerate(blocks):
        block.lateral, block.load, block.pressure = tables.lateral[i], tables.load[i], tables.hulls.pressure[i]
    read_bodies(bodies)
    return tables


def _bodies(blocks: Sequence[Block], sheet: pymunk.Body | None) -> Bodies:
    moving = [b.body for b in blocks] + ([sheet] if sheet is not None else [])
    addresses = np.array([address(body._body) for body in moving], np.int64)
    return Bodies(addresses, _BODY, np.zeros(len(moving), STATE), len(blocks))


def _hulls(blocks: Sequence[Block], g: float) -> Hulls:
    edges = [b.prism.edges for b in blocks]
    return Hulls(
        edges=filled(EDGE, gathered(edges, EDGE)),
        offset=np.cumsum([0, *map(len, edges)], dtype=np.int64),
        weight=filled(FORCE, [(b.thrust[0], b.thrust[1] - b.mass * g, b.thrust[2]) for b in blocks]),
        flooded=np.array([b.flooded for b in blocks], np.float64),
        pressure=filled(FORCE, [b.pressure.tolist() for b in blocks]),
    )


def _outlines(blocks: Sequence[Block]) -> Outlines:
    polygons = [b.prism.polygon for b in blocks]
    corners = np.concatenate([np.zeros((0, 2)), *polygons])
    return Outlines(corners, np.cumsum([0, *map(len, polygons)], dtype=np.int64))


def _strength(blocks: Sequence[Block], physics: RubblePhysics) -> Strength:
    per_area, length = physics.contact_strength * physics.substep, 2.0 * physics.slop
    widths = [b.prism.width for b in blocks]
    least = per_area * length * min(widths, default=0.0)
    return Strength(per_area, length, least, np.array(widths, np.float64))


def _axes(blocks: Sequence[Block], thickness: float) -> Records:
    """A block counts as next to a slope within its own reach and one thickness."""
    return filled(
        AXIS,
        [(b.prism.reach + thickness, b.prism.long_axis, np.pi if b.prism.slender else np.pi / 2) for b in blocks],
    )
