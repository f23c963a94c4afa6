"""The rubble as a participant: fragments become blocks, blocks load the structure and the sheet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from coupling.budget import Pairs
from coupling.handover import BlockBirth, births, centre_of, momenta_of
from coupling.interface import NS, Array, BlockTable, Fragment, IntArray, Phase, SheetEdge, SheetForces, SimulationError
from coupling.structure import Structure
from rubble import snapshot
from rubble.block import Block, Slab, energy_of
from rubble.cut import Cut, plane, revolved
from rubble.domain import Domain
from rubble.energy import energy_terms
from rubble.geometry import area_moments, contiguous
from rubble.initial import Pile, rest, settle
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.sheet import SheetMotion

OUTLINE_TOLERANCE = 0.001  #: of the structure's cut by a section [m]: its normal is right within 0.6 degrees
LID = 1e9  #: stiffness of the still sheet under which initial rubble settles [N/m]
SMALLEST = 1e-3  #: share of h^2 below which what is left of a trimmed block counts as crushed


@dataclass(frozen=True)
class HandOver:
    """Balance of one fragment: what left the lattice and what arrived."""

    blocks: int
    mass: float  #: of the fragment, without what was crushed before [kg]
    trimmed: float  #: cut off because it lay inside the structure, crushed [kg]
    momentum_error: float  #: of the blocks' momentum in the layer against that of the same ice in the sheet, relative
    angular_momentum_error: float = 0.0  #: the same about the fragment's centre of mass, in the x-z plane
    angular_momentum_change: float = 0.0  #: part of it that goes because a block has its mass in its body, not at nodes


@dataclass(frozen=True)
class Saved:
    """The rubble at the end of a window."""

    layer: bytes  #: see `rubble.snapshot`
    edges: dict[int, SheetEdge]
    forces: SheetForces
    fragments: int
    born: Array  #: (2,) energy of all blocks when they were born [J]


class RubblePort:
    """Sections of `rubble.layer`, fed with fragments and with the sheet's edge."""

    def __init__(
        self,
        structure: Structure,
        physics: RubblePhysics,
        *,
        pitch: float,
        origin: float,
        columns_per_section: int,
        domain: Domain,
        threads: int = 1,
    ):
        """``pitch`` and ``origin``: width of a section and y of section 0 [m]."""
        bottom, top = max(structure.bottom, -domain.depth), structure.top

        def solids(y: float) -> Cut:
            outline = structure.section_outline(y, bottom, top, OUTLINE_TOLERANCE)
            if structure.revolved:
                return revolved(convex_parts(outline))
            return plane(convex_parts(outline, back=float(outline[:, 0].max()) + 100.0))

        self.layer = RubbleLayer(physics, pitch, origin=origin, solids=solids, domain=domain, threads=threads)
        self.physics, self.columns_per_section = physics, columns_per_section
        self.structure = structure
        self.on_crushed: Callable[[float], None] = _ignore  #: is told the mass that blocks lose in a window [kg]
        self._edges: dict[int, SheetEdge] = {}
        self._forces = SheetForces.none()
        self._fragments = 0
        self._born = np.zeros(2)  #: kinetic energy, and that of weight and water, of all blocks when they were born [J]

    def add(self, fragment: Fragment) -> HandOver:
        """Turns a fragment into blocks where and as it moves now."""
        about, mass = centre_of(fragment), float(fragment.mass.sum())
        (left, scale), arrived, changed = momenta_of(fragment, about), np.zeros(4), np.zeros(4)
        trimmed, count = mass, 0
        for birth in births(fragment, self.columns_per_section):
            block = self._place(birth)
            changed += birth.momenta(about)
            if block is not None:
                arrived, changed = arrived + _momenta(block, about), changed - _as_born(block, birth, about)
                trimmed, count = trimmed - block.mass, count + 1
        self._fragments += 1
        error = np.abs(arrived + changed - left) / np.maximum(scale, 1e-9)
        return HandOver(
            count, mass, trimmed, float(error[:3].max()), float(error[3]), float(abs(changed[3]) / max(scale[3], 1e-9))
        )

    def _place(self, b: BlockBirth) -> Block | None:
        """Puts one block into its section, outside the structure; None if nothing is left of it."""
        key = self.layer.key_at(b.y)
        polygon = self.layer.trim(b.polygon, key) if b.mass > 0.0 else np.empty((0, 2))
        if len(polygon) < 3 or area_moments(contiguous(polygon)).area < SMALLEST * self.physics.thickness**2:
            return None
        slab = Slab(polygon, b.cuts, b.widths, self.physics.rho_i, b.angle)
        number = self.layer.add_block(
            key, slab, b.velocity.tolist(), b.omega, y=b.y, fragment=self._fragments, alone=False
        )
        block = self.layer.block(number)
        self._born += energy_of(block, self.physics)
        return block

    def front_sections(self) -> list[int]:
        """Sections in whose middle plane the structure stands in the ice's way at the waterline."""
        half = float(self.structure.radius(0.0)) if self.structure.revolved else self.layer.domain.y_max
        keys = range(self.layer.key_at(-half), self.layer.key_at(half) + 1)
        return [k for k in keys if abs(self.layer.centre(k)) < half]

    def fill(self, volume: float, seed: int, edges: dict[int, SheetEdge]) -> Pile:
        """Initial rubble: ``volume`` [m^3] settled in the sections of ``edges``, under a still sheet."""
        self._hold(edges)
        return self._settled(lambda: settle(self.layer, self._fronts(edges), volume, seed))

    def rest(self, edges: dict[int, SheetEdge]) -> Pile:
        """Initial rubble comes to rest once more, under a sheet that has moved."""
        self._hold(edges)
        return self._settled(lambda: rest(self.layer, self._fronts(edges)))

    def _hold(self, edges: dict[int, SheetEdge]) -> None:
        self.set_sheet(
            {
                k: replace(
                    e,
                    velocity=np.zeros_like(e.velocity),
                    stiffness=(LID, LID),
                    inertia=(self.physics.sheet_mass, self.physics.sheet_mass),
                )
                for k, e in edges.items()
            },
            self._forces,
        )

    def _settled(self, pile: Callable[[], Pile]) -> Pile:
        try:
            settled = pile()
        except RuntimeError as error:
            raise SimulationError(str(error)) from error
        self._forces = self._on_sheet()
        return settled

    def _fronts(self, edges: dict[int, SheetEdge]) -> dict[int, tuple[float, float]]:
        """X of the structure's face at the sheet's underside, or of the sheet's front, and z of the underside [m]."""
        under = {k: float(e.z[0]) - 0.5 * e.thickness for k, e in edges.items()}
        face = {k: float(self.structure.face_x(self.layer.centre(k), under[k])) for k in edges}
        return {k: (min(face[k], e.front), under[k]) for k, e in edges.items() if np.isfinite(face[k])}

    def sections_in_use(self) -> list[int]:
        """Sections that hold blocks or are next to one: those that must know where the sheet is."""
        return sorted({k + side for k, s in self.layer.sections.items() if s.blocks for side in (-1, 0, 1)})

    def set_sheet(self, edges: dict[int, SheetEdge], carried: SheetForces) -> None:
        """The sheet's edges for the coming window; ``carried`` are the forces that it already answers to in them."""
        for key in set(self._edges) - set(edges):
            self.layer.remove_sheet(key)
        self._edges = edges
        for key, e in edges.items():
            applied = _on_edge(carried, e)
            self.layer.set_sheet(
                key, SheetMotion(e.x, e.z, e.front, e.velocity, e.thickness, e.stiffness, e.inertia, applied)
            )

    def advance(self, window_ns: int) -> None:
        """Moves all blocks over a window and sums their impulses on the sheet."""
        crushed = self.layer.crushed.mass
        try:
            self.layer.advance(round(window_ns / NS / self.physics.substep))
        except RuntimeError as error:
            raise SimulationError(str(error)) from error
        if self.layer.crushed.mass > crushed:
            self.on_crushed(self.layer.crushed.mass - crushed)
        self._forces = self._on_sheet()

    def _on_sheet(self) -> SheetForces:
        """Mean forces on the sheet's nodes over the last window."""
        nodes: list[IntArray] = [e.nodes for e in self._edges.values()]
        if not nodes:
            return SheetForces.none()
        f = np.concatenate([self.layer.sheet_forces(key) for key in self._edges])
        on = np.flatnonzero(f.any(axis=1))
        force = np.column_stack((f[:, 0], np.zeros(len(f)), f[:, 1]))
        return SheetForces(np.concatenate(nodes)[on], force[on])

    def forces_on_sheet(self) -> SheetForces:
        """Mean forces over the last window."""
        return self._forces

    @property
    def power(self) -> float:
        """Mean power of these forces on the edges as the rubble saw them move [W]."""
        return self.layer.power_on_sheet

    def save(self) -> Saved:
        """The rubble between two windows, for `restore`; this run goes on from the copy as well (`rubble.snapshot`)."""
        saved = Saved(snapshot.save(self.layer), self._edges, self._forces, self._fragments, self._born.copy())
        self.restore(saved)
        return saved

    def restore(self, saved: Saved) -> None:
        """Sets the rubble back; a window from here has the same bits as the first one from here."""
        self.layer = snapshot.restore(saved.layer, self.layer)
        self._edges, self._forces, self._fragments = saved.edges, saved.forces, saved.fragments
        self._born = saved.born.copy()

    def blocks(self) -> BlockTable:
        columns = self.layer.columns()
        sliding = columns.pop("sliding")
        return BlockTable(phase=np.where(sliding, Phase.SLIDING, Phase.ROTATING).astype(np.int64), **columns)

    def load(self) -> Array:
        """Mean force of the blocks on the structure over the last window, (3, 3): rows by `Phase` [N]."""
        parts = {Phase.ROTATING: self.layer.load_of(sliding=False), Phase.SLIDING: self.layer.load_of(sliding=True)}
        return np.array([parts.get(phase, np.zeros(3)) for phase in Phase])

    @property
    def budget(self) -> Pairs:
        """What carries the blocks, and minus their force on the sheet; see `coupling.budget`."""
        terms = {name: (float(f[0]), float(f[1])) for name, f in self.layer.budget.items()}
        x, z = terms.pop("on_sheet")
        return {**terms, "staggering": (-x, -z)}

    @property
    def mass(self) -> float:
        return self.layer.mass

    @property
    def cleared_mass(self) -> float:
        return self.layer.gone.mass

    @property
    def energy(self) -> dict[str, float]:
        """Energy of the blocks by term [J]; see `rubble.energy`."""
        return {
            **energy_terms(self.layer),
            "born_kinetic": float(self._born[0]),
            "born_potential": float(self._born[1]),
        }

    @property
    def momenta(self) -> dict[str, float]:
        """Momentum that ice took along which was cleared, and off blocks crushed [N s]."""
        lost = {"cleared": self.layer.gone.momentum, "crushed": self.layer.crushed.momentum}
        return {f"{name}_momentum_{axis}": float(p[k]) for name, p in lost.items() for k, axis in enumerate("xyz")}


