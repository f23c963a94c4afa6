"""One vertical section parallel to the drift: a pymunk space in (x, z) in which contacts are found."""

from __future__ import annotations

from typing import Any

import numpy as np
import pymunk
from pymunk._chipmunk_cffi import ffi, lib

from rubble.arbiters import PairList, note_pair
from rubble.arrays import Array, Records, filled
from rubble.cut import FACE, Cut
from rubble.physics import RubblePhysics
from rubble.pointers import address
from rubble.sheet import ICE, STRUCTURE_CATEGORY, SheetBody

STRUCTURE = 2  #: collision type of the structure
ANY_OVERLAP = 1e9  #: slop of the spaces [m]: pymunk itself pushes nothing apart
STEP = address(ffi.addressof(lib, "cpSpaceStep"))


class Slice:
    """What a section sees of a piece: a body that is put where the piece is, and its outline."""

    def __init__(self, section: Section, group: int, corners: Array) -> None:
        """``group`` is that of its plate, whose slices do not meet each other."""
        self.section = section
        self.body = pymunk.Body(1.0, float("inf"))
        self.shape = pymunk.Poly(self.body, corners.tolist())
        self.shape.collision_type, self.shape.filter = ICE, pymunk.ShapeFilter(group=group)
        section.space.add(self.body, self.shape)

    def remove(self) -> None:
        """Take it out of its section."""
        self.section.space.remove(self.shape, self.body)


class Section:
    """Structure and sheet in the plane y, and the slices that meet them."""

    def __init__(self, physics: RubblePhysics, cut: Cut, y: float, pitch: float) -> None:
        self.physics, self.cut, self.y = physics, cut, y
        self.aside = 0.0  #: way along y of the structure for which this is the cut [m]
        #: by so much pymunk sees the structure thicker than it is [m]: half a section to the side, a face that leads
        #: out of the plane by less than 45 degrees stands by less than this in front of the one in the plane
        self.margin = 0.5 * pitch if cut.bearings["constant"].any() or cut.bearings["radial"].any() else 0.0
        self.slopes = cut.slopes
        self.sheet: SheetBody | None = None
        self.pairs = PairList()
        self.connect()

    def connect(self) -> None:
        """A new space with the structure in it; slices and sheet come afterwards."""
        self.space = _new_space()
        self._stand()
        data = self.pairs.list.ctypes.data
        for a, b in ((ICE, ICE), (ICE, STRUCTURE)):
            handler = lib.cpSpaceAddCollisionHandler(self.space._space, a, b)
            handler.postSolveFunc = ffi.cast("cpCollisionPostSolveFunc", note_pair.address)
            handler.userData = ffi.cast("void *", data)
        if self.sheet is not None:
            self.sheet.enter(self.space)

    def _stand(self) -> None:
        """The structure's shapes as they are cut."""
        for solid in self.cut.polygons:
            shape = pymunk.Poly(self.space.static_body, solid.tolist(), radius=self.margin)
            shape.collision_type = STRUCTURE
            shape.filter = pymunk.ShapeFilter(categories=STRUCTURE_CATEGORY)
            self.space.add(shape)

    def cut_anew(self, cut: Cut, aside: float) -> None:
        """The structure has gone along y by ``aside`` [m]."""
        self.space.remove(*[s for s in self.space.shapes if s.body is self.space.static_body])
        self.cut, self.slopes, self.aside = cut, cut.slopes, aside
        self._stand()

    def __getstate__(self) -> dict[str, Any]:
        kept = {k: v for k, v in self.__dict__.items() if k not in ("space", "pairs")}
        return kept | {"room": self.pairs.capacity}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.pairs = PairList(state.pop("room"))
        self.__dict__.update(state)
        self.connect()


def _new_space() -> pymunk.Space:
    """An empty space that finds contacts and moves nothing.

    The first 16 shape ids stay unused: contacts of a pair among the first shapes would share a hash.
    """
    space = pymunk.Space()
    space.collision_persistence, space.collision_slop, space.iterations = 1, ANY_OVERLAP, 1
    unused = [pymunk.Circle(space.static_body, 1.0) for _ in range(16)]
    space.add(*unused)
    space.remove(*unused)
    return space


def space_address(section: Section) -> int:
    """Where pymunk keeps the space."""
    return address(section.space._space)


def list_address(section: Section) -> int:
    """Where the list of pairs stands."""
    return int(section.pairs.list.ctypes.data)


def faces_of(faces: list[Records]) -> tuple[Any, Any]:
    """Faces of all sections one after the other, and where those of each begin."""
    return np.concatenate([filled(FACE, []), *faces]), np.cumsum([0, *map(len, faces)], dtype=np.int64)
