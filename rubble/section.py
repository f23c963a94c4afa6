"""One vertical section parallel to the drift: a pymunk space in (x, z) with blocks, structure and sheet.

Settings that change loads: collision persistence 1 (reported impulses = momentum balance), slop a small share of the
thickness, a constant sub-step, the first 16 shape ids unused (contacts of a pair among the first shapes would share a
hash and lose their history), no gravity: weight and water act as forces, so that added mass can stand in the mass.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pymunk
from pymunk import batch
from pymunk._chipmunk_cffi import ffi

from rubble.block import Block
from rubble.contacts import SHEET, STRUCTURE, SUM_COLUMNS, ContactReader, IntArray, accumulate
from rubble.geometry import Array, contiguous, cut_away, exposed_edges, nearest_angles, overlap_area, place
from rubble.physics import RubblePhysics
from rubble.sheet import STRUCTURE_CATEGORY, SheetBody
from rubble.stepping import Calls, run
from rubble.water import EDGE_COLUMNS, STATE_COLUMNS

_F = batch.BodyFields
_GET = _F.BODY_ID | _F.POSITION | _F.ANGLE | _F.VELOCITY | _F.ANGULAR_VELOCITY
_SET = _F.FORCE | _F.TORQUE


def new_space(physics: RubblePhysics) -> pymunk.Space:
    """A space with the settings of a load simulation."""
    space = pymunk.Space()
    space.collision_persistence = 1
    space.collision_slop = physics.slop
    space.iterations = int(physics.iterations)
    unused = [pymunk.Circle(space.static_body, 1.0) for _ in range(16)]
    space.add(*unused)
    space.remove(*unused)
    return space


class Section:
    """Blocks, structure and sheet in the plane y; blocks are kept in the order of their numbers."""

    def __init__(self, physics: RubblePhysics, solids: Sequence[Array], y: float) -> None:
        self.physics, self.y = physics, y
        self.space = new_space(physics)
        self.solids = [contiguous(s) for s in solids]
        self.faces = exposed_edges(self.solids)  #: (e, 4) outer edges of the structure
        run, rise = self.faces[:, 2] - self.faces[:, 0], self.faces[:, 3] - self.faces[:, 1]
        self.slopes = np.ascontiguousarray(self.faces[rise < -0.1 * np.hypot(run, rise)])  #: those that meet the drift
        self.blocks: list[Block] = []
        self.sheet: SheetBody | None = None
        self.losses = np.zeros(3)  #: energy lost to drag [J]; impulse of weight and water in x and z [N s]
        self.sheet_sums = np.zeros(8)  #: see `contacts.accumulate`
        self.sums = np.zeros((0, SUM_COLUMNS))
        self.state = np.zeros((0, STATE_COLUMNS))  #: of the blocks, in their order
        self._reader, self._buffer, self._out = ContactReader(), batch.Buffer(), batch.Buffer()
        self._water = np.array([physics.rho_w * physics.g, physics.rho_w / 2, physics.form_drag, physics.skin_drag,
                                physics.substep])
        self._add_structure()
        self._changed()

    def _add_structure(self) -> None:
        for solid in self.solids:
            shape = pymunk.Poly(self.space.static_body, [(float(x), float(z)) for x, z in solid])
            shape.friction = self.physics.mu_structure / self.physics.mu_ice_ice**0.5
            shape.elasticity = self.physics.restitution**0.5
            shape.filter = pymunk.ShapeFilter(categories=STRUCTURE_CATEGORY)
            self.space.add(shape)

    def trim(self, polygon: Array) -> Array:
        """What is left of a convex outline outside the structure, convex; (0, 2) if nothing is."""
        return cut_away(contiguous(polygon), self.solids, self.faces)

    def add(self, block: Block) -> None:
        """Take in a block; ValueError if it stands inside the structure."""
        inside = self.overlap_with_structure(block)
        if inside > 2 * self.physics.slop * np.sqrt(block.area):
            x, z = block.body.position
            raise ValueError(f"block {block.id} at x = {x:.3f}, z = {z:.3f} m overlaps the structure by {inside:.3g} "
                             "m2; trim its outline first")
        self.adopt(block)

    def adopt(self, block: Block) -> None:
        """Take in a block that comes from another section, as it is."""
        self.space.add(block.body, block.shape)
        self.blocks = sorted([*self.blocks, block], key=lambda b: b.id)
        self._changed()

    def overlap_with_structure(self, block: Block) -> float:
        """Area that a block shares with the structure [m^2]."""
        (x, z), angle = block.body.position, block.body.angle
        return overlap_area(place(block.polygon, x, z, angle, 0.0, 0.0), self.solids)

    def in_the_way(self, block: Block) -> tuple[float, Block | None]:
        """What stands where a block of another section would be: how deep it would be in it [m], and the block it is.

        None in place of the block for structure, sheet or free room.
        """
        block.shape.cache_bb()
        number: dict[pymunk.Shape | None, Block] = {b.shape: b for b in self.blocks}
        found = [(max((-p.distance for p in info.contact_point_set.points), default=0.0), number.get(info.shape))
                 for info in self.space.shape_query(block.shape) if info.shape is not None]
        return max(found, key=lambda f: (f[0], f[1].id if f[1] else -1), default=(0.0, None))

    def take(self, block: Block) -> None:
        """Take a block out of the section."""
        self.space.remove(block.shape, block.body)
        self.blocks = [b for b in self.blocks if b is not block]
        self._changed()

    def set_sheet(self, x: Array, z: Array, front: float, velocity: Array, thickness: float,
                  stiffness: tuple[float, float], applied: tuple[float, float] = (0.0, 0.0)) -> None:
        """Where the sheet is at the start of a window; see `SheetBody.follow`."""
        if self.sheet is None:
            self.sheet = SheetBody(self.space, self.physics, x, z, velocity)
            self._changed()
        self.sheet.follow(x, z, front, velocity, thickness, stiffness, applied)

    def remove_sheet(self) -> None:
        """Take the sheet out of the section."""
        if self.sheet is not None:
            self.sheet.remove()
            self.sheet = None
            self._changed()

    def _changed(self) -> None:
        """Lay out the tables of the kernels anew after bodies have come or gone."""
        edges = [b.edges for b in self.blocks]
        self._edges = np.ascontiguousarray(np.concatenate(edges) if edges else np.zeros((0, EDGE_COLUMNS)))
        self._offset = np.cumsum([0, *(len(e) for e in edges)], dtype=np.int64)
        self._weight = np.array([b.mass * self.physics.g for b in self.blocks])
        self._ids = [b.body.id for b in self.blocks]
        bodies = [_address(self.space.static_body), *(_address(b.body) for b in self.blocks)]
        slots = [STRUCTURE, *range(len(self.blocks))]
        if self.sheet is not None:
            bodies, slots = [*bodies, _address(self.sheet.body)], [*slots, SHEET]
        order = np.argsort(bodies)
        self._addresses, self._slots = np.array(bodies, np.int64)[order], np.array(slots, np.int64)[order]
        self._order_seen = np.zeros(0, np.uintp)
        self.sums = np.zeros((len(self.blocks), SUM_COLUMNS))
        self.state = self._pose_table()

    def _pose_table(self) -> Array:
        rows = [(*b.body.position, b.body.angle, *b.body.velocity, b.body.angular_velocity) for b in self.blocks]
        return np.array(rows, dtype=np.float64).reshape(-1, STATE_COLUMNS)

    def _read_state(self) -> Array:
        """State rows of all bodies in pymunk's own order; the map from blocks to rows follows that order."""
        self._buffer.clear()
        batch.get_space_bodies(self.space, _GET, self._buffer)
        order = np.frombuffer(self._buffer.int_buf(), np.uintp)
        if not np.array_equal(order, self._order_seen):
            self._order_seen = order.copy()
            row = {int(n): i for i, n in enumerate(order)}
            self._row: IntArray = np.array([row[n] for n in self._ids], dtype=np.int64)
            self._sheet_row = row[self.sheet.body.id] if self.sheet is not None else -1
            self._force = np.zeros((len(order), 3))
            self._out.set_float_buf(self._force)
            self._calls = Calls(self.space, self._buffer, _GET, self._out, _SET)
        return np.frombuffer(self._buffer.float_buf(), np.float64).reshape(-1, STATE_COLUMNS)

    def advance(self, n_substeps: int) -> None:
        """Move on by whole sub-steps; sums of impulses start from zero."""
        self.sums[:] = 0.0
        self.sheet_sums[:] = 0.0
        if self.sheet is not None:
            self.sheet.nodes[:, 2:] = 0.0
        if not self.blocks and self.sheet is None:
            return
        done = 0
        while done < n_substeps:
            done += self._run(n_substeps - done)
        self.state = self._read_state()[self._row]

    def _run(self, n: int) -> int:
        """Up to ``n`` sub-steps in one compiled call; fewer if the table of contacts had to grow. Returns how many."""
        state, reader, sheet = self._read_state(), self._reader, self.sheet
        spring, driver, nodes = (sheet.spring, sheet.driver, sheet.nodes) if sheet else (_NO, _NO, _NO_NODES)
        self.space._bodies_to_check.clear()  # masses are positive by construction
        done = run(n, self.physics.substep, self._calls.table, reader.header, state, self._force, self._row,
                   self._edges, self._offset, self._weight, self._water, self.losses, self._sheet_row, spring, driver,
                   reader.bodies, reader.values, self._addresses, self._slots, self.sheet_sums, self.sums, nodes)
        strange = done < 0
        if 0 <= done < n:  # the contacts of this sub-step did not fit: enlarge, read and add them
            count = reader.read(self.space)
            strange = accumulate(count, reader.bodies, reader.values, self._addresses, self._slots, self.sheet_sums,
                                 self.sums, nodes) > 0
            done += 1
        if strange:
            raise RuntimeError(f"section at y = {self.y:g} m: contact with a body that is no block, sheet or structure")
        return done

    def slope_angles(self) -> Array:
        """Angle of the face that meets the drift and is nearest to each block (n,), from the x axis [rad]; or nan."""
        return nearest_angles(self.slopes, self.state) if len(self.slopes) else np.full(len(self.blocks), np.nan)


_NO, _NO_NODES = np.zeros(0), np.zeros((0, 4))


def _address(body: pymunk.Body) -> int:
    return int(ffi.cast("intptr_t", body._body))
