"""The contract between the participants: what crosses, who owns it, in which units and signs.

Call order of one macro step (time window) of the serial-explicit scheme::

    sheet.advance(window, rubble_forces)      the sheet moves, meets the structure, breaks
    for fragment in sheet.released(): ...     broken pieces leave the lattice, become blocks
    rubble.set_sheet(path, rubble_forces)     how the sheet's underside and edge move, and what they already carry
    rubble.advance(window)                    blocks move; impulses are summed
    rubble_forces = rubble.forces_on_sheet()  act on the sheet in the next window
    observers(frame)                          recorder, progress, load series: read only

Other schemes call the same in another order (`coupling.schemes`). An implicit one repeats a window: both participants
``save()`` at its start and ``restore(saved)`` as often as needed, and what follows has the same bits every time.

Frame: SI units, right-handed, fixed to the structure. x = drift direction of the ice towards the structure,
y to the left, z up, z = 0 still water. The structure's axis is x = y = 0; the ice comes from -x.

Loads are forces of the ice on the structure: Fx > 0 in drift direction, Fz > 0 lifts the structure.

Time is an integer number of nanoseconds (``t_ns``), so that windows add up without rounding.

Everything in this file is data. A participant owns the arrays that it hands out; the receiver copies what it keeps.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

NS = 1_000_000_000  #: nanoseconds per second


class SimulationError(RuntimeError):
    """A run that cannot go on; the message says what, where, when and what to do."""


class Phase(IntEnum):
    """Phase of the interaction that a load belongs to (Lu and Loset 2010, after Kamarainen 2007; thesis 6.3.1)."""

    BREAKING = 0  #: contact of the sheet with the structure
    ROTATING = 1  #: contact of a block that has not yet aligned with the slope or still touches the sheet it came from
    SLIDING = 2  #: contact of all other blocks, including force that they pass on


PHASES = tuple(p.name.lower() for p in Phase)


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened to the sheet.

    ``kind`` is one of ``cell_failure`` (a first failure after a quiet window), ``split`` (the sheet falls into two
    parts that both stay in the lattice), ``circumferential`` (a piece in front of the structure
    breaks off), ``hand_over`` (a fragment has become blocks), ``out_of_water`` (for the first time the sheet is lifted
    by more than its draft, where its linear foundation ends).
    """

    t_ns: int
    kind: str
    force: tuple[float, float, float]  #: load on the structure at the event, all phases [N]
    cells: int  #: number of cells that failed in the event
    position: tuple[float, float, float]  #: centre of the failed cells or of the fragment [m]
    text: str  #: one line for people
    length: float = 0.0  #: of the piece along the drift, 0 if the event is about none [m]
    area: float = 0.0  #: of the piece [m2]


@dataclass(frozen=True, slots=True)
class Fragment:
    """A piece of the sheet that has lost its way through intact cells to the held edge. Node-wise, so exact.

    Every node owns its tributary ice (d x d inside, d x d/2 at an edge, d x d/4 at a corner), thus fragments
    partition the sheet and a crack costs no ice. Rows count along x (drift), columns along y.
    """

    row: IntArray  #: (n,) row of each node, counted from the edge that faces the structure
    column: IntArray  #: (n,) column index of each node
    mass: Array  #: (n,) mass without what was crushed [kg]
    length: Array  #: (n,) extent of the node's ice along x [m]
    width: Array  #: (n,) extent along y [m]
    lead: Array  #: (n,) extent ahead of the node, towards the structure [m]
    position: Array  #: (n, 3) node position, middle of the thickness [m]
    velocity: Array  #: (n, 3) [m/s]
    tilt: Array  #: (n,) rotation of the node about +y (lifts the rear and lowers the front edge when > 0) [rad]
    tilt_rate: Array  #: (n,) [rad/s]
    cut: Array  #: (n,) how far the face that touches is crushed back, from the front of the node's ice [m]
    cut_tan: Array  #: (n,) steepness of the cut: depth below the touching face over distance along x
    cut_face: float  #: +1 if the upper edge of the ice was crushed (downward-breaking structure), -1 the lower
    thickness: float  #: [m]


