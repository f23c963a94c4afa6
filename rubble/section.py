"""One vertical section parallel to the drift: a pymunk space in (x, z) with blocks, structure and sheet."""

from __future__ import annotations

from typing import Any

import numpy as np
import pymunk

from rubble.arbiters import ContactReader
from rubble.arrays import Array, Records, rows
from rubble.block import Block
from rubble.contacts import ON_BLOCK, Meeting
from rubble.cut import Cut
from rubble.geometry import contiguous, overlap_area
from rubble.handlers import STRUCTURE, Handlers
from rubble.losses import ENERGY, Ground, energy_now
from rubble.phases import update_phases
from rubble.physics import RubblePhysics
from rubble.pointers import address
from rubble.sheet import DRIVER, STRUCTURE_CATEGORY, SheetBody, SheetMotion
from rubble.space import Solid, new_space
from rubble.stepping import STEP, TOO_MANY, Steps, advance_substeps
from rubble.sums import SectionSums
from rubble.tables import lay_out
from rubble.trim import cut_away
from rubble.water import water_of

_NO_DRIVER = np.zeros(0, DRIVER)
_ADDRESSES = {"tables", "_reader", "_steps", "_handlers"}  #: hold addresses: made anew after a snapshot is loaded


class Section:
    """Blocks, structure and sheet in the plane y; blocks are kept in the order of their numbers."""

    def __init__(self, physics: RubblePhysics, cut: Cut, y: float) -> None:
        self.physics, self.cut, self.y = physics, cut, y
        self.slopes = cut.slopes
        self.space = new_space(physics)
        self.blocks: list[Block] = []
        self.sheet: SheetBody | None = None
        self.sums = SectionSums()
        self.water = water_of(physics)
        for solid in cut.polygons:
            self.space.add(
                Solid(self.space.static_body, solid, physics.restitution**0.5, STRUCTURE, STRUCTURE_CATEGORY)
            )
        self._connect()

    def _connect(self) -> None:
        self._reader = ContactReader()
        self._steps = Steps(self.physics.substep, address(self.space._space), STEP)
        self._handlers = Handlers(self.space, self.physics, self.cut.bearings, self.y, self._reader)
        self.changed()

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in self.__dict__.items() if k not in _ADDRESSES}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        window = self.sums.block
        self._connect()
        self.sums.block = window

    @property
    def state(self) -> Records:
        """(n,) STATE of the blocks after the last window; a view."""
        return self.tables.state

    @property
    def overloads(self) -> Records:
        """Overloaded pairs of the last window, OVERLOAD."""
        return self.sums.overloads

    # ---- blocks and sheet -------------------------------------------------------------------------------------

    def trim(self, polygon: Array) -> Array:
        """What is left of a convex outline outside the structure, convex; (0, 2) if nothing is."""
        return cut_away(contiguous(polygon), self.cut)

    def add(self, block: Block, *, alone: bool = True) -> None:
        """Take in a block; ValueError if it stands inside the structure or, if ``alone``, inside another block."""
        inside, room = overlap_area(block.outline, self.cut.polygons), 2 * self.physics.slop * np.sqrt(block.prism.area)
        where = f"block {block.id} at x = {block.body.position.x:.3f}, z = {block.body.position.y:.3f} m"
        if inside > room:
            raise ValueError(f"{where} overlaps the structure by {inside:.3g} m2; trim its outline first")
        for other in self.blocks if alone else []:
            if (shared := overlap_area(block.outline, [other.outline])) > room:
                raise ValueError(f"{where} overlaps block {other.id} by {shared:.3g} m2; move one of them")
        self.adopt(block)

    def adopt(self, block: Block) -> None:
        """Take in a block that comes from another section, as it is."""
        self.space.add(block.body, block.shape)
        self.blocks = sorted([*self.blocks, block], key=lambda b: b.id)
        self.changed()

    def in_the_way(self, block: Block) -> tuple[float, Block | None]:
        """What stands where a block of another section would be: how deep it would be in it [m], and the block it is.

        None in place of the block for structure, sheet or free room.
        """
        block.shape.cache_bb()
        number: dict[pymunk.Shape | None, Block] = {b.shape: b for b in self.blocks}
        found = [
            (max((-p.distance for p in info.contact_point_set.points), default=0.0), number.get(info.shape))
            for info in self.space.shape_query(block.shape)
            if info.shape is not None
        ]
        return max(found, key=lambda f: (f[0], f[1].id if f[1] else -1), default=(0.0, None))

    def take(self, block: Block) -> None:
        """Take a block out of the section."""
        self.space.remove(block.shape, block.body)
        self.blocks = [b for b in self.blocks if b is not block]
        self.changed()

    def set_sheet(self, motion: SheetMotion) -> None:
        """Where the sheet is at the start of a window, and how it moves."""
        if self.sheet is None:
            self.sheet = SheetBody(self.space, self.physics, motion)
            self.changed()
        self.sheet.follow(motion)

    def remove_sheet(self) -> None:
        """Take the sheet out of the section."""
        if self.sheet is not None:
            self.sheet.remove()
            self.sheet = None
            self.changed()

    def changed(self) -> None:
        """Lay out the tables of the kernels anew after bodies have come, gone or changed."""
        sheet = self.sheet.body if self.sheet is not None else None
        self.tables = lay_out(self.blocks, sheet, self.space.static_body, self.physics)
        self.sums.block = np.zeros(len(self.blocks), ON_BLOCK)
        self._handlers.watch(self.tables.bodies, self.tables.slots, self.tables.lateral)

    # ---- motion -----------------------------------------------------------------------------------------------

    def advance(self, n_substeps: int) -> None:
        """Move on by whole sub-steps; sums of impulses start from zero."""
        sums, tables = self.sums, self.tables
        sums.start_window()
        velocity, pose = rows(self.state, "v_x", 2), rows(self.state, "x", 3)
        before, start = tables.moved @ velocity, pose.copy()
        sums.dead_load = rows(tables.hulls.weight, "x", 2).sum(axis=0)
        if self.sheet is not None:
            self.sheet.impulse[:] = 0.0
        if not self.blocks and self.sheet is None:
            return
        done = 0
        while done < n_substeps:
            done += self._substeps(n_substeps - done)
        sums.momentum_gain = tables.moved @ velocity - before
        if tables.thrust is not None:
            sums.thrust_work += float(np.vdot(tables.thrust, pose - start))
        if self.physics.filling_rate > 0.0:
            for block, flooded in zip(self.blocks, tables.hulls.flooded.tolist(), strict=True):
                block.flooded = flooded

    def _substeps(self, n: int) -> int:
        """Up to ``n`` sub-steps in one compiled call; fewer if a list must grow. Returns how many."""
        reader, tables, sheet = self._reader, self.tables, self.sheet
        self.sums.make_room(reader.capacity)
        self.space._bodies_to_check.clear()  # masses are positive by construction
        done: int = advance_substeps(
            n,
            self._steps,
            tables.bodies,
            tables.hulls,
            self.water,
            _NO_DRIVER if sheet is None else sheet.driver,
            self.meeting(),
            self.sums.for_kernels(None if sheet is None else sheet.nodes),
        )
        if done < 0:
            what = (
                f"{reader.count} pairs in contact at once, room for {reader.capacity}"
                if done == TOO_MANY
                else "contact with a body that is no block, sheet or structure"
            )
            raise RuntimeError(f"section at y = {self.y:g} m: {what}; take out blocks that overlap")
        if 2 * reader.count > reader.capacity:
            reader.reserve(4 * reader.capacity)
        return done

    def meeting(self) -> Meeting:
        """Who meets whom, for the kernels."""
        tables, handlers = self.tables, self._handlers
        return Meeting(
            self._reader.pairs, tables.slots, handlers.structure, handlers.faces, tables.lateral, tables.strength
        )

    def energy(self) -> Records:
        """Energy of the blocks now (1,), `losses.ENERGY` [J]."""
        p, tables, out = self.physics, self.tables, np.zeros(1, ENERGY)
        ground = Ground(p.g, self.water.rho_g, p.afloat)
        energy_now(tables.bodies, tables.lateral, tables.hulls, tables.mass, ground, out)
        return out

    def update_phases(self) -> None:
        """Phases of the blocks after a window, see `phases`."""
        tables, status = self.tables, self.tables.status
        if len(self.slopes) == 0 or status["sliding"].all():
            return  # without a slope nothing aligns
        if update_phases(self.slopes, tables.axes, self.state, self.sums.block, self.physics.align_tolerance, status):
            for block, row in zip(self.blocks, status, strict=True):
                block.aligned, block.sliding = bool(row["aligned"]), bool(row["sliding"])
