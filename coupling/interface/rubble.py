"""The rubble as a participant: what it takes, what it gives, and what it promises."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from coupling.interface.exchange import ForcePairs, Restore, SheetForces
from coupling.interface.sheet import Event, Fragment, SheetEdge
from coupling.interface.units import Array, IntArray


@dataclass(frozen=True, slots=True)
class BlockTable:
    """All blocks of the rubble at one instant, as arrays (struct of arrays, n blocks)."""

    id: IntArray  #: (n,) number of the block, never reused
    section: IntArray  #: (n,) section it moves in
    phase: IntArray  #: (n,) `Phase` of the block: ROTATING or SLIDING
    mass: Array  #: (n,) [kg]
    width: Array  #: (n,) mean extent along y [m]
    position: Array  #: (n, 3) centre of mass [m]
    quaternion: Array  #: (n, 4) w, x, y, z: turns the axes that a plate had at its birth into the present ones
    angle: Array  #: (n,) rotation about -y, counter-clockwise in the x-z picture [rad]
    velocity: Array  #: (n, 3) [m/s]
    omega: Array  #: (n,) rate of `angle` [rad/s]
    load: Array  #: (n, 3) mean force on the structure over the window [N]
    bearing: Array  #: (n, 3) where it acts, mean of the contacts over the window; nan without one [m]
    outline: Array  #: (v, 2) corner points of all blocks in the x-z plane, in world coordinates [m]
    offset: IntArray  #: (n + 1,) block i owns outline[offset[i]:offset[i + 1]]

    @property
    def count(self) -> int:
        """Number of blocks."""
        return len(self.id)

    @classmethod
    def empty(cls) -> BlockTable:
        """No blocks."""
        i, f = np.empty(0, np.int64), np.empty(0)
        return cls(
            id=i,
            section=i,
            phase=i,
            mass=f,
            width=f,
            position=np.empty((0, 3)),
            quaternion=np.empty((0, 4)),
            angle=f,
            velocity=np.empty((0, 3)),
            omega=f,
            load=np.empty((0, 3)),
            bearing=np.empty((0, 3)),
            outline=np.empty((0, 2)),
            offset=np.zeros(1, np.int64),
        )


@dataclass(frozen=True)
class HandOver:
    """Balance of one fragment: what left the lattice and what arrived as blocks or was crushed.

    Momenta are those of all its ice: what was crushed off its edge moves with the lattice until then.
    """

    blocks: int
    mass: float  #: of the fragment, without what was crushed before [kg]
    trimmed: float  #: cut off because it lay inside the structure, crushed [kg]
    momentum_error: float  #: of that of the blocks in the layer and of the crushed ice against the sheet's, relative
    angular_momentum_error: float = 0.0  #: the same about the fragment's centre of mass, three components
    #: (6,) momentum that crushed ice takes along, before and now, and its moment about the origin [N s], [N m s]
    crushed: Array = field(default_factory=lambda: np.zeros(6))
    #: (3,) angular momentum that neighbours of a narrow block hold, which turns about y alone [N m s]
    held: Array = field(default_factory=lambda: np.zeros(3))


class RubbleParticipant(Protocol):
    """Broken ice. `coupling.rubble_port.RubblePort` is the one of this project, `NoRubble` the one that takes it away.

    Per window first `add` for each fragment of it, then `set_sheet`, then `advance` (in lockstep `begin`, `meet` for
    every sub-step, `end`); then everything else speaks of the window that has just ended. Blocks move from the state
    that their ice had at the start of the window.
    """

    @property
    def mass(self) -> float:
        """True mass of all blocks that are followed [kg]."""
        ...

    @property
    def cleared_mass(self) -> float:
        """Mass of all blocks so far that have passed the structure or left the domain [kg]."""
        ...

    @property
    def energy(self) -> dict[str, float]:
        """Terms of `coupling.energy` that blocks have a part in, since the start [J]; empty: no books are kept."""
        ...

    @property
    def momenta(self) -> dict[str, float]:
        """Momentum that cleared and crushed ice took along, by name and axis, since the start [N s]."""
        ...

    @property
    def budget(self) -> ForcePairs:
        """What carries the blocks, means over the window; ``staggering`` is minus their force on the sheet."""
        ...

    @property
    def power(self) -> float:
        """Mean power of the blocks' forces on the edges, by the motion of the edges as the rubble saw it [W]."""
        ...

    @property
    def on_structure(self) -> Array:
        """Mean load of the blocks in the last window, and its moment about the structure's waterline point (6,)."""
        ...

    def set_structure(self, place: Array, velocity: Array) -> None:
        """Displacement (6,) of the structure when the coming window begins, and velocity (6,) over it."""
        ...

    def add(self, fragment: Fragment) -> HandOver:
        """Turns a fragment into blocks where and as it moves. The fragment is not kept."""
        ...

    def sections_in_use(self) -> Mapping[int, float]:
        """Numbers of the sections in which the rubble must know where the sheet is, ascending; to which x back [m]."""
        ...

    def set_sheet(self, edges: dict[int, SheetEdge], carried: SheetForces, compliance: Array) -> None:
        """The sheet by section in the coming window; a section without an entry has no sheet.

        ``carried`` are the forces of the rubble that the sheet already answers to in this motion: the edges yield to
        what comes on top of them, by their ``compliance`` (2, k, k) [m/N] after a window.
        """
        ...

    def begin(self, edges: dict[int, SheetEdge]) -> None:
        """A window in lockstep begins; the sheet is as in `set_sheet`, but for its velocity, which has no meaning."""
        ...

    def meet(self, nodes: Array) -> Array:
        """One sub-step: ``nodes`` (m, 11) of the edges as `SheetParticipant.nodes` has them; forces on them (m, 3)."""
        ...

    def end(self) -> None:
        """It ends; as after `advance`."""
        ...

    def advance(self, window_ns: int) -> None:
        """Moves all blocks over a window, a whole number of sub-steps. SimulationError if a motion is not finite."""
        ...

    def forces_on_sheet(self) -> SheetForces:
        """Mean forces of the blocks on the sheet over the last window; new arrays in every window."""
        ...

    def events(self, t_ns: int, load: Array) -> list[Event]:
        """Plates that have broken again by the end ``t_ns`` of the window, under the load (3,) of all phases [N]."""
        ...

    def load(self) -> Array:
        """Mean force of the blocks on the structure over the last window, (3, 3): rows by `Phase` [N]. The caller's."""
        ...

    def blocks(self) -> BlockTable:
        """All blocks at the end of the window."""
        ...

    def save(self) -> Restore:
        """The rubble between two windows; see `Restore`."""
        ...
