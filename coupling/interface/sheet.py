"""The sheet as a participant: what it takes, what it gives, and what it promises."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from coupling.interface.exchange import ForcePairs, Restore, SheetForces
from coupling.interface.units import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True)
class Event:
    """Something that happened to the sheet.

    ``kind`` is one of ``cell_failure`` (a first failure after a quiet window), ``split`` (the sheet falls into two
    parts that both stay in the lattice), ``circumferential`` (a piece in front of the structure breaks off),
    ``hand_over`` (a fragment has become rubble), ``breaks_again`` (a plate of the rubble has parted in two),
    ``crack`` (a crack has passed the middle of the ice: from there on it is a hinge), ``hinge`` (cracks so deep
    surround a piece that still is held by what presses it), ``out_of_water`` (for the first time the sheet is
    lifted by more than its draft, where its linear foundation ends).
    """

    t_ns: int
    kind: str
    force: tuple[float, float, float]  #: load on the structure at the event, all phases [N]
    cells: int  #: number of cells that failed in the event
    position: tuple[float, float, float]  #: centre of the failed cells or of the fragment [m]
    text: str  #: one line for people
    length: float = 0.0  #: of the piece along the drift, 0 if the event is about none [m]
    area: float = 0.0  #: of the piece [m2]
    cause: str = ""  #: failure criteria by which the cells failed, in order, joined by commas; empty without cells


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
    flooded: Array  #: (n,) part of the head of water above it that the top of the node's ice carries, 0-1
    cut: Array  #: (n,) how far the face that touches is crushed back, from the front of the node's ice [m]
    cut_tan: Array  #: (n,) steepness of the cut: depth below the touching face over distance along x
    cut_face: float  #: +1 if the upper edge of the ice was crushed (downward-breaking structure), -1 the lower


@dataclass(frozen=True, slots=True)
class SheetEdge:
    """The sheet in one section as the rubble meets it in a window: nodes of its front rows, front first.

    Places are those at the start of the window, velocities the means over it, both with the rubble's forces of the
    window before; to what these forces change since, all edges answer together (`SheetParticipant.compliance`). The ice
    is as thick as the rubble's plates.
    """

    x: Array  #: (m,) node positions along x, decreasing [m]
    z: Array  #: (m,) middle of the thickness [m]
    front: float  #: x of the sheet's foremost point, at most half a cell ahead of x[0] [m]
    velocity: Array  #: (m, 2) velocity of the nodes in x and z [m/s]
    nodes: IntArray  #: (m,) node numbers of the lattice, to which forces return


@dataclass(frozen=True, slots=True)
class SheetView:
    """The sheet at one instant, for observers."""

    position: Array  #: (n, 3) nodes, middle of the thickness [m]
    damage: Array  #: (n,) mean damage of the node's cells: failed, or depth of their crack, 0-1
    utilisation: Array  #: (n,) highest utilisation of the node's intact cells (1 = fails)
    present: BoolArray  #: (n,) node is still part of the lattice
    intact: BoolArray  #: (c,) cell holds its nodes together
    shape: tuple[int, int]  #: nodes along x and y; node number = row * shape[1] + column
    cell_shape: tuple[int, int]  #: cells along x and y; cell (i, j) joins nodes (i, j), (i+1, j), (i, j+1), (i+1, j+1)


@dataclass(frozen=True, slots=True)
class ContactForces:
    """The structure on the sheet's edge, node by node: their sum is minus the load of the sheet."""

    nodes: IntArray  #: (m,) node numbers of the edge, also of those that touch nothing or have left in the window
    position: Array  #: (m, 3) where each force acts, at the end of the window [m]
    force: Array  #: (m, 3) mean over the window, on the sheet [N]
    hinged: BoolArray  #: (m,) node of a hinged piece: its load counts as rotating

    @classmethod
    def none(cls) -> ContactForces:
        """An edge that touches nothing."""
        return cls(np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3)), np.empty(0, bool))


