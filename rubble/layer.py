"""All rubble: sections side by side, blocks that move between them, and what has left.

Section ``key`` is the slice ``|y - (origin + key pitch)| <= pitch / 2``; it comes to be when first used. In a window
sections do not know of each other, so threads change no bit of the result. Between windows blocks move sideways
(`lateral`); one that crosses into the next section goes there with its motion, if there is room for it. Otherwise it
waits at the border and pushes the ice next door (plastic impact: both go on with their common speed). Nothing is
deleted: blocks that have passed the structure or left the domain are counted as cleared, with mass and momentum.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from math import floor, hypot, inf, isfinite, pi

import numpy as np

from rubble.block import ROTATING, SLIDING, Block, make_block
from rubble.contacts import IntArray
from rubble.geometry import Array, moments, place, submerged
from rubble.lateral import push, side_step
from rubble.physics import RubblePhysics
from rubble.section import Section

Solids = Callable[[float], Sequence[Array]]  #: convex polygons of the structure in the plane y
Ratio = Callable[[float, float, float], float]  #: Fy / Fx of the normal force at (y, x, z)


def no_solids(y: float) -> Sequence[Array]:
    """Open water."""
    return ()


def no_ratio(y: float, x: float, z: float) -> float:
    """A structure without side force: a plane slope."""
    return 0.0


@dataclass(frozen=True)
class Domain:
    """Where blocks are followed; beyond it they are cleared [m]."""

    x_max: float = inf  #: downstream limit
    x_min: float = -inf
    depth: float = inf  #: greatest depth
    y_max: float = inf  #: greatest distance from the middle plane

    def holds(self, x: float, y: float, z: float) -> bool:
        """Whether a centre of mass is inside."""
        return self.x_min <= x <= self.x_max and abs(y) <= self.y_max and z >= -self.depth


@dataclass(frozen=True, slots=True)
class Table:
    """All blocks as arrays, in the order of their numbers; meanings and units as in `coupling.interface.BlockTable`."""

    id: IntArray
    fragment: IntArray
    section: IntArray
    phase: IntArray
    mass: Array
    width: Array
    position: Array
    angle: Array
    velocity: Array
    omega: Array
    load: Array
    outline: Array
    offset: IntArray


class RubbleLayer:
    """Blocks in sections of width ``pitch``; ``solids(y)`` gives the structure, ``ratio`` its side force."""

    def __init__(self, physics: RubblePhysics, pitch: float, *, origin: float = 0.0, solids: Solids = no_solids,
                 ratio: Ratio = no_ratio, domain: Domain | None = None, threads: int = 1) -> None:
        if not pitch > 0:
            raise ValueError(f"section pitch is {pitch:g} m; it must be > 0")
        self.physics, self.pitch, self.origin = physics, pitch, origin
        self.solids, self.ratio, self.domain = solids, ratio, domain or Domain()
        self.sections: dict[int, Section] = {}
        self.cleared: list[int] = []  #: numbers of the blocks that have left, in order
        self.cleared_mass = 0.0  #: [kg]
        self.cleared_momentum = np.zeros(3)  #: true mass times velocity at leaving [N s]
        self.time = 0.0  #: [s]
        self._loads: dict[int, tuple[float, float, float]] = {}
        self._window = 0.0
        self._next = 0
        self._pool = ThreadPoolExecutor(threads) if threads > 1 else None

    # ---- sections ---------------------------------------------------------------------------------------------

    def section(self, key: int) -> Section:
        """The section with this number, made when first asked for."""
        if key not in self.sections:
            y = self.centre(key)
            self.sections[key] = Section(self.physics, self.solids(y), y)
            self.sections = dict(sorted(self.sections.items()))
        return self.sections[key]

    def centre(self, key: int) -> float:
        """y of a section's middle plane [m]."""
        return self.origin + key * self.pitch

    def key_at(self, y: float) -> int:
        """Number of the section that holds y."""
        return floor((y - self.origin) / self.pitch + 0.5)

    # ---- blocks and sheet -------------------------------------------------------------------------------------

    def trim(self, polygon: Array, section: int) -> Array:
        """What is left of an outline (k, 2) outside the structure in a section, convex; (0, 2) if nothing is."""
        return self.section(section).trim(polygon)

    def add_block(self, section: int, polygon_world: Array, strip_edges: Array, strip_widths: Array, density: float,
                  velocity: Sequence[float], omega: float, y: float, fragment_id: int, angle: float = 0.0) -> int:
        """Make a block from a convex outline (k, 2) in world x, z; returns its number.

        ``strip_edges`` (s + 1,) are places along the block's axis, which stands at ``angle`` [rad] from x: ``x cos +
        z sin``; ``strip_widths`` (s,) its widths along y between them [m]. ValueError if it stands in the structure.
        """
        block = make_block(self._next, self.physics, polygon_world, strip_edges, strip_widths, density,
                           (velocity[0], velocity[1]), omega, y, fragment_id, angle)
        self.section(section).add(block)
        self._next += 1
        return block.id

    def set_sheet(self, section: int, x: Array, z: Array, front: float, velocity: Array, thickness: float,
                  stiffness: tuple[float, float], applied: tuple[float, float] = (0.0, 0.0)) -> None:
        """Where the sheet is at the start of a window; meanings as in `coupling.interface.SheetEdge`.

        ``applied`` is the rubble's force (Fx, Fz) that the lattice already carries in this position; see `sheet`.
        """
        x, z = (np.array(a, dtype=np.float64).reshape(-1) for a in (x, z))
        if len(x) == 0 or len(x) != len(z) or (np.diff(x) >= 0).any() or front < x[0]:
            raise ValueError(f"sheet in section {section}: node x must decrease, front {front:g} lie ahead; got {x}")
        speed = np.array(velocity, dtype=np.float64).reshape(len(x), 2)
        self.section(section).set_sheet(x, z, float(front), speed, thickness, stiffness, applied)

    def remove_sheet(self, section: int) -> None:
        """The lattice has no ice in this section any more."""
        if section in self.sections:
            self.sections[section].remove_sheet()

    # ---- motion -----------------------------------------------------------------------------------------------

    def advance(self, n_substeps: int) -> None:
        """Move all blocks on by a window of whole sub-steps: sections, then loads, phases, side steps, clearing."""
        if n_substeps < 1:
            raise ValueError(f"a window of {n_substeps} sub-steps; give at least 1")
        self._window = n_substeps * self.physics.substep
        run = self._pool.map if self._pool else map
        list(run(lambda s: s.advance(n_substeps), self.sections.values()))
        self.time += self._window
        self._loads = {}
        for section in self.sections.values():
            self._after_window(section)
        for key, section in list(self.sections.items()):
            places = section.state[:, :2].tolist()
            for block, (x, z) in zip(list(section.blocks), places, strict=True):
                self._relocate(key, section, block, x, z)

    def _after_window(self, section: Section) -> None:
        """Mean loads, phases and side steps of the blocks of one section."""
        dt = self._window
        if not np.isfinite(section.state).all():
            lost = section.blocks[int(np.argmin(np.isfinite(section.state).all(axis=1)))].id
            raise RuntimeError(f"block {lost} in the section at y = {section.y:g} m, t = {self.time:g} s: its motion "
                               "is not finite; shorten rubble.substep")
        rows = zip(section.blocks, section.state.tolist(), section.sums.tolist(), section.slope_angles().tolist(),
                   strict=True)
        for block, state, sums, slope in rows:
            ratio = self.ratio(block.y, sums[5] / sums[3], sums[6] / sums[3]) if sums[3] > 0 else 0.0
            side = ratio * sums[2] / dt if isfinite(ratio) else 0.0
            self._loads[block.id] = (sums[0] / dt, side, sums[1] / dt)
            self._update_phase(block, block.long_axis + state[2] - slope, touches_sheet=sums[7] > 0)
            grip = (self.physics.mu_structure * sums[3] + self.physics.mu_ice_ice * sums[4]) / dt
            side_step(block, self.physics, -side, grip, hypot(state[3], state[4]), dt)

    def _update_phase(self, block: Block, turn: float, *, touches_sheet: bool) -> None:
        """Rotating until the long axis has once aligned with the nearest slope and has left the sheet; then sliding."""
        if block.phase == SLIDING:
            return
        if not block.aligned:
            period = pi if block.slender else pi / 2
            block.aligned = bool(abs((turn + period / 2) % period - period / 2) <= self.physics.align_tolerance)
        block.phase = SLIDING if block.aligned and not touches_sheet else ROTATING

    def _relocate(self, key: int, section: Section, block: Block, x: float, z: float) -> None:
        """Count a block as cleared, or hand it to the section that it has moved into if there is room."""
        if not self.domain.holds(x, block.y, z):
            self._clear(section, block)
            return
        if (step := self.key_at(block.y) - key) == 0:
            return
        new = self.section(key + (1 if step > 0 else -1))
        room = 0.05 * self.physics.thickness  # overlap that the contact solver takes out without a push
        depth, neighbour = new.in_the_way(block)
        if depth <= room:
            section.take(block)
            new.adopt(block)
        else:
            block.y = section.y + (0.5 if step > 0 else -0.5) * self.pitch * (1 - 1e-12)
            push(block, neighbour)

    def _clear(self, section: Section, block: Block) -> None:
        section.take(block)
        self.cleared.append(block.id)
        self.cleared_mass += block.mass
        self.cleared_momentum += block.mass * np.array([block.body.velocity.x, block.v_y, block.body.velocity.y])

    # ---- results ----------------------------------------------------------------------------------------------

    def _rows(self) -> list[tuple[int, Block]]:
        rows = [(key, block) for key, section in self.sections.items() for block in section.blocks]
        return sorted(rows, key=lambda row: row[1].id)

    @property
    def load_on_structure(self) -> Array:
        """Mean force of each block on the structure over the last window (n, 3), in the order of the table [N]."""
        return np.array([self._loads.get(b.id, _NOTHING) for _, b in self._rows()]).reshape(-1, 3)

    def sheet_forces(self, section: int) -> Array:
        """Mean force of the rubble on the sheet's nodes in a section over the last window (m, 2), x and z [N]."""
        found = self.sections.get(section)
        if found is None or found.sheet is None or self._window == 0.0:
            return np.zeros((0 if found is None or found.sheet is None else len(found.sheet.nodes), 2))
        return found.sheet.nodes[:, 2:] / self._window

    def table(self) -> Table:
        """All blocks as arrays, in the order of their numbers."""
        rows = self._rows()
        bodies = [b.body for _, b in rows]
        outlines = [place(b.polygon, b.body.position.x, b.body.position.y, b.body.angle, 0.0, 0.0) for _, b in rows]
        return Table(
            id=_ints(b.id for _, b in rows), fragment=_ints(b.fragment for _, b in rows),
            section=_ints(key for key, _ in rows), phase=_ints(b.phase for _, b in rows),
            mass=_floats(b.mass for _, b in rows), width=_floats(b.width for _, b in rows),
            position=_floats((b.body.position.x, b.y, b.body.position.y) for _, b in rows).reshape(-1, 3),
            angle=_floats(b.angle for b in bodies),
            velocity=_floats((b.body.velocity.x, b.v_y, b.body.velocity.y) for _, b in rows).reshape(-1, 3),
            omega=_floats(b.angular_velocity for b in bodies), load=self.load_on_structure,
            outline=np.concatenate([*outlines, np.empty((0, 2))]),
            offset=np.cumsum([0, *map(len, outlines)], dtype=np.int64))

    @property
    def mass(self) -> float:
        """True mass of all blocks that are followed [kg]."""
        return float(sum(b.mass for _, b in self._rows()))

    @property
    def momentum(self) -> Array:
        """True mass times velocity of all blocks (3,) [N s]."""
        rows = [b.mass * np.array([*b.body.velocity, b.v_y]) for _, b in self._rows()]
        return np.sum(rows, axis=0)[[0, 2, 1]] if rows else np.zeros(3)

    @property
    def energy(self) -> dict[str, float]:
        """Energy of the blocks [J]: kinetic (true mass, in the plane and across), added (of the water that moves with
        them), potential (weight, and work against water pressure), and what drag in the plane has taken so far."""
        kinetic = added = potential = 0.0
        for _, b in self._rows():
            v2, om2 = float(b.body.velocity.length_squared), float(b.body.angular_velocity) ** 2
            kinetic += (b.mass * (v2 + b.v_y**2) + b.inertia * om2) / 2
            added += ((b.body.mass - b.mass) * v2 + (b.body.moment - b.inertia) * om2) / 2
            potential += b.mass * self.physics.g * b.body.position.y + self._water_energy(b)
        drag = float(sum(s.losses[0] for s in self.sections.values()))
        return {"kinetic": kinetic, "added": added, "potential": potential, "drag": drag}

    def _water_energy(self, block: Block) -> float:
        """rho_w g times the integral of depth over the submerged part [J]; strips count with their own width."""
        (x, z), angle = block.body.position, block.body.angle
        total = 0.0
        for part, width in zip(block.parts, block.widths, strict=True):
            area, _, depth, _ = moments(submerged(place(part, x, z, angle, 0.0, 0.0)))
            total -= self.physics.rho_w * self.physics.g * width * area * depth
        return total


_NOTHING = (0.0, 0.0, 0.0)


def _ints(values: object) -> IntArray:
    return np.fromiter(values, dtype=np.int64)  # type: ignore[call-overload]


def _floats(values: object) -> Array:
    return np.array(list(values), dtype=np.float64)  # type: ignore[call-overload]
