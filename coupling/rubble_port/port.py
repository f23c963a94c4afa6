"""The rubble as a participant: blocks load the structure and the sheet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from coupling.interface import (
    NS,
    Array,
    BlockTable,
    Event,
    ForcePairs,
    Fragment,
    HandOver,
    IntArray,
    Phase,
    Restore,
    SheetEdge,
    SheetForces,
    Structure,
)
from coupling.rubble_port.edges import sheets
from coupling.rubble_port.events import told
from coupling.rubble_port.failing import failing
from coupling.rubble_port.hand_over import Arrivals
from rubble import snapshot
from rubble.cut import Bearing, Cut, faceted
from rubble.domain import Domain
from rubble.energy import energy_terms
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics

#: of the structure's cut by a section, in thicknesses: 1 mm for ice of 3 m, whose normal is right within 0.6 degrees
OUTLINE_TOLERANCE = 1.0 / 3000.0


@dataclass(frozen=True)
class Saved:
    """The rubble at the end of a window."""

    layer: bytes  #: see `rubble.snapshot`
    edges: dict[int, SheetEdge]
    compliance: Array  #: (2, k, k) of these edges [m/N]
    forces: SheetForces
    fragments: int
    born: Array  #: (2,) energy of all blocks when they were born [J]


class RubblePort:
    """Sections of `rubble.layer`, fed with fragments and with the sheet's edge: a `RubbleParticipant`."""

    def __init__(
        self,
        structure: Structure,
        physics: RubblePhysics,
        *,
        pitch: float,
        origin: float,
        domain: Domain,
    ):
        """``pitch`` and ``origin``: width of a section and y of section 0 [m]."""
        bottom, top = max(structure.bottom, -domain.depth), structure.top
        tolerance = OUTLINE_TOLERANCE * physics.thickness

        def solids(y: float) -> Cut:
            def bearing(x: float, z: float) -> Bearing:
                constant, radial = structure.bearing(x, y, z)
                return Bearing(float(constant), float(radial))

            return faceted(convex_parts(*structure.section(y, bottom, top, tolerance)), bearing)

        self.layer = RubbleLayer(
            physics,
            pitch,
            origin=origin,
            solids=solids,
            generator=structure.generator(bottom, top),
            domain=domain,
        )
        self.physics = physics
        self.lockstep = False  #: windows are met step by step (`begin`, `meet`, `end`)
        self.structure = structure
        self.on_crushed: Callable[[float], None] = _ignore  #: is told the mass that blocks lose in a window [kg]
        self._edges: dict[int, SheetEdge] = {}
        self._compliance = np.zeros((2, 0, 0))
        self._forces = SheetForces.none()
        self._crushed = 0.0  #: mass when the window began [kg]
        self._arrivals = Arrivals(physics)

    def add(self, fragment: Fragment) -> HandOver:
        """Turns a fragment into blocks where and as it moves now."""
        return self._arrivals.add(self.layer, fragment)

    def set_structure(self, place: Array, velocity: Array) -> None:
        """Where the structure is when the coming window begins, and how it moves; see `RubbleParticipant`."""
        self.layer.set_structure(place, velocity)

    @property
    def on_structure(self) -> Array:
        """Mean load of the blocks on the structure over the last window, with its moment (6,) [N], [N m]."""
        return self.layer.wrench_on_structure

    def sections_in_use(self) -> dict[int, float]:
        """Sections that hold blocks or are next to one, and x of the rearmost block: where the sheet must be known."""
        keys = sorted({k + side for k in self.layer.sections_in_use() for side in (-1, 0, 1)})
        return dict.fromkeys(keys, self.layer.rear)

    def set_sheet(self, edges: dict[int, SheetEdge], carried: SheetForces, compliance: Array) -> None:
        """The sheet's edges for the coming window; ``carried`` are the forces that it already answers to in them."""
        self._set_edges(edges, carried)
        self._compliance = compliance

    def _set_edges(self, edges: dict[int, SheetEdge], carried: SheetForces) -> None:
        for key in set(self._edges) - set(edges):
            self.layer.remove_sheet(key)
        self._edges = edges
        self.layer.set_sheets(list(edges), sheets(list(edges.values()), carried, self.physics.thickness))

    def begin(self, edges: dict[int, SheetEdge]) -> None:
        """A window in lockstep begins."""
        self._set_edges(dict(sorted(edges.items())), SheetForces.none())
        self.layer.set_yields([], None)
        self._crushed = self.layer.crushed.mass
        self.layer.begin()

    def meet(self, nodes: Array) -> Array:
        """One sub-step against the nodes of the edges; forces on them (m, 3) [N]."""
        with failing():
            return self.layer.meet(nodes)

    def end(self) -> None:
        """The window ends."""
        with failing():
            self.layer.end()
        self._take_stock()

    def advance(self, window_ns: int) -> None:
        """Moves all blocks over a window and sums their impulses on the sheet."""
        self._crushed, n = self.layer.crushed.mass, round(window_ns / NS / self.physics.substep)
        yields = self._compliance / (n * self.physics.substep) ** 2  # see `rubble.sheet`
        self.layer.set_yields(list(self._edges), yields)
        with failing():
            self.layer.advance(n)
        self._take_stock()

    def _take_stock(self) -> None:
        if self.layer.crushed.mass > self._crushed:
            self.on_crushed(self.layer.crushed.mass - self._crushed)
        self.take_forces()

    def take_forces(self) -> None:
        """Reads the mean forces on the sheet's nodes over the last window off the layer."""
        nodes: list[IntArray] = [e.nodes for e in self._edges.values()]
        if not nodes:
            self._forces = SheetForces.none()
            return
        f = np.concatenate([self.layer.sheet_forces(key) for key in self._edges])
        on = np.flatnonzero(f.any(axis=1))
        self._forces = SheetForces(np.concatenate(nodes)[on], f[on])

    def forces_on_sheet(self) -> SheetForces:
        """Mean forces over the last window."""
        return self._forces

    @property
    def power(self) -> float:
        """Mean power of these forces on the edges as the rubble saw them move [W]."""
        return self.layer.power_on_sheet

    def save(self) -> Restore:
        """The rubble between two windows; this run goes on from the copy as well (`rubble.snapshot`)."""
        a = self._arrivals
        saved = Saved(
            snapshot.save(self.layer), self._edges, self._compliance, self._forces, a.fragments, a.born.copy()
        )
        restore = partial(self._restore, saved)
        restore()
        return restore

    def _restore(self, saved: Saved) -> None:
        """Sets the rubble back; a window from here has the same bits as the first one from here."""
        self.layer = snapshot.restore(saved.layer, self.layer)
        self._edges, self._compliance, self._forces = saved.edges, saved.compliance, saved.forces
        self._arrivals.fragments, self._arrivals.born = saved.fragments, saved.born.copy()

    def blocks(self) -> BlockTable:
        """All blocks at the end of the window."""
        columns = self.layer.columns()
        sliding, _ = columns.pop("sliding"), columns.pop("spin")
        return BlockTable(phase=np.where(sliding, Phase.SLIDING, Phase.ROTATING).astype(np.int64), **columns)

    def events(self, t_ns: int, load: Array) -> list[Event]:
        """Plates that have broken again in the last window."""
        return [told(t_ns, load, b) for b in self.layer.breaks]

    def load(self) -> Array:
        """Mean force of the blocks on the structure over the last window, (3, 3): rows by `Phase` [N]."""
        parts = {Phase.ROTATING: self.layer.load_of(sliding=False), Phase.SLIDING: self.layer.load_of(sliding=True)}
        return np.array([parts.get(phase, np.zeros(3)) for phase in Phase])

    @property
    def budget(self) -> ForcePairs:
        """What carries the blocks, and minus their force on the sheet; see `coupling.budget`."""
        terms = {name: (float(f[0]), float(f[1])) for name, f in self.layer.budget.items()}
        x, _, z = (-self._forces.force.sum(axis=0)).tolist()
        return {**terms, "staggering": (x, z)}

    @property
    def mass(self) -> float:
        """True mass of all blocks that are followed [kg]."""
        return self.layer.mass

    @property
    def cleared_mass(self) -> float:
        """Mass of all blocks that have left [kg]."""
        return self.layer.gone.mass

    @property
    def energy(self) -> dict[str, float]:
        """Energy of the blocks by term [J]; see `rubble.energy`."""
        kinetic, potential = self._arrivals.born
        terms = energy_terms(self.layer)
        if self.lockstep:
            terms["meeting_work"] = terms.pop("sheet_work")
        return {**terms, "born_kinetic": float(kinetic), "born_potential": float(potential)}

    @property
    def momenta(self) -> dict[str, float]:
        """Momentum that ice took along which was cleared, and off blocks crushed [N s]."""
        lost = {"cleared": self.layer.gone.momentum, "crushed": self.layer.crushed.momentum}
        return {f"{name}_momentum_{axis}": float(p[k]) for name, p in lost.items() for k, axis in enumerate("xyz")}


def _ignore(mass: float) -> None:
    """Nobody keeps books."""
