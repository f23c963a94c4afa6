"""A window of the rubble: what the compiled loop needs, and what is known when it has run."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from rubble.arrays import Array, IntArray, Known
from rubble.books import BOOKS, GROUND, SHIFT
from rubble.breaking import Break, Breaking, part
from rubble.edges import Edges
from rubble.gather import Scene
from rubble.halves import FEW, halves
from rubble.joints import Joints
from rubble.lost import Lost
from rubble.moving import resting
from rubble.neighbours import Neighbours, no_neighbours
from rubble.phases import update_phases
from rubble.physics import RubblePhysics
from rubble.piece import Plate
from rubble.plates import kinetic
from rubble.rows import Rows, grown, room, surface_of
from rubble.sections import SectionTable
from rubble.shore import Yields, edges_of, keep
from rubble.slots import ROUND_SLOT
from rubble.stepping import Sums, Window, advance_substeps
from rubble.store import Store
from rubble.team import ALONE, CREW, Team
from rubble.water import WATER_IMPULSE, potential, water_of
from rubble.wear import find_bites, take_off

NO_BODY = np.zeros((0, 2))  #: the structure is none of revolution


class Run(NamedTuple):
    """A window that has begun."""

    window: Window
    scene: Scene
    sums: Sums
    momentum: Array  #: (3,) with added mass, at its start [N s]
    on_sheet: float  #: work of plates on the sheet so far [J]
    ground: Array  #: (6,) momenta from the sea bed so far


class Runner:
    """Runs windows; keeps what goes on from one to the next: rows of the last sub-step, pressure, books."""

    def __init__(self, physics: RubblePhysics, body: Array) -> None:
        self.physics, self.water = physics, water_of(physics)
        self.body = body  #: the structure as a body of revolution, see `gather.Scene`
        #: how edges yield, by the number of their section; None: sheet and rubble go in lockstep
        self.yields: Yields | None = ({}, np.zeros((2, 0, 0)))
        self.books, self.water_impulse = np.zeros(1, BOOKS), np.zeros(1, WATER_IMPULSE)
        self.momenta = np.zeros((4, 6))  #: that plates received since the start, see `books`
        self.bed = -physics.depth  #: height of the sea bed [m]
        self.planar = False  #: plates move in their x-z plane only, while initial rubble settles
        self.window = 0.0  #: length of the last one [s]
        self._rows: tuple[Rows, Rows] = room(4096), room(4096)
        self._halves = halves(4096)
        self._counted = np.zeros(3, np.int64)
        self._neighbours = Neighbours(physics.thickness)
        self._pressure = Known(np.zeros(0, np.int64), np.zeros((0, 6)))  #: of plates by number, see `Sums`
        self.budget: dict[str, Array] = {}
        self.power_on_sheet = 0.0
        self.breaking, self.moving = Breaking(physics), resting()
        self.broken = 0.0  #: energy that plates have lost by breaking again [J]
        self.edges: Edges
        self._run: Run

    def __getstate__(self) -> dict[str, Any]:
        """Between two windows: without the one that has ended, which holds addresses of what is made anew."""
        return {k: v for k, v in vars(self).items() if k not in ("_run", "edges")}

    @property
    def contacts(self) -> int:
        """Points of contact in the last sub-step."""
        return int(self._counted[0])

    def advance(self, store: Store, sections: SectionTable, joints: Joints, n: int) -> None:
        """Do a window of ``n`` sub-steps."""
        self.begin(store, sections, joints)
        self.go(n)
        self.end(store, sections)

    def begin(self, store: Store, sections: SectionTable, joints: Joints) -> None:
        """A window begins: slices are cut anew, sums are empty."""
        renamed = sections.cut(store)
        if renamed is not None:
            self._rename(renamed)
        tables, plates = store.tables, store.plates
        tables.sums[:] = 0.0
        self.water_impulse[:] = self.moving.wrench[:] = 0
        self.edges = edges_of(sections, self.yields)
        scene = self._scene(store, sections, self.edges)
        sides, banks = no_neighbours() if self.planar else self._neighbours.find(scene)
        window = Window(
            iterations=int(self.physics.iterations),
            surface=surface_of(self.physics),
            water=self.water,
            hulls=tables.hulls,
            thrust=tables.thrust,
            sides=sides,
            banks=banks,
            joints=joints,
            loaded=self.breaking.begin(store),
            planar=self.planar,
        )
        pressure = self._pressure.of(tables.told.ids, np.nan)
        sums = Sums(tables.sums, self.books, self.water_impulse, pressure, self.momenta, self._counted)
        momentum, on_sheet = plates.moved[:-1] @ plates.velocity[:-1, :3], float(self.books["on_sheet"][0])
        self._run = Run(window, scene, sums, momentum, on_sheet, self.momenta[GROUND].copy())
        self.window = 0.0

    def go(self, n: int) -> None:
        """Do ``n`` sub-steps of the window that has begun. RuntimeError if their contacts cannot be found."""
        done, run = 0, self._run
        while done < n:
            step = self._together(n - done, run)
            if step < 0:
                raise RuntimeError(f"rubble: {WRONG[step]} in a sub-step; take out blocks that overlap")
            done += step
            self._make_room()
        self.window += n * self.physics.substep

    def _together(self, n: int, run: Run) -> int:
        """As `advance_substeps`, on two threads where the physics asks for them and the pile is large."""

        def go(team: Team) -> Any:
            return advance_substeps(team, n, run.window, run.scene, *self._rows, self._halves, run.sums)

        alone = self.physics.threads == 1 or self.contacts < FEW
        return int(go(ALONE) if alone else CREW.run(go, self.physics.threads, 0))

    def end(self, store: Store, sections: SectionTable) -> None:
        """The window ends."""
        run = self._run
        sections.make_room()
        keep(sections, self.edges)
        self._pressure = Known(store.tables.told.ids, run.sums.pressure)
        self.power_on_sheet = (float(self.books["on_sheet"][0]) - run.on_sheet) / self.window
        self._balance(store, run)

    def break_and_wear(self, store: Store, crushed: Lost) -> list[Break]:
        """Parts the plates that break at the end of the window, and takes crushed ice off; not while rubble settles."""
        if self.planar:
            return []
        rows, breaks = self._rows[int(self._counted[1]) % 2], list[Break]()
        bites = find_bites(store, rows, self.contacts, self._run.scene.slices)
        pairs: list[tuple[Plate, list[Plate]]] = []
        for plate, worst in self.breaking.end(store, self._run.window.loaded, self.window):
            found = part(store, plate, worst)
            if found is not None:
                pairs.append((plate, found[0]))
                breaks.append(found[1])
                self.broken += self.energy_of(plate) - sum(self.energy_of(p) for p in found[0])
        self.momenta[SHIFT] += store.replace(pairs)
        self.momenta[SHIFT] += take_off(store, bites, self.energy_of, crushed)
        return breaks

    def _scene(self, store: Store, sections: SectionTable, edges: Edges) -> Scene:
        p, slices = self.physics, sections.slices
        width, known = store.tables.pieces.width[slices.piece], sections.for_kernels
        if self.planar:  # faces of the structure look along the drift
            faces = known.faces.copy()
            faces["constant"] = faces["radial"] = 0.0
            known = known._replace(faces=faces)
        strength, shortest = p.contact_strength * p.substep, 2.0 * p.slop
        return Scene(
            plates=store.plates,
            slices=slices,
            sections=known,
            slots=sections.slots,
            edges=edges,
            dt=p.substep,
            pitch=sections.pitch,
            widths=width,
            pieces=store.tables.pieces,
            strength=strength,
            shortest=shortest,
            cut=int(self._counted[1]) + 1,
            bed=self.bed,
            moving=self.moving,
            body=NO_BODY if self.planar else self.body,
        )

    def _rename(self, new: IntArray) -> None:
        """Slices have new numbers; rows of slices that are gone are no first guess any more."""
        for rows in self._rows:
            of_slices = rows.point["slot_a"] != ROUND_SLOT
            for end in ("slot_a", "slot_b"):
                old = rows.point[end]
                on = of_slices & (old >= 0) & (old < len(new))
                old[on] = np.where(new[old[on]] >= 0, new[old[on]], -5)

    def _make_room(self) -> None:
        if 2 * int(self._counted[0]) > len(self._rows[0].point):
            larger = 4 * len(self._rows[0].point)
            self._rows = grown(self._rows[0], larger), grown(self._rows[1], larger)
            self._halves = halves(larger)

    def _balance(self, store: Store, run: Run) -> None:
        """Mean forces x and z that carry the plates."""
        w, T, tables = self.water_impulse, self.window, store.tables
        gain = store.plates.moved[:-1] @ store.plates.velocity[:-1, :3] - run.momentum
        pair = {n: np.array([float(w[f"{n}_x"][0]), float(w[f"{n}_z"][0])]) / T for n in ("flooded", "dry", "drag")}
        self.budget = {
            "flooded_rubble": pair["flooded"] + tables.hulls.weight.sum(axis=0)[[0, 2]],
            "dry_tops": pair["dry"],
            "drag": pair["drag"],
            "inertia": -gain[[0, 2]] / T,
        }
        if np.isfinite(self.bed):
            self.budget["sea_bed"] = (self.momenta[GROUND] - run.ground)[[0, 2]] / T

    def after(self, store: Store, sections: SectionTable, time: float) -> None:
        """What follows from a window: phases of the plates. RuntimeError if a motion is not finite."""
        finite = np.isfinite(store.plates.velocity[:-1]).all(axis=1)
        if not finite.all():
            number = store.list[int(np.argmin(finite))].id
            raise RuntimeError(f"block {number}, t = {time:g} s: its motion is not finite; shorten rubble.substep")
        t, slices, slopes = store.tables, sections.slices, sections.slopes
        update_phases(store.list, store.plates, t.axes, t.sums, slices, slopes, self.moving)

    def energies(self, store: Store) -> tuple[float, Array]:
        """Kinetic energy of all plates with added mass, and that of weight and water of each (n,) [J]."""
        p, out = self.physics, np.zeros(len(store.list))
        potential(store.plates, store.tables.hulls, store.tables.mass, self.water, p.g, p.afloat, out)
        return float(kinetic(store.plates)), out

    def energy_of(self, plate: Plate) -> float:
        """Kinetic energy of a plate, and its energy of weight and water [J]."""
        return sum(self.parts_of(plate))

    def parts_of(self, plate: Plate) -> tuple[float, float]:
        """The same apart."""
        alone = Store(self.physics, np.inf)
        held = plate.rows, plate.row
        alone.add(plate)
        moving, resting = self.energies(alone)
        plate.rows, plate.row = held
        return moving, float(resting[0])


WRONG = {-1: "too many pairs in contact at once", -2: "contact with an unknown body", -3: "too many contacts at once"}
