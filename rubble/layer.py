"""All rubble: rigid plates, the sections in which their contacts are found, and what has left.

Section ``key`` is the plane ``y = origin + key pitch``; it stands for the ice within half a pitch of it. It comes to be
when first used. Nothing is deleted: plates that have passed the structure or left the domain are counted as cleared,
with mass and momentum.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from rubble.arrays import Array, rows
from rubble.breaking import Break
from rubble.cut import Solids, open_water
from rubble.domain import Domain
from rubble.geometry import contiguous, overlap_area
from rubble.joints import no_joints
from rubble.lost import Lost
from rubble.moving import moved_cut, stand
from rubble.physics import RubblePhysics
from rubble.piece import Plate, Slab, Start, one_piece
from rubble.prism import Prism
from rubble.readings import Readings
from rubble.round import closed
from rubble.section import Section
from rubble.sections import SectionTable
from rubble.sheet import IMPULSE, MEETS, MET, SheetBody, SheetMotion, Sheets
from rubble.shore import follow
from rubble.store import Store
from rubble.trim import cut_away
from rubble.window import NO_BODY, Runner


class RubbleLayer(Readings):
    """Plates in sections ``pitch`` apart; ``solids(y)`` gives the structure in the plane y.

    ``generator`` (k, 2): heights, ascending, and radii of the structure if it is a body of revolution about the z axis.
    """

    def __init__(
        self,
        physics: RubblePhysics,
        pitch: float,
        *,
        origin: float = 0.0,
        solids: Solids = open_water,
        generator: Array | None = None,
        domain: Domain | None = None,
    ) -> None:
        if not (isfinite(pitch) and pitch > 0):
            raise ValueError(f"section pitch is {pitch:g} m; a section needs a width > 0")
        self.physics, self.pitch, self.origin = physics, pitch, origin
        self.domain = domain or Domain()
        self.store = Store(physics, pitch)
        self.table_of_sections = SectionTable(physics, pitch, origin, solids)
        self.runner = Runner(physics, NO_BODY if generator is None else closed(generator))
        self.joints = no_joints()
        self.cleared: list[int] = []  #: numbers of the plates that have left, in order
        self.gone = Lost()  #: what they took along
        self.parting = np.zeros((2, 3))  #: mean force of those that left in the last window, rotating and sliding [N]
        self.crushed = Lost()  #: what was cut off plates
        self.breaks: list[Break] = []  #: in the last window
        self.time = 0.0  #: [s]

    def connect_like(self, other: RubbleLayer) -> None:
        """Takes the structure from the layer of which this one is a copy."""
        self.table_of_sections.solids = other.table_of_sections.solids

    @property
    def sections(self) -> dict[int, Section]:
        """All sections so far, in the order of their numbers."""
        return self.table_of_sections.by_key

    def section(self, key: int) -> Section:
        """The section with this number, made when first asked for."""
        return self.table_of_sections.section(key)

    def sections_in_use(self) -> list[int]:
        """Sections whose plane cuts a plate, or that hold one that none cuts, ascending."""
        return self.table_of_sections.in_use(self.store)

    def centre(self, key: int) -> float:
        """Y of a section's plane [m]."""
        return self.origin + key * self.pitch

    def trim(self, polygon: Array, section: int) -> Array:
        """What is left of an outline (k, 2) outside the structure in a section, convex; (0, 2) if nothing is.

        A piece is as wide as its section: in a body of revolution it stands deepest at the side nearer to the axis.
        """
        own = self.section(section)
        cut = self.table_of_sections.widest(own.y) if len(self.runner.body) else own.cut
        return moved_cut(lambda outline: cut_away(contiguous(outline), cut), self.runner.moving, own.y, polygon)

    def add_block(
        self,
        section: int,
        slab: Slab,
        velocity: Sequence[float] = (0.0, 0.0),
        omega: float = 0.0,
        *,
        y: float | None = None,
        fragment: int = 0,
        flooded: float | None = None,
        alone: bool = True,
    ) -> int:
        """Make a plate of one piece from ice in a section; returns its number.

        ``velocity`` (x, z) or (x, y, z) [m/s], ``omega`` [rad/s]; ``y`` is the middle of the section if not given [m].
        ``flooded`` is the part of the head of water that its top carries, by default as `RubblePhysics.backfill` has it
        for a new piece. ValueError if it stands in the structure or, unless ``alone`` is False, in another plate.
        """
        at = self.centre(section) if y is None else y
        prisms, start = one_piece(slab, at, velocity, omega)
        plate = self._make(fragment, prisms, start, flooded)
        self._check_room(plate, self.section(section), alone=alone)
        self.store.add(plate)
        return plate.id

    def add_plate(
        self, prisms: Sequence[tuple[Prism, Array]], start: Start, *, fragment: int = 0, flooded: float | None = None
    ) -> int:
        """Make a plate of prisms at places (3,) in its axes; returns its number."""
        plate = self._make(fragment, prisms, start, flooded)
        self.store.add(plate)
        return plate.id

    def try_plate(self, prisms: Sequence[tuple[Prism, Array]], start: Start) -> Plate:
        """The plate that `add_plate` would make, without adding it."""
        return self._make(-1, prisms, start, None)

    def _make(self, fragment: int, prisms: Sequence[tuple[Prism, Array]], start: Start, flooded: float | None) -> Plate:
        full = float(self.physics.backfill == "full") if flooded is None else float(flooded)
        return self.store.make(fragment, prisms, start, full)

    def _check_room(self, plate: Plate, section: Section, *, alone: bool) -> None:
        outline, y = plate.outline, float(plate.position[1])
        inside = overlap_area(outline, section.cut.polygons)
        room = 2 * self.physics.slop * np.sqrt(plate.pieces[0].prism.area)
        where = f"block {plate.id} at x = {plate.position[0]:.3f}, z = {plate.position[2]:.3f} m"
        if inside > room:
            raise ValueError(f"{where} overlaps the structure by {inside:.3g} m2; trim its outline first")
        for other in self.store.list if alone else []:
            beside = abs(other.position[1] - y) >= 0.5 * (other.width + plate.width) * (1.0 - 1e-9)
            if not beside and (shared := overlap_area(outline, [other.outline])) > room:
                raise ValueError(f"{where} overlaps block {other.id} by {shared:.3g} m2; move one of them")

    def block(self, number: int) -> Plate:
        """The plate with this number; KeyError if it has left."""
        for plate in self.store.list:
            if plate.id == number:
                return plate
        raise KeyError(number)

    def set_sheet(self, section: int, motion: SheetMotion) -> None:
        """Where the sheet is in a section at the start of a window, and how it moves."""
        self.set_sheets([section], Sheets.of(motion))

    def set_sheets(self, keys: Sequence[int], sheets: Sheets) -> None:
        """The same of several sections at once."""
        bodies = []
        for own in map(self.section, keys):
            if own.sheet is None:
                own.sheet = SheetBody(own.space)
                self.table_of_sections.changed = True
            bodies.append(own.sheet)
        follow(bodies, sheets, self.physics.slop / 2)

    def remove_sheet(self, section: int) -> None:
        """The lattice has no ice in this section any more."""
        own = self.sections.get(section)
        if own is not None and own.sheet is not None:
            own.sheet.remove()
            own.sheet = None
            self.table_of_sections.changed = True

    def set_structure(self, place: Array, velocity: Array) -> None:
        """Displacement (6,) of a structure that moves at the start of a window, and velocity (6,) over it."""
        stand(self.runner.moving, place, velocity)
        self.table_of_sections.go_aside(float(place[1]))

    def set_yields(self, keys: Sequence[int], yields: Array | None) -> None:
        """How the sheet's edges in these sections yield to impulses on each of them (2, k, k), x and z [1/kg].

        None: sheet and rubble go in lockstep, see `meet`.
        """
        known = dict(zip(keys, range(len(keys)), strict=True))
        self.runner.yields = None if yields is None else (known, np.asarray(yields, np.float64))

    def meet(self, nodes: Array) -> Array:
        """One sub-step of a window that has begun, in lockstep with the sheet; mean forces on its nodes (m, 3) [N].

        ``nodes`` (m, 11): what `sheet.MEETS` names, of all sections with a sheet, in their order, front first.
        """
        known = rows(self.runner.edges.nodes)
        if nodes.shape != (len(known), len(MEETS)):
            raise ValueError(f"sheet: {len(known)} nodes were given when the window began, now {len(nodes)}")
        known[:, MET], impulse = nodes, known[:, IMPULSE]
        before = impulse.copy()
        self._go(1)
        return np.asarray((impulse - before) / self.physics.substep)

    def begin(self) -> None:
        """A window begins, of which `meet` does the sub-steps."""
        self.runner.begin(self.store, self.table_of_sections, self.joints)

    def end(self) -> None:
        """It ends."""
        self.runner.end(self.store, self.table_of_sections)
        self.runner.after(self.store, self.table_of_sections, self.time)
        self.breaks = self.runner.break_and_wear(self.store, self.crushed)
        self._clear()

    def set_water(self, form_drag: float, current: tuple[float, float]) -> None:
        """Another C_d and velocity of the water for a while: initial rubble settles sooner in water thick and still."""
        x, y = current
        self.runner.water = self.runner.water._replace(form_drag=form_drag, current_x=x, current_y=y)

    def advance(self, n_substeps: int) -> None:
        """Move all plates on by a window of whole sub-steps; then count what has left."""
        if n_substeps < 1:
            raise ValueError(f"a window of {n_substeps} sub-steps; give at least 1")
        self.begin()
        self._go(n_substeps)
        self.end()

    def _go(self, n: int) -> None:
        self.runner.go(n)
        self.time += n * self.physics.substep

    def _clear(self) -> None:
        x, y, z = self.store.plates.position[:-1].T
        place = self.runner.moving.place
        inside = self.domain.holds(x - place[0], y - place[1], z)
        self.parting = np.zeros((2, 3))
        if inside.all():
            return
        out, load = [self.store.list[i] for i in np.flatnonzero(~inside)], self.load_on_structure[~inside]
        for plate, force in zip(out, load, strict=True):
            self.parting[int(plate.sliding)] += force
            self.cleared.append(plate.id)
            self.gone.take(plate.mass, plate.momentum, self.runner.energy_of(plate))
        self.store.take(*out)
