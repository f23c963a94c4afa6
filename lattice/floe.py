"""A floe of intact and failed cells: what both engines share, whatever their steps.

A cell that reaches its limit gives way (`Floe.give_way`): its springs go, its mass stays (thesis 4.2.1). A piece that
is held by nothing any more leaves at once, inside the cascade: otherwise the unsupported piece is torn to single cells
by loads that it cannot react.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

import numpy as np

from lattice.contact import EdgeContact, NoContact
from lattice.cracks.hinges import Hinges, no_hinges
from lattice.criteria.judge import EVERY, Judge, Standing
from lattice.criteria.table import THESIS, Criterion
from lattice.energy import EnergyBooks
from lattice.fragments import front_rows, loose_pieces
from lattice.grid import Array, BoolArray, IntArray
from lattice.implicit.engine import Engine
from lattice.loads import Loads, total
from lattice.memory import Memory, recall, remember
from lattice.outcome import Outcome
from lattice.reaction import Support
from lattice.state import State, StepError
from lattice.tops import NAMES, Tops

#: area of a free piece that leaves the lattice, as a share of the floe: a larger part floats on as a floe of its own,
#: as the halves of a split floe do (thesis 6.3); a smaller one can only be a block before the structure [-]
LOOSE = 0.2

Release = Callable[[IntArray], None]  #: called with the nodes of a piece that leaves; must renew the contact's edge


class Floe(ABC):
    """Lattice, state and failures of a floe that drifts with its frame."""

    _written: tuple[str, ...] = ("intact", "present", "energy", "tops")  #: see `memory.remember`

    def __init__(
        self,
        engine: Engine,
        dt: float,
        *,
        share: float = LOOSE,
        criteria: tuple[Criterion, ...] = THESIS,
    ):
        """Windows last ``dt`` [s]. A piece with a node that the engine holds along the drift is not loose.

        A free piece with less than ``share`` of the floe's area leaves the lattice (see `fragments.loose_pieces`).
        ValueError where a criterion needs a strength that the ice does not have.
        """
        grid = self.grid = engine.grid
        self.ice, self.share, self.dt, self.engine = engine.ice, share, dt, engine
        self.judge = Judge(grid, engine.ice, criteria, engine.varied)
        self.held = np.ascontiguousarray(engine.held[:, 0])  #: nodes held along the drift, (nodes,)
        self.intact = np.ones(grid.cells, bool)
        self.present = np.ones(grid.nodes, bool)
        self.state = State.rest(grid.nodes)
        self.energy = EnergyBooks(engine)
        self.support = Support(engine)
        self.utilisation = np.zeros(grid.cells)
        self.parts = 1
        self.tops: Tops | None = None  #: what the water does beyond the foundation; None: it is linear without end
        self._known: tuple[bytes, Standing] | None = None

    def flood(self, filling_rate: float) -> None:
        """From now on tops under water fill, by this part of their head per second, and lifted ice leaves the water.

        See `tops`. ValueError if the rate is negative or no number.
        """
        self.tops = Tops.of(self.engine, filling_rate)
        for name in NAMES:
            self.energy.load(name)

    def advance(self, t: float, loads: Loads, contact: EdgeContact, release: Release) -> Outcome:
        """One window from time t under constant loads, and under the water that the foundation does not know.

        A piece that comes loose leaves at once: ``release`` is called with its nodes and must renew the edge of
        ``contact``. StepError where no solution is found.
        """
        if self.tops is None:
            return self._advance(t, loads, contact, release)
        water = self.tops.loads(self.state, self.present, self.dt)
        out = self._advance(t, [*loads, *water], contact, release)
        for name in NAMES:
            out.reaction.applied.setdefault(name, (0.0, 0.0))
        return out

    @abstractmethod
    def _advance(self, t: float, loads: Loads, contact: EdgeContact, release: Release) -> Outcome:
        """The same under ``loads`` alone."""

    @abstractmethod
    def set_window(self, dt: float) -> None:
        """Length of the windows from now on [s]."""

    def window_by_window(self) -> None:  # noqa: B027 - only some take any
        """From now on no window is taken ahead: what the edge meets then is not known."""

    # ---- between two windows ----------------------------------------------------------------------------------

    def save(self) -> Memory:
        """The sheet between two windows, for `restore`. The contact is not part of it."""
        return [*remember(self, *self._written), *self.engine.save()]

    def restore(self, saved: Memory) -> None:
        """Sets the sheet back; what follows has the bits of what followed the first time."""
        recall(saved)

    def rest_under(self, loads: Loads) -> None:
        """Puts the unbroken sheet into equilibrium with loads; StepError if they break it."""
        self.state = self.engine.equilibrium(*total(loads, self.grid.nodes))
        self.utilisation = self._utilisation(self.state)
        self._check_rest()
        if self.tops is not None:
            self.tops.check_rest(self.state.q[:, 0])
        self.energy.begin(self.state, self.live_cells, self.present, loads)

    def _check_rest(self) -> None:
        """Refuses a start at which cells have given way already."""
        if self.utilisation.max() >= 1.0:
            raise StepError(f"the sheet at rest breaks under its load (utilisation {self.utilisation.max():.2f})")

    def answer(self, nodes: IntArray) -> tuple[Array, Array]:
        """Displacements (k, 2) [m/N] and velocities (k, 2) [m/(N s)] of nodes in x and z under one newton on each.

        At the end of a window in which it has pressed on all of them, in x and in z.
        """
        force_u, force_q = np.zeros((self.grid.nodes, 2)), np.zeros((self.grid.nodes, 3))
        force_u[nodes, 0] = force_q[nodes, 0] = 1.0
        s = self.engine.step(0.0, self.dt, State.rest(self.grid.nodes), force_u, force_q, NoContact()).state
        return (
            np.column_stack((s.u[nodes, 0], s.q[nodes, 0])),
            np.column_stack((s.u_dot[nodes, 0], s.q_dot[nodes, 0])),
        )

    def retire(self, nodes: IntArray) -> None:
        """Takes nodes out whose ice is gone (crushed), with the cells that they hold up."""
        live = self.live_cells
        self.present[nodes] = False
        cells = np.flatnonzero(np.isin(self.grid.cell_nodes, nodes).any(axis=1) & self.intact)
        self.depart(nodes, live, crushed=True)
        self.intact[cells] = False
        if len(cells):
            self.engine.remove(cells)

    def begin_broken(self, gone: BoolArray, cracked: IntArray, angle: Array) -> None:
        """Cracks and lost ice from before the first window: nodes that are ``gone`` (nodes,), ``cracked`` cells (k,).

        Cracks are through and closed, ``angle`` (k,) is that of their normals from the x axis [rad]. ValueError where
        they cut off what nothing holds.
        """
        self.present[gone] = False
        self._begin_cracked(cracked, angle)
        out = np.flatnonzero(gone[self.grid.cell_nodes].any(axis=1))
        self.intact[out] = False
        self.engine.remove(out)
        pieces, self.parts = loose_pieces(self.grid, self.joins, self.present, self.held, self.share)
        if pieces:
            x, y = self.grid.xy[pieces[0][0]] - self.grid.xy[0]
            raise ValueError(
                f"cracks cut {len(pieces)} pieces off that nothing holds, the first at x = {x:g} m, y = {y:g} m from "
                "the rear corner; say that they are gone, or leave a crack out"
            )
        self.energy.measure(self.state, self.live_cells, self.present)

    def _begin_cracked(self, cells: IntArray, angle: Array) -> None:  # noqa: ARG002  open cracks have no direction
        self.intact[cells] = False
        self.engine.remove(cells)

    def depart(self, nodes: IntArray, live: BoolArray, *, crushed: bool = False) -> None:
        """Books ice that has left with its ``nodes``; ``live`` (cells,) are the cells that were live before."""
        self.energy.book_departure(nodes, live & ~self.live_cells, self.state, crushed=crushed)

    # ---- which cells hold -------------------------------------------------------------------------------------

    @property
    def standing(self) -> Standing:
        """Live cells with their limits, kept until a cell fails or a node leaves."""
        key = self.intact.tobytes() + self.present.tobytes()
        if self._known is None or self._known[0] != key:
            live: BoolArray = self.intact & self.present[self.grid.cell_nodes].all(axis=1)
            self._known = key, self.judge.standing(live)
        return self._known[1]

    @property
    def live_cells(self) -> BoolArray:
        """Intact cells whose nodes are all still in the lattice, (cells,). Not to be written to."""
        return self.standing.live

    @property
    def joins(self) -> BoolArray:
        """Cells that hold their nodes together, (cells,)."""
        return self.intact

    @property
    def damage(self) -> Array:
        """How far each cell is broken, 0 to 1, (cells,)."""
        return np.asarray(~self.intact, np.float64)

    @property
    def hinges(self) -> Hinges:
        """Cracks that go on carrying load, and what they divide."""
        return no_hinges(self.grid.nodes)

    @property
    def front(self) -> IntArray:
        """Row of the foremost node of each column, -1 where there is none."""
        return front_rows(self.grid, self.present)

    def _utilisation(self, state: State, cells: IntArray | slice = EVERY) -> Array:
        return self.judge.utilisation(state.u, state.q, self.standing, cells)

    # ---- failure ----------------------------------------------------------------------------------------------

    def fail(self, cells: Sequence[int], causes: Sequence[str], state: State, out: Outcome) -> None:
        """Cells give way in this order; ``state`` is the one whose elastic energy they lose."""
        for cell, cause in zip(cells, causes, strict=True):
            self.energy.book_failure(cell, state)
            self.intact[cell] = False
            out.failed.append(cell)
            out.causes.append(cause)
        self.give_way(np.asarray(cells, np.int64))

    def give_way(self, cells: IntArray) -> None:
        """What becomes of overloaded cells, which no longer count as intact: the engine loses them.

        A law of cracks that go on carrying load replaces this.
        """
        self.engine.remove(cells)

    def _release_loose(self, out: Outcome, release: Release, turned: BoolArray | None = None) -> None:
        """Lets pieces go that nothing holds, and those of which every node has ``turned`` (nodes,)."""
        pieces, self.parts = loose_pieces(self.grid, self.joins, self.present, self.held, self.share, turned)
        for piece in pieces:
            live = self.live_cells
            self.present[piece] = False
            self.depart(piece, live)
            out.pieces.append(piece)
            release(piece)
