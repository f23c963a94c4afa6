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
from math import floor, inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rubble import table
from rubble.block import Block, make_block
from rubble.crushing import crush
from rubble.geometry import Array, IntArray
from rubble.lateral import all_inside, push, side_steps
from rubble.physics import RATE_DEPENDENT, RubblePhysics
from rubble.section import Section
from rubble.stock import energy_of

Solids = Callable[[float], Sequence[Array]]  #: convex polygons of the structure in the plane y


def no_solids(y: float) -> Sequence[Array]:
    """Open water."""
    return ()


@dataclass(frozen=True)
class Domain:
    """Where blocks are followed; beyond it they are cleared [m]."""

    x_max: float = inf  #: downstream limit
    x_min: float = -inf
    depth: float = inf  #: greatest depth
    y_max: float = inf  #: greatest distance from the middle plane

    def holds(self, x: Array, y: Array, z: Array) -> NDArray[np.bool_]:
        """Which centres of mass are inside."""
        return (self.x_min <= x) & (x <= self.x_max) & (np.abs(y) <= self.y_max) & (z >= -self.depth)


class RubbleLayer:
    """Blocks in sections of width ``pitch``; ``solids(y)`` gives the structure, ``revolved`` or plane."""

    def __init__(
        self,
        physics: RubblePhysics,
        pitch: float,
        *,
        origin: float = 0.0,
        solids: Solids = no_solids,
        revolved: bool = False,
        domain: Domain | None = None,
        threads: int = 1,
    ) -> None:
        if not (isfinite(pitch) and pitch > 0):
            raise ValueError(f"section pitch is {pitch:g} m; a section needs a width > 0")
        self.physics, self.pitch, self.origin = physics, pitch, origin
        self.solids, self.revolved, self.domain = solids, revolved, domain or Domain()
        self.sections: dict[int, Section] = {}
        self.cleared: list[int] = []  #: numbers of the blocks that have left, in order
        self.cleared_mass, self.crushed_mass = 0.0, 0.0  #: [kg]
        self.cleared_momentum = np.zeros(3)  #: true mass times velocity at leaving [N s]
        self.crushed_momentum = np.zeros(3)
        self.cleared_energy, self.crushed_energy = 0.0, 0.0  #: what that ice took along, see `stock` [J]
        self.side_impact = 0.0  #: energy lost when blocks meet across the sections [J]
        self.time = 0.0  #: [s]
        self.hold_across = False  #: blocks stay in their section, while initial rubble settles
        self.threads, self._pool = threads, ThreadPoolExecutor(threads) if threads > 1 else None
        self._window = 0.0
        self._next = 0

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in self.__dict__.items() if k not in ("_pool", "solids")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._pool = ThreadPoolExecutor(self.threads) if self.threads > 1 else None

    def share(self, other: RubbleLayer) -> None:
        """Takes structure and threads from the layer of which this one is a copy."""
        self.solids, self.threads, self._pool = other.solids, other.threads, other._pool

    # ---- sections ---------------------------------------------------------------------------------------------

    def section(self, key: int) -> Section:
        """The section with this number, made when first asked for."""
        if key not in self.sections:
            y = self.centre(key)
            self.sections[key] = Section(self.physics, self.solids(y), y, self.revolved)
            self.sections = dict(sorted(self.sections.items()))
        return self.sections[key]

    def centre(self, key: int) -> float:
        """Y of a section's middle plane [m]."""
        return self.origin + key * self.pitch

    def key_at(self, y: float) -> int:
        """Number of the section that holds y."""
        return floor((y - self.origin) / self.pitch + 0.5)

    # ---- blocks and sheet -------------------------------------------------------------------------------------

    def trim(self, polygon: Array, section: int) -> Array:
        """What is left of an outline (k, 2) outside the structure in a section, convex; (0, 2) if nothing is."""
        return self.section(section).trim(polygon)

    def add_block(
        self,
        section: int,
        polygon_world: Array,
        strip_edges: Array,
        strip_widths: Array,
        density: float,
        velocity: Sequence[float],
        omega: float,
        y: float,
        fragment_id: int,
        angle: float = 0.0,
        *,
        flooded: bool | None = None,
        alone: bool = True,
    ) -> int:
        """Make a block from a convex outline (k, 2) in world x, z; returns its number.

        ``strip_edges`` (s + 1,) are places along the block's axis, which stands at ``angle`` [rad] from x: ``x cos +
        z sin``; ``strip_widths`` (s,) its widths along y between them [m]. ``velocity`` (x, z) or (x, y, z) [m/s].
        ``flooded`` says whether its top is under water already, by default as `RubblePhysics.backfill` has it for a
        new piece. ValueError if it stands in the structure or, unless ``alone`` is False, in another block.
        """
        full = self.physics.backfill == "full" if flooded is None else flooded
        block = make_block(
            self._next,
            self.physics,
            polygon_world,
            strip_edges,
            strip_widths,
            density,
            (velocity[0], velocity[-1]),
            omega,
            y,
            fragment_id,
            angle,
            float(full),
        )
        block.v_y = float(velocity[1]) if len(velocity) == 3 else 0.0
        self.section(section).add(block, alone=alone)
        self._next += 1
        return block.id

    def block(self, number: int) -> Block:
        """The block with this number; KeyError if it has left."""
        for block in self.blocks:
            if block.id == number:
                return block
        raise KeyError(number)

    @property
    def blocks(self) -> list[Block]:
        """All blocks in the order of their numbers."""
        return sorted((b for s in self.sections.values() for b in s.blocks), key=lambda b: b.id)

    def set_sheet(
        self,
        section: int,
        x: Array,
        z: Array,
        front: float,
        velocity: Array,
        thickness: float,
        stiffness: tuple[float, float],
        inertia: tuple[float, float],
        applied: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Where the sheet is at the start of a window; meanings as in `coupling.interface.SheetEdge`.

        ``applied`` is the rubble's force (Fx, Fz) that the lattice already carries in this position; see `sheet`.
        """
        x, z = (np.array(a, dtype=np.float64).reshape(-1) for a in (x, z))
        if len(x) == 0 or len(x) != len(z) or (np.diff(x) >= 0).any() or front < x[0]:
            raise ValueError(f"sheet in section {section}: node x must decrease, front {front:g} lie ahead; got {x}")
        speed = np.array(velocity, dtype=np.float64).reshape(len(x), 2)
        self.section(section).set_sheet(x, z, float(front), speed, thickness, stiffness, inertia, applied)

    def remove_sheet(self, section: int) -> None:
        """The lattice has no ice in this section any more."""
        if section in self.sections:
            self.sections[section].remove_sheet()

    def set_form_drag(self, coefficient: float) -> None:
        """Another C_d for a while: rubble settles sooner in thick water."""
        for section in self.sections.values():
            section.water[2] = coefficient

    # ---- motion -----------------------------------------------------------------------------------------------

    def advance(self, n_substeps: int) -> None:
        """Move all blocks on by a window of whole sub-steps: sections, then loads, phases, side steps, clearing."""
        if n_substeps < 1:
            raise ValueError(f"a window of {n_substeps} sub-steps; give at least 1")
        self._window = n_substeps * self.physics.substep
        run = self._pool.map if self._pool else map
        list(run(lambda s: s.advance(n_substeps), self.sections.values()))
        self.time += self._window
        for section in self.sections.values():
            self._after_window(section)
        d, half = self.domain, 0.5 * self.pitch
        for key, section in list(self.sections.items()):
            if all_inside(section.state, section.side, section.y, half, d.x_min, d.x_max, d.y_max, d.depth):
                continue
            x, z, y = section.state[:, 0], section.state[:, 1], section.side[0]
            gone = ~self.domain.holds(x, y, z)
            off = gone | (np.abs(y - section.y) > half)
            for block, out in [(section.blocks[i], gone[i]) for i in np.flatnonzero(off)]:
                if out:
                    self._clear(section, block)
                elif (step := self.key_at(block.y) - key) != 0:
                    self._cross(key, section, block, step)

    def _after_window(self, section: Section) -> None:
        """Mean loads, phases, side steps and crushing of the blocks of one section."""
        if not section.blocks:
            return
        if not np.isfinite(section.state).all():
            lost = section.blocks[int(np.argmin(np.isfinite(section.state).all(axis=1)))].id
            raise RuntimeError(
                f"block {lost} in the section at y = {section.y:g} m, t = {self.time:g} s: its motion "
                "is not finite; shorten rubble.substep"
            )
        p, side = self.physics, section.side
        mu = 0.1 if p.mu_ice_ice == RATE_DEPENDENT else float(p.mu_ice_ice)  # across: sliding, the upper end of speed
        side_steps(
            self._window,
            mu,
            p.rho_w / 2 * p.form_drag,
            p.feed_speed,
            section.polygons,
            section.corners,
            section.moved,
            section.state,
            section.sums,
            side.copy() if self.hold_across else side,
            section.load,
            section.across_work,
        )
        section.update_phases()
        if section.heavy[0, 0] > 0:
            mass, momentum, energy = crush(section, self._window)
            self.crushed_mass += mass
            self.crushed_energy += energy
            self.crushed_momentum += momentum

    def _cross(self, key: int, section: Section, block: Block, step: int) -> None:
        """Hand a block to the section that it has moved into if there is room."""
        new = self.section(key + (1 if step > 0 else -1))
        room = 0.05 * self.physics.thickness  # overlap that the contact solver takes out without a push
        depth, neighbour = new.in_the_way(block)
        if depth <= room:
            section.take(block)
            new.adopt(block)
        else:
            block.y = section.y + (0.5 if step > 0 else -0.5) * self.pitch * (1 - 1e-12)
            self.side_impact += push(block, neighbour)

    def _clear(self, section: Section, block: Block) -> None:
        section.take(block)
        self.cleared.append(block.id)
        self.cleared_mass += block.mass
        self.cleared_energy += sum(energy_of(block, self.physics))
        self.cleared_momentum += block.mass * np.array([block.body.velocity.x, block.v_y, block.body.velocity.y])

    # ---- results ----------------------------------------------------------------------------------------------

    def table(self) -> table.Table:
        """All blocks as arrays, in the order of their numbers."""
        return table.gather(self.sections)

    @property
    def load_on_structure(self) -> Array:
        """Mean force of each block on the structure over the last window (n, 3), in the order of the table [N]."""
        return np.array([b.load for b in self.blocks]).reshape(-1, 3)

    def load_by_phase(self, phases: Sequence[int]) -> Array:
        """Sum of the mean forces of the blocks in each phase (len(phases), 3) [N]."""
        phase: IntArray = np.array([b.phase for b in self.blocks], np.int64)
        load = self.load_on_structure
        return np.array([load[phase == p].sum(axis=0) for p in phases]).reshape(-1, 3)

    def sheet_forces(self, section: int) -> Array:
        """Mean force of the rubble on the sheet's nodes in a section over the last window (m, 2), x and z [N]."""
        found = self.sections.get(section)
        if found is None or found.sheet is None or self._window == 0.0:
            return np.zeros((0 if found is None or found.sheet is None else len(found.sheet.nodes), 2))
        return found.sheet.nodes[:, 2:] / self._window

    @property
    def power_on_sheet(self) -> float:
        """Mean power of the blocks' forces on the moving edges of the sheet over the last window [W]."""
        done = sum(float(s.sheet_sums[4]) for s in self.sections.values())
        return -done / self._window if self._window else 0.0

    @property
    def budget(self) -> dict[str, Array]:
        """What carries the blocks, mean forces (x, z) over the last window [N]; see `table.budget`."""
        return table.budget(self.sections.values(), self._window)

    @property
    def mass(self) -> float:
        """True mass of all blocks that are followed [kg]."""
        return float(sum(b.mass for b in self.blocks))

    @property
    def momentum(self) -> Array:
        """True mass times velocity of all blocks (3,) [N s]."""
        return table.momentum(self.blocks)

    @property
    def energy(self) -> dict[str, float]:
        """See `table.energy`; with ``drag``, what drag in the plane has taken so far, and ``dry``, the work of dry
        tops, by which the potential energy falls short.
        """
        losses = sum((s.losses[:4] for s in self.sections.values()), np.zeros(4))
        return {**table.energy(self.blocks, self.physics), "drag": float(losses[0]), "dry": float(losses[3])}