class NoRubble:
    """Breaking only: fragments are taken away and counted as cleared."""

    def __init__(self) -> None:
        self.mass, self.cleared_mass, self.power = 0.0, 0.0, 0.0
        self.budget: Pairs = {}
        self.energy: dict[str, float] = {}
        self.momenta: dict[str, float] = {}

    def add(self, fragment: Fragment) -> HandOver:
        mass = float(fragment.mass.sum())
        self.cleared_mass += mass
        return HandOver(0, mass, 0.0, 0.0)

    def sections_in_use(self) -> list[int]:
        return []

    def save(self) -> float:
        """All there is to remember: what has been taken away."""
        return self.cleared_mass

    def restore(self, saved: float) -> None:
        self.cleared_mass = saved

    def set_sheet(self, edges: dict[int, SheetEdge], carried: SheetForces) -> None:
        """Nothing is there to meet the sheet."""

    def advance(self, window_ns: int) -> None:
        """Nothing moves."""

    def forces_on_sheet(self) -> SheetForces:
        return SheetForces.none()

    def blocks(self) -> BlockTable:
        return BlockTable.empty()

    def load(self) -> Array:
        return np.zeros((3, 3))


def _on_edge(forces: SheetForces, edge: SheetEdge) -> tuple[float, float]:
    """Sum of the forces on one edge, in x and z [N]."""
    total = forces.force[np.isin(forces.nodes, edge.nodes)].sum(axis=0)
    return float(total[0]), float(total[2])


def _momenta(block: Block, about: Array) -> Array:
    """Momentum x, y, z of a block and angular momentum about a point in the x-z plane, as it moves (4,)."""
    v = block.body.velocity
    p = block.mass * np.array([v.x, block.v_y, v.y])
    arm = np.array(block.body.position) - about
    return np.array([*p, arm[0] * p[2] - arm[1] * p[0] + block.prism.inertia * block.body.angular_velocity])


def _as_born(block: Block, birth: BlockBirth, about: Array) -> Array:
    """The same for the ice of a block, where it is, with the motion of its nodes (4,)."""
    p, arm = block.mass * birth.velocity, np.array(block.body.position) - about
    return np.array([*p, arm[0] * p[2] - arm[1] * p[0] + block.prism.inertia * birth.omega])


def _ignore(mass: float) -> None:
    """Nobody keeps books."""
