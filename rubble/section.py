"""One vertical section parallel to the drift: a pymunk space in (x, z) with blocks, structure and sheet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pymunk

from rubble.arbiters import ContactReader
from rubble.block import Block
from rubble.contacts import HEAVY_COLUMNS, SUM_COLUMNS
from rubble.friction import SHEET_SLOT, STRUCTURE, STRUCTURE_SLOT, PairFriction, slot_table
from rubble.geometry import Array, contiguous, exposed_edges, nearest_edges, overlap_area
from rubble.lateral import ACROSS
from rubble.losses import STOCK, WORK, stock
from rubble.phases import ROTATING, update_phases
from rubble.physics import RubblePhysics
from rubble.pointers import address, body_offsets
from rubble.sheet import STRUCTURE_CATEGORY, SheetBody
from rubble.space import Solid, new_space
from rubble.stepping import STEP, read_bodies, run
from rubble.trim import cut_away
from rubble.water import EDGE_COLUMNS, SHARES, STATE_COLUMNS, WATER_SUMS

_BODY = body_offsets()
HEAVY = 64  #: overloaded pairs kept in a window


class Section:
    """Blocks, structure and sheet in the plane y; blocks are kept in the order of their numbers."""

    def __init__(self, physics: RubblePhysics, solids: Sequence[Array], y: float, revolved: bool = False) -> None:
        self.physics, self.y, self.revolved = physics, y, revolved
        self.space = new_space(physics)
        self.solids = [contiguous(s) for s in solids]
        self.faces = exposed_edges(self.solids)  #: (e, 4) outer edges of the structure
        run, rise = self.faces[:, 2] - self.faces[:, 0], self.faces[:, 3] - self.faces[:, 1]
        self.slopes = np.ascontiguousarray(self.faces[rise < -0.1 * np.hypot(run, rise)])  #: those that meet the drift
        self.blocks: list[Block] = []
        self.sheet: SheetBody | None = None
        #: see `water.WATER_SUMS`; and, for the last window alone, the impulses of the water's SHARES [N s]
        self.losses = np.zeros(WATER_SUMS + SHARES)
        self.momentum_gain = np.zeros(2)  #: of the blocks with added mass over the last window, x and z [N s]
        self.dead_load = np.zeros(2)  #: weight and constant thrust of the blocks in the last window, x and z [N]
        self.work, self.across_work = np.zeros(WORK), np.zeros(ACROSS)  #: see `losses`, `lateral`
        self.thrust_work = 0.0  #: [J]
        self.sheet_sums = np.zeros(8)  #: see `contacts.accumulate`
        self.heavy = np.zeros((HEAVY + 1, HEAVY_COLUMNS))
        self.water = np.array(
            [
                physics.rho_w * physics.g,
                physics.rho_w / 2,
                physics.form_drag,
                physics.skin_drag,
                physics.substep,
                physics.backfill_level,
                physics.filling_rate,
            ]
        )
        for solid in self.solids:
            self._add_solid(solid)
        self._connect()

    def _connect(self) -> None:
        """What holds addresses: made anew after a snapshot has been loaded."""
        self._reader, self._space = ContactReader(), address(self.space._space)
        self._friction = PairFriction(self.space, self.physics, self.revolved, self.y, self._reader)
        self.changed()

    def __getstate__(self) -> dict[str, Any]:
        own = {k: v for k, v in self.__dict__.items() if k not in _ADDRESSES | _TABLES}
        return {**own, "sums": self.sums.copy()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._connect()
        self.sums[:] = state["sums"]

    def _add_solid(self, solid: Array) -> None:
        self.space.add(
            Solid(self.space.static_body, solid, self.physics.restitution**0.5, STRUCTURE, STRUCTURE_CATEGORY)
        )

    # ---- blocks and sheet -------------------------------------------------------------------------------------

    def trim(self, polygon: Array) -> Array:
        """What is left of a convex outline outside the structure, convex; (0, 2) if nothing is."""
        return cut_away(contiguous(polygon), self.solids, self.faces)

    def add(self, block: Block, *, alone: bool = True) -> None:
        """Take in a block; ValueError if it stands inside the structure or, if ``alone``, inside another block."""
        inside, room = overlap_area(block.outline, self.solids), 2 * self.physics.slop * np.sqrt(block.prism.area)
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

    def set_sheet(
        self,
        x: Array,
        z: Array,
        front: float,
        velocity: Array,
        thickness: float,
        stiffness: tuple[float, float],
        inertia: tuple[float, float],
        applied: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Where the sheet is at the start of a window; see `SheetBody.follow`."""
        if self.sheet is None:
            self.sheet = SheetBody(self.space, self.physics, x, z, velocity)
            self.changed()
        self.sheet.follow(x, z, front, velocity, thickness, stiffness, inertia, applied)

    def remove_sheet(self) -> None:
        """Take the sheet out of the section."""
        if self.sheet is not None:
            self.sheet.remove()
            self.sheet = None
            self.changed()

    # ---- tables of the kernels --------------------------------------------------------------------------------

    def changed(self) -> None:
        """Lay out the tables of the kernels anew after bodies have come, gone or changed."""
        blocks, g = self.blocks, self.physics.g
        edges = [b.prism.edges for b in blocks]
        self._edges = np.ascontiguousarray(np.concatenate(edges) if edges else np.zeros((0, EDGE_COLUMNS)))
        self._offset = np.cumsum([0, *(len(e) for e in edges)], dtype=np.int64)
        dead = [(b.thrust[0], b.thrust[1] - b.mass * g, b.thrust[2]) for b in blocks]
        self._dead = np.array(dead, dtype=np.float64).reshape(-1, 3)
        limit = self.physics.contact_strength * self.physics.substep, 2.0 * self.physics.slop
        widths = [b.prism.width for b in blocks]
        self._limit = np.array([*limit, limit[0] * limit[1] * min(widths, default=0.0), *widths])
        moving = [b.body for b in blocks] + ([self.sheet.body] if self.sheet is not None else [])
        self._bodies = np.array([address(body._body) for body in moving], np.int64)
        slots = [*range(len(blocks)), SHEET_SLOT][: len(moving)]
        self._addresses, self._slots = slot_table(
            [address(self.space.static_body._body), *self._bodies.tolist()], [STRUCTURE_SLOT, *slots]
        )
        outlines = [b.prism.polygon for b in blocks]
        self.polygons = np.concatenate([np.zeros((0, 2)), *outlines])  #: corners of all blocks in their body frames
        self.corners = np.cumsum([0, *map(len, outlines)], dtype=np.int64)
        self.moved = np.array([b.body.mass for b in blocks], np.float64)  #: mass with added mass [kg]
        self._mass = np.array([b.mass for b in blocks], np.float64)
        self._thrust = np.array([b.thrust for b in blocks], np.float64).reshape(-1, 3)
        self._pressure = np.array([b.pressure for b in blocks], np.float64).reshape(-1, 3)
        #: y and v_y (2, n), and mean force on the structure over the last window (n, 3) [N]; the blocks have views
        self.side = np.ascontiguousarray(np.array([b.across for b in blocks], np.float64).reshape(-1, 2).T)
        self.load = np.array([b.load for b in blocks], np.float64).reshape(-1, 3)
        for i, block in enumerate(blocks):
            block.across, block.load, block.pressure = self.side[:, i], self.load[i], self._pressure[i]
        self._flooded = np.array([b.flooded for b in blocks], np.float64)
        #: see `phases.update_phases`
        self.axes = np.array(
            [
                (b.prism.reach + self.physics.thickness, b.prism.long_axis, np.pi if b.prism.slender else np.pi / 2)
                for b in blocks
            ],
            np.float64,
        ).reshape(-1, 3)
        self.status = np.array([(b.aligned, b.phase) for b in blocks], np.int64).reshape(-1, 2)
        self.sums = np.zeros((len(blocks), SUM_COLUMNS))
        self._state = np.zeros((len(moving), STATE_COLUMNS))  #: of blocks and sheet, current inside the kernels
        read_bodies(self._bodies, _BODY, self._state)
        self.state = self._state[: len(blocks)].copy()  #: of the blocks, in their order
        self._friction.watch(self._addresses, self._slots, self._state, len(blocks), self.side)

    # ---- motion -----------------------------------------------------------------------------------------------

    def advance(self, n_substeps: int) -> None:
        """Move on by whole sub-steps; sums of impulses start from zero."""
        self.sums[:] = self.sheet_sums[:] = self.losses[-SHARES:] = 0.0
        self.heavy[0, 0] = 0.0
        self.dead_load, before = self._dead[:, :2].sum(axis=0), self.moved @ self.state[:, 3:5]
        if self.sheet is not None:
            self.sheet.nodes[:, 2:] = 0.0
        if not self.blocks and self.sheet is None:
            return
        done, start = 0, self.state
        while done < n_substeps:
            done += self._run(n_substeps - done)
        self.state = self._state[: len(self.blocks)].copy()
        self.momentum_gain = self.moved @ self.state[:, 3:5] - before
        if self._thrust.any():
            self.thrust_work += float(np.vdot(self._thrust, self.state[:, :3] - start[:, :3]))
        if self.physics.filling_rate > 0.0:
            for block, share in zip(self.blocks, self._flooded.tolist(), strict=True):
                block.flooded = share

    def _run(self, n: int) -> int:
        """Up to ``n`` sub-steps in one compiled call; fewer if the list of pairs must grow. Returns how many."""
        reader, sheet = self._reader, self.sheet
        spring, driver, nodes = (sheet.spring, sheet.driver, sheet.nodes) if sheet else (_NO, _NO, _NO_NODES)
        self.space._bodies_to_check.clear()  # masses are positive by construction
        done = run(
            n,
            self.physics.substep,
            STEP,
            self._space,
            self._bodies,
            _BODY,
            self._state,
            self._edges,
            self._offset,
            self._dead,
            self.water,
            self._flooded,
            self.losses,
            spring,
            driver,
            reader.header,
            reader.pairs,
            reader.layout,
            self._addresses,
            self._slots,
            self._friction.structure,
            self.side,
            self._limit,
            self.sheet_sums,
            self.sums,
            nodes,
            self.heavy,
            self._pressure,
            self.work,
        )
        if done < 0:
            what = (
                f"{reader.header[0]} pairs in contact at once, room for {reader.capacity}"
                if done == -1
                else "contact with a body that is no block, sheet or structure"
            )
            raise RuntimeError(f"section at y = {self.y:g} m: {what}; take out blocks that overlap")
        if 2 * reader.header[0] > reader.capacity:
            reader.reserve(4 * reader.capacity)
        return done

    def stock(self) -> Array:
        """Energy of the blocks now, see `losses.STOCK` [J]."""
        out = np.zeros(STOCK)
        stock(
            self._bodies,
            _BODY,
            self.state,
            self.side,
            self._edges,
            self._offset,
            self._mass,
            self.water[0],
            self.physics.g,
            self.physics.afloat,
            out,
        )
        return out

    def update_phases(self) -> None:
        """Phases of the blocks after a window, see `phases`."""
        if len(self.slopes) == 0 or not (self.status[:, 1] == ROTATING).any():
            return  # without a slope nothing aligns
        slopes = nearest_edges(self.slopes, self.state)
        if update_phases(slopes, self.axes, self.state, self.sums, self.physics.align_tolerance, self.status):
            for block, (aligned, phase) in zip(self.blocks, self.status.tolist(), strict=True):
                block.aligned, block.phase = bool(aligned), phase


_NO, _NO_NODES = np.zeros(0), np.zeros((0, 4))
_ADDRESSES = {"_reader", "_space", "_friction", "_bodies", "_addresses", "_slots", "_state"}
#: laid out anew from the blocks by `changed`
_TABLES = {
    "_edges",
    "_offset",
    "_dead",
    "_limit",
    "polygons",
    "corners",
    "moved",
    "side",
    "load",
    "_flooded",
    "axes",
    "status",
    "state",
}
