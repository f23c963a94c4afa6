"""All sections, and the slices in them: cut anew at the start of every window, entered and taken out where they change.

Within a window the set of slices stands; numbers of slices count in the order of pieces and sections.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from pymunk._chipmunk_cffi import ffi, lib

from rubble.arrays import Array, IntArray
from rubble.compiled import compiled
from rubble.cut import Cut, Solids
from rubble.gather import Sections
from rubble.moving import ASIDE
from rubble.phases import Slopes
from rubble.physics import RubblePhysics
from rubble.plates import Plates
from rubble.pointers import address, arbiter_layout, body_layout, set_corners
from rubble.section import STEP, Section, Slice, faces_of, list_address, space_address
from rubble.slices import CORNERS, Pieces, Slices, cut_piece, find_ranges
from rubble.slots import SHEET_SLOT, STRUCTURE_SLOT, Slots, slot_table
from rubble.store import Store

SET_CORNERS = address(ffi.addressof(lib, "cpPolyShapeSetVertsRaw"))
SAME = 1e-9  #: corners that have moved less are the same, in thicknesses
SLIVER = 1e-4  #: area of a slice, in thicknesses squared, below which it is none
NEIGHBOURS = 6  #: pairs of a slice for which there is room at once: convex outlines that lie close have three
KEYS = 1 << 20  #: more sections than there are
LAYOUTS = arbiter_layout(), body_layout()


class SectionTable:
    """Sections by number, and slices by piece and section."""

    def __init__(self, physics: RubblePhysics, pitch: float, origin: float, solids: Solids) -> None:
        self.physics, self.pitch, self.origin, self.solids = physics, pitch, origin, solids
        self.by_key: dict[int, Section] = {}
        self._made: dict[int, Slice] = {}  #: by piece and section
        self._names = np.zeros(0, np.int64)
        self.slices = _rows(0)
        self.changed = True  #: sections or sheets have come or gone
        self._aside = 0.0  #: how far the structure has gone along y [m]
        self._wide = False  #: see `widen`

    def section(self, key: int) -> Section:
        """The section with this number, made when first asked for."""
        if key not in self.by_key:
            y = self.origin + key * self.pitch
            own = Section(self.physics, self._cut(y), y, self.pitch)
            own.aside = self._aside
            self.by_key[key] = own
            self.by_key = dict(sorted(self.by_key.items()))
            self.changed = True
        return self.by_key[key]

    def go_aside(self, way: float) -> None:
        """The structure has gone so far along y [m]: where that is far for a section, it is cut anew."""
        if abs(way - self._aside) <= ASIDE * self.pitch:
            return
        self._aside = way
        self._cut_all_anew()

    def widen(self, wide: bool) -> None:
        """Whether a section shows a body of revolution where it is widest between the borders of the section.

        Blocks that keep their plane do not come to stand in it to the side of their middle.
        """
        if wide != self._wide:
            self._wide = wide
            self._cut_all_anew()

    def _cut_all_anew(self) -> None:
        self.changed = True
        for section in self.by_key.values():
            section.cut_anew(self._cut(section.y), self._aside)

    def _cut(self, y: float) -> Cut:
        """The structure in the plane y, or where it is widest beside it."""
        return self.widest(y) if self._wide else self.solids(y - self._aside)

    def widest(self, y: float) -> Cut:
        """A body of revolution where it is widest within half a section of the plane y."""
        y -= self._aside
        return self.solids(float(np.copysign(max(abs(y) - 0.5 * self.pitch, 0.0), y)))

    def in_use(self, store: Store) -> list[int]:
        """Numbers of the sections that the plates stand in now, ascending."""
        find_ranges(store.plates, store.tables.pieces, self.origin, self.pitch)
        return [int(k) for k in np.unique(_pairs(store.tables.pieces)[1])]

    def cut(self, store: Store) -> IntArray | None:
        """Cut all slices anew. Returns the new number of each old slice, -1 if it is gone; None if all are the same."""
        tables, h = store.tables, self.physics.thickness
        find_ranges(store.plates, tables.pieces, self.origin, self.pitch)
        piece, key = _pairs(tables.pieces)
        for k in np.unique(key).tolist():
            self.section(int(k))
        place = {k: i for i, k in enumerate(self.by_key)}
        section = np.array([place[k] for k in key.tolist()], np.int64)
        planes = np.array([s.y for s in self.by_key.values()])
        new = _rows(len(piece), piece, tables.pieces.plate[piece], section)
        areas = np.zeros(len(piece))
        _cut_all(store.plates, tables.pieces, new, planes, areas)
        keep = np.flatnonzero(areas > SLIVER * h * h)
        names = tables.pieces.number[piece] * KEYS + key + KEYS // 2
        order = keep[np.argsort(names[keep], kind="stable")]
        return self._enter(_chosen(new, order), names[order], store)

    def _enter(self, new: Slices, names: IntArray, store: Store) -> IntArray | None:
        """Slices come, go, or take on their new outline."""
        same = len(names) == len(self._names) and bool((names == self._names).all())
        old, numbers = self._names, None
        if not same:
            sections = list(self.by_key.values())
            for name in np.setdiff1d(old, names).tolist():
                self._made.pop(name).remove()
            for i in np.flatnonzero(~np.isin(names, old)).tolist():
                group, corners = store.list[new.plate[i]].id + 1, new.corners[i, : new.sides[i]]
                self._made[int(names[i])] = Slice(sections[new.section[i]], group, corners)
            numbers = np.searchsorted(names, old)
            numbers[~np.isin(old, names)] = -1
        made = [self._made[n] for n in names.tolist()] if not same or self.changed else []
        if made or not same:
            self._shapes = np.array([address(s.shape._shape) for s in made], np.int64)
            self._bodies = np.array([address(s.body._body) for s in made], np.int64)
        if len(names):
            before = self.slices if same else _rows(len(names))
            _set_outlines(
                new, before, self._shapes, SAME * self.physics.thickness, (SET_CORNERS, new.corners.ctypes.data)
            )
        new.body[:] = self._bodies if len(names) else []
        self.slices, self._names = new, names
        if not same or self.changed:
            self._look_up()
        self.changed = False
        return numbers

    def _look_up(self) -> None:
        """Tables by which kernels know sections and bodies."""
        sections = list(self.by_key.values())
        for section, own in zip(sections, np.bincount(self.slices.section, minlength=len(sections)), strict=True):
            if own * NEIGHBOURS > section.pairs.capacity:
                section.pairs.reserve(2 * NEIGHBOURS * int(own))
        still = [address(s.space.static_body._body) for s in sections]
        sheets = [s.sheet.address for s in sections if s.sheet is not None]
        bodies = np.concatenate([np.array(still + sheets, np.int64), self.slices.body])
        kinds = [STRUCTURE_SLOT] * len(still) + [SHEET_SLOT] * len(sheets)
        self.slots: Slots = slot_table(
            bodies, np.concatenate([np.array(kinds, np.int64), np.arange(len(self.slices.body))])
        )
        faces, offset = faces_of([s.cut.bearings for s in sections])
        self.slopes = Slopes(
            np.array([s.y for s in sections]), *faces_of([s.slopes for s in sections]), self.physics.align_tolerance
        )
        self.for_kernels = Sections(
            np.array([s.y for s in sections]),
            np.array([s.margin for s in sections]),
            np.array([space_address(s) for s in sections], np.int64),
            pairs=np.array([list_address(s) for s in sections], np.int64),
            aside=np.array([s.aside for s in sections]),
            faces=faces,
            offset=offset,
            step=STEP,
            arbiter=LAYOUTS[0],
            body=LAYOUTS[1],
        )

    def make_room(self) -> None:
        """Longer lists of pairs where they have become half full."""
        for section in self.by_key.values():
            if 2 * section.pairs.count > section.pairs.capacity:
                section.pairs.reserve(4 * section.pairs.capacity)

    def __getstate__(self) -> dict[str, Any]:
        gone = ("_made", "_names", "slices", "slots", "for_kernels", "slopes", "_shapes", "_bodies", "solids")
        return {k: v for k, v in self.__dict__.items() if k not in gone}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._made, self._names, self.slices, self.changed = {}, np.zeros(0, np.int64), _rows(0), True


def _pairs(pieces: Pieces) -> tuple[IntArray, IntArray]:
    """Pieces and the sections that meet them, one after the other."""
    first, last = pieces.range.T
    count = np.maximum(last - first + 1, 0)
    piece = np.repeat(np.arange(len(count)), count)
    start = np.repeat(np.cumsum(count) - count, count)
    return piece, first[piece] + np.arange(len(piece)) - start


def _chosen(slices: Slices, order: IntArray) -> Slices:
    """Some slices, in an order."""
    return Slices(**{name: column[order] for name, column in slices._asdict().items()})


def _rows(
    count: int, piece: IntArray | None = None, plate: IntArray | None = None, section: IntArray | None = None
) -> Slices:
    """Slices without outlines."""
    given = [np.zeros(count, np.int64) if a is None else a for a in (piece, plate, section)]
    return Slices(
        piece=given[0],
        plate=given[1],
        section=given[2],
        body=np.zeros(count, np.int64),
        y=np.zeros(count),
        anchor=np.zeros((count, 3)),
        sides=np.zeros(count, np.int64),
        corners=np.zeros((count, CORNERS, 2)),
        side=np.zeros((count, CORNERS, 2)),
        face=np.zeros((count, CORNERS, 3)),
    )


@compiled(nogil=True)
def _cut_all(plates: Plates, pieces: Pieces, slices: Slices, planes: Array, areas: Array) -> None:
    """Cut every slice in the plane of its section, or in the middle of a piece that it misses; their areas [m2]."""
    for s in range(slices.piece.shape[0]):
        i, k = slices.piece[s], slices.plate[s]
        y, r = planes[slices.section[s]], plates.rotation[k]
        cut_piece(plates, pieces, slices, s, y)
        if slices.sides[s] < 3 and pieces.range[i, 0] == pieces.range[i, 1]:
            cut_piece(plates, pieces, slices, s, plates.position[k, 1] + r[1, 1] * pieces.y[i])
        c = slices.corners[s]
        for a in range(slices.sides[s]):
            b = (a + 1) % slices.sides[s]
            areas[s] += 0.5 * (c[a, 0] * c[b, 1] - c[b, 0] * c[a, 1])


@compiled(nogil=True)
def _set_outlines(new: Slices, old: Slices, shapes: IntArray, same: float, at: tuple[int, int]) -> None:
    """Give pymunk's shapes the corners that have moved; ``at``: addresses of its function and of the corners."""
    for s in range(shapes.shape[0]):
        moved = new.sides[s] != old.sides[s]
        for c in range(new.sides[s]):
            for d in range(2):
                moved = moved or abs(new.corners[s, c, d] - old.corners[s, c, d]) > same
        if moved:
            set_corners(at[0], shapes[s], new.sides[s], at[1] + 16 * CORNERS * s)