@dataclass(frozen=True, slots=True)
class SheetEdge:
    """The sheet in one section as the rubble meets it in a window: nodes of its front rows, front first.

    Places are those at the start of the window, velocities the means over it, both with the rubble's forces of the
    window before; what these forces change since, the edge answers as an oscillator (see `coupling.yielding`).
    """

    x: Array  #: (m,) node positions along x, decreasing [m]
    z: Array  #: (m,) middle of the thickness [m]
    front: float  #: x of the sheet's foremost point, at most half a cell ahead of x[0] [m]
    velocity: Array  #: (m, 2) velocity of the nodes in x and z [m/s]
    thickness: float  #: [m]
    nodes: IntArray  #: (m,) node numbers of the lattice, to which forces return
    stiffness: tuple[float, float]  #: of the edge in x and z [N/m]
    inertia: tuple[float, float]  #: mass that moves with the edge in x and z [kg]


@dataclass(slots=True)
class SheetForces:
    """Mean forces of the rubble on sheet nodes over a window (force on the sheet, the sheet's reaction is opposite)."""

    nodes: IntArray  #: (k,) node numbers, each at most once
    force: Array  #: (k, 3) [N]

    @classmethod
    def none(cls) -> SheetForces:
        return cls(np.empty(0, np.int64), np.empty((0, 3)))


@dataclass(frozen=True, slots=True)
class BlockTable:
    """All blocks of the rubble at one instant, as arrays (struct of arrays, n blocks)."""

    id: IntArray  #: (n,) number of the block, never reused
    section: IntArray  #: (n,) section it moves in
    phase: IntArray  #: (n,) `Phase` of the block: ROTATING or SLIDING
    mass: Array  #: (n,) [kg]
    width: Array  #: (n,) mean extent along y [m]
    position: Array  #: (n, 3) centre of mass [m]
    angle: Array  #: (n,) rotation about -y, counter-clockwise in the x-z picture [rad]
    velocity: Array  #: (n, 3) [m/s]
    omega: Array  #: (n,) rate of `angle` [rad/s]
    load: Array  #: (n, 3) mean force on the structure over the window [N]
    outline: Array  #: (v, 2) corner points of all blocks in the x-z plane, in world coordinates [m]
    offset: IntArray  #: (n + 1,) block i owns outline[offset[i]:offset[i + 1]]

    @property
    def count(self) -> int:
        return len(self.id)

    @classmethod
    def empty(cls) -> BlockTable:
        i, f = np.empty(0, np.int64), np.empty(0)
        return cls(
            i,
            i,
            i,
            f,
            f,
            np.empty((0, 3)),
            f,
            np.empty((0, 3)),
            f,
            np.empty((0, 3)),
            np.empty((0, 2)),
            np.zeros(1, np.int64),
        )


@dataclass(frozen=True, slots=True)
class SheetView:
    """The sheet at one instant, for observers."""

    position: Array  #: (n, 3) nodes, middle of the thickness [m]
    damage: Array  #: (n,) share of the node's cells that have failed, 0-1
    utilisation: Array  #: (n,) highest utilisation of the node's intact cells (1 = fails)
    present: BoolArray  #: (n,) node is still part of the lattice
    intact: BoolArray  #: (c,) cell is intact
    shape: tuple[int, int]  #: nodes along x and y; node number = row * shape[1] + column
    cell_shape: tuple[int, int]  #: cells along x and y; cell (i, j) joins nodes (i, j), (i+1, j), (i, j+1), (i+1, j+1)


@dataclass(frozen=True, slots=True)
class Frame:
    """One macro step as observers see it. ``t_ns`` is the end of the window; loads are means over it."""

    t_ns: int
    sheet: SheetView
    blocks: BlockTable
    load: Array  #: (3, 3) force on the structure, rows by `Phase`, columns x, y, z [N]
    events: tuple[Event, ...] = ()
    ledger: dict[str, float] = field(default_factory=dict)  #: named balances of `coupling.ledger` [SI]
    budget: dict[str, float] = field(default_factory=dict)  #: what carries the load, see `coupling.budget` [N]