@dataclass
class SheetReport:
    """What the sheet did in a window. It belongs to the caller."""

    load: Array  #: (3,) mean force of the sheet on the structure [N]
    fragments: list[Fragment] = field(default_factory=list)  #: that have left the lattice, in order
    events: list[Event] = field(default_factory=list)
    budget: ForcePairs = field(default_factory=dict)  #: what carries the sheet, see `coupling.budget`
    loads: ForcePairs = field(default_factory=dict)  #: mean force of each `Load` on the sheet, by its name
    contact: ContactForces = field(default_factory=ContactForces.none)  #: the load, where it acts
    hinged: Array | None = None  #: (3,) part of the load that hinged pieces give; None: there are none [N]
    #: (6,) mean load and moment about the waterline point of a structure that moves; None: it rests [N], [N m]
    wrench: Array | None = None


#: The rubble in lockstep: takes the fragments that have left since the window began, if it has not got them yet, moves
#: on by one sub-step, and gives the forces in it.
Answer = Callable[[list[Fragment]], SheetForces]


class SheetParticipant(Protocol):
    """The unbroken ice. `coupling.sheet_port.SheetPort` is the one of this project.

    Per window `advance` once, or again after `save` and the restoring of it; everything else speaks of the window that
    has just ended. A fragment has left when `advance` returns: mass, edges and view are without it.
    """

    @property
    def mass(self) -> float:
        """Ice in the lattice, without what was crushed off its edge [kg]."""
        ...

    @property
    def crushed(self) -> float:
        """Ice crushed off the edge since the start [kg]."""
        ...

    @property
    def energy(self) -> dict[str, float]:
        """Terms of `coupling.energy` that the sheet has a part in, since the start [J]; empty: no books are kept."""
        ...

    @property
    def power(self) -> float:
        """Mean power of the rubble's forces on the sheet over the window, in the fixed frame [W]."""
        ...

    def advance(
        self, t_ns: int, window_ns: int, rubble: SheetForces, rubble_load: Array, answer: Answer | None = None
    ) -> SheetReport:
        """Moves the sheet from ``t_ns`` over a window under the rubble's mean forces.

        ``rubble_load`` (3,) is the blocks' load on the structure [N], which events add to the sheet's own. Forces on
        nodes that have left act on nothing. In lockstep ``answer`` is asked for the forces instead, once for every
        sub-step of the rubble; the report is then without the fragments that it was given. SimulationError if no motion
        is found.
        """
        ...

    def lockstep(self, every: float) -> None:
        """From now on windows are met in steps of ``every`` [s]. SimulationError if the sheet cannot do that."""
        ...

    def nodes(self, nodes: IntArray) -> Array:
        """Nodes at a meeting in lockstep (m, 11).

        Place x, z [m]; velocity; what the lattice will add to it by the next meeting [m/s]; inverse mass [1/kg]; the
        last three in x, y, z.
        """
        ...

    def edges(self, sections: Mapping[int, float]) -> dict[int, SheetEdge]:
        """The sheet in these sections where it is and moves now; a section without ice in front has no entry.

        Each from its front back to the x that is given for it, or farther [m].
        """
        ...

    def path(self, sections: Mapping[int, float]) -> dict[int, SheetEdge]:
        """The same at the start of the window, with the mean velocity over it: it ends where the sheet is.

        Without the nodes that have left in the window.
        """
        ...

    def compliance(self, sections: Sequence[int]) -> Array:
        """Displacement in x, and in z, of the edges in these sections after a window under one newton on each of them.

        (2, k, k) [m/N], symmetric; the sections are those of `edges` and `path`, in their order.
        """
        ...

    def view(self) -> SheetView:
        """The sheet at the end of the window, in arrays of its own."""
        ...

    def save(self) -> Restore:
        """The sheet between two windows; see `Restore`."""
        ...
