"""All rubble: sections side by side, blocks that move between them, and what has left.

Section ``key`` is the slice ``|y - (origin + key pitch)| <= pitch / 2``; it comes to be when first used. In a window
sections do not know of each other, so threads change no bit of the result. Between windows blocks move laterally
(`between`); one that crosses into the next section goes there with its motion, if there is room for it. Otherwise it
waits at the border and pushes the ice next door (plastic impact: both go on with their common speed). Nothing is
deleted: blocks that have passed the structure or left the domain are counted as cleared, with mass and momentum.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from math import floor, isfinite
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rubble import table
from rubble.arrays import Array
from rubble.between import after_window
from rubble.block import Block, Slab, energy_of, make_block
from rubble.cut import Solids, open_water
from rubble.domain import Domain
from rubble.lateral import all_inside, collide
from rubble.lost import Lost
from rubble.physics import RubblePhysics
from rubble.section import Section
from rubble.sheet import SheetMotion

#: Overlap with what stands next door up to which a block crosses over, in thicknesses: ten times the solver's own
#: tolerance (`RubblePhysics.slop_ratio`). The solver takes it out at a few millimetres per sub-step, without a push;
#: with less room blocks that touch their neighbours would never change sections.
CROSSING_ROOM = 0.05


class RubbleLayer:
    """Blocks in sections of width ``pitch``; ``solids(y)`` gives the structure in the plane y."""

    def __init__(
        self,
        physics: RubblePhysics,
        pitch: float,
        *,
        origin: float = 0.0,
        solids: Solids = open_water,
        domain: Domain | None = None,
        threads: int = 1,
    ) -> None:
        if not (isfinite(pitch) and pitch > 0):
            raise ValueError(f"section pitch is {pitch:g} m; a section needs a width > 0")
        self.physics, self.pitch, self.origin = physics, pitch, origin
        self.solids, self.domain = solids, domain or Domain()
        self.sections: dict[int, Section] = {}
        self.cleared: list[int] = []  #: numbers of the blocks that have left, in order
        self.gone = Lost()  #: what they took along
        self.crushed = Lost()  #: what was cut off blocks
        self.lateral_impact = 0.0  #: energy lost when blocks meet across the sections [J]
        self.time = 0.0  #: [s]
        self.hold_lateral = False  #: blocks stay in their section, while initial rubble settles
        self.threads, self._pool = threads, ThreadPoolExecutor(threads) if threads > 1 else None
        self._window = 0.0
        self._next = 0

    def __getstate__(self) -> dict[str, Any]:
        return {k: v for k, v in self.__dict__.items() if k not in ("_pool", "solids")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._pool = ThreadPoolExecutor(self.threads) if self.threads > 1 else None

    def connect_like(self, other: RubbleLayer) -> None:
        """Takes structure and threads from the layer of which this one is a copy."""
        self.solids, self.threads, self._pool = other.solids, other.threads, other._pool

    def section(self, key: int) -> Section:
        """The section with this number, made when first asked for."""
        if key not in self.sections:
            y = self.centre(key)
            self.sections[key] = Section(self.physics, self.solids(y), y)
            self.sections = dict(sorted(self.sections.items()))
        return self.sections[key]

    def centre(self, key: int) -> float:
        """Y of a section's middle plane [m]."""
        return self.origin + key * self.pitch

    def key_at(self, y: float) -> int:
        """Number of the section that holds y."""
        return floor((y - self.origin) / self.pitch + 0.5)

    def trim(self, polygon: Array, section: int) -> Array:
        """What is left of an outline (k, 2) outside the structure in a section, convex; (0, 2) if nothing is."""
        return self.section(section).trim(polygon)

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
        """Make a block from ice in a section; returns its number.

        ``velocity`` (x, z) or (x, y, z) [m/s], ``omega`` [rad/s]; ``y`` is the middle of the section if not given [m].
        ``flooded`` is the part of the head of water that its top carries, by default as `RubblePhysics.backfill` has it
        for a new piece. ValueError if it stands in the structure or, unless ``alone`` is False, in another block.
        """
        full = float(self.physics.backfill == "full") if flooded is None else float(flooded)
        v_x, v_y, v_z = velocity if len(velocity) == 3 else (velocity[0], 0.0, velocity[1])
        at = self.centre(section) if y is None else y
        block = make_block(self._next, fragment, self.physics, slab, (v_x, v_y, v_z), omega, at, full)
        self.section(section).add(block, alone=alone)
        self._next += 1
        return block.id

    def block(self, number: int) -> Block:
        """The block with this number; KeyError if it has left."""
        for section in self.sections.values():
            for block in section.blocks:
                if block.id == number:
                    return block
        raise KeyError(number)

    @property
    def blocks(self) -> list[Block]:
        """All blocks in the order of their numbers."""
        return sorted((b for s in self.sections.values() for b in s.blocks), key=lambda b: b.id)

    def set_sheet(self, section: int, motion: SheetMotion) -> None:
        """Where the sheet is in a section at the start of a window, and how it moves."""
        self.section(section).set_sheet(motion)

    def remove_sheet(self, section: int) -> None:
        """The lattice has no ice in this section any more."""
        if section in self.sections:
            self.sections[section].remove_sheet()

    def set_form_drag(self, coefficient: float) -> None:
        """Another C_d for a while: initial rubble settles sooner in thick water."""
        for section in self.sections.values():
            section.water = section.water._replace(form_drag=float(coefficient))

    def advance(self, n_substeps: int) -> None:
        """Move all blocks on by a window of whole sub-steps: sections, then what happens between two windows."""
        if n_substeps < 1:
            raise ValueError(f"a window of {n_substeps} sub-steps; give at least 1")
        self._window = n_substeps * self.physics.substep
        each = self._pool.map if self._pool else map
        list(each(lambda s: s.advance(n_substeps), self.sections.values()))
        self.time += self._window
        for section in self.sections.values():
            lost = after_window(section, self._window, self.time, hold=self.hold_lateral)
            self.crushed.take(lost.mass, lost.momentum, lost.energy)
        half = 0.5 * self.pitch
        for key, section in list(self.sections.items()):
            state, lateral = section.state, section.tables.lateral
            if all_inside(state, lateral, section.y, half, self.domain):
                continue
            gone = ~self.domain.holds(state["x"], lateral["y"], state["z"])
            off = gone | (np.abs(lateral["y"] - section.y) > half)
            for block, out in [(section.blocks[i], gone[i]) for i in np.flatnonzero(off)]:
                if out:
                    self._clear(section, block)
                elif (step := self.key_at(block.y) - key) != 0:
                    self._cross(key, section, block, step)

    def _cross(self, key: int, section: Section, block: Block, step: int) -> None:
        """Hand a block to the section that it has moved into if there is room."""
        new = self.section(key + (1 if step > 0 else -1))
        depth, neighbour = new.in_the_way(block)
        if depth <= CROSSING_ROOM * self.physics.thickness:
            section.take(block)
            new.adopt(block)
        else:
            block.y = section.y + (0.5 if step > 0 else -0.5) * self.pitch * (1 - 1e-12)
            self.lateral_impact += collide(block, neighbour)

    def _clear(self, section: Section, block: Block) -> None:
        section.take(block)
        self.cleared.append(block.id)
        self.gone.take(block.mass, block.momentum, sum(energy_of(block, self.physics)))

    def columns(self) -> dict[str, NDArray[Any]]:
        """All blocks as arrays by name, in the order of their numbers; see `table.columns`."""
        return table.columns(self.sections)

    def table(self) -> SimpleNamespace:
        """The same with dots."""
        return SimpleNamespace(**self.columns())

    @property
    def load_on_structure(self) -> Array:
        """Mean force of each block on the structure over the last window (n, 3), in the order of the table [N]."""
        return np.array([b.load.tolist() for b in self.blocks]).reshape(-1, 3)

    def load_of(self, *, sliding: bool) -> Array:
        """Sum of the mean forces of the blocks that slide, or of those that rotate (3,) [N]."""
        phase = np.array([b.sliding for b in self.blocks], np.bool_) == sliding
        return np.asarray(self.load_on_structure[phase].sum(axis=0))

    def contact_centres(self) -> Array:
        """Where each block presses on the structure: mean x and z (n, 2) of its contacts, weighted with their impulse.

        Over the last window, in the order of the table; nan without contact [m].
        """
        return table.contact_centres(self.sections)

    def sheet_forces(self, section: int) -> Array:
        """Mean force of the rubble on the sheet's nodes in a section over the last window (m, 2), x and z [N]."""
        found = self.sections.get(section)
        if found is None or found.sheet is None:
            return np.zeros((0, 2))
        return found.sheet.impulse / self._window if self._window else np.zeros_like(found.sheet.impulse)

    @property
    def power_on_sheet(self) -> float:
        """Mean power of the blocks' forces on the moving edges of the sheet over the last window [W]."""
        done = sum(float(s.sums.sheet["work"][0]) for s in self.sections.values())
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
        return sum((b.momentum for b in self.blocks), np.zeros(3))
