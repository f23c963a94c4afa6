"""The sheet: lattice, state and the failures within one window.

A window of length dt is solved in one step. If a cell is overloaded at its end, the instant at which its utilisation
reached 1 is located on the step's interpolation, the cell is removed and the same window is solved again, until no
cell is overloaded (thesis 4.2.1; one cell at a time, so that the order of a cascade is that of the utilisation).

While nothing but the structure loads the sheet, one long step is taken ahead and the windows are read off its
interpolation until a cell fails. A long step is refused when its error estimate exceeds `LONG_STEP_ERROR`; the next
try is half as long, and after an accepted one twice as long. The window of a failure is always solved on its own.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field, replace

import numpy as np

from lattice.criteria import cell_strains, combined_utilisation, tensile_limits
from lattice.energy import EnergyBooks
from lattice.engine import EdgeContact, Engine, NoContact, State, Step, StepError, point_displacement
from lattice.fragments import front_rows, loose_pieces
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.memory import Memory, recall, remember
from lattice.reaction import Reaction, Support, between, of_cubic, of_step
from lattice.stiffness import Springs
from lattice.stock import Served

LONG_STEP_ERROR = 2e-4  #: largest estimated error of a displacement in a long step, as share of the thickness
QUIET = 8  #: windows without a failure before the next long step: waves of the crack must have died down
LOCATION = 1e-4  #: share of a window to which a failure is located
TURNED = 0.1  #: rotation out of plane at which a hanging piece leaves: 1 - cos = 0.5 %, the lattice is linear [rad]


@dataclass
class Outcome:
    """What happened in one window."""

    contact_mean: Array  #: contact force on the edge nodes, mean over the window, (m, 3) [N]
    contact_end: Array  #: the same at its end
    failed: list[int] = field(default_factory=list)  #: cells in the order in which they failed
    pieces: list[IntArray] = field(default_factory=list)  #: nodes of the pieces that left, in order
    parts: int = 1  #: parts of the sheet that stay in the lattice
    failure: tuple[float, Array] | None = None  #: time of the first failure [s] and contact force then (m, 3) [N]
    reaction: Reaction = field(default_factory=Reaction)  #: what carries the sheet beside its contact


@dataclass
class LongStep:
    """A step over several windows, served window by window; its contact acts at one height throughout."""

    step: Step
    windows: int
    served: int = 0
    contact: Array = field(default_factory=lambda: np.empty((0, 3)))  #: force at the last window's end
    done: Served = field(default_factory=Served)  #: of the contact in the windows served, by the trapezoidal rule

    def __copy__(self) -> LongStep:
        """A copy with books of its own, see `memory.remember`."""
        return replace(self, done=deepcopy(self.done))


class Sheet:
    """A floe of intact and failed cells that drifts with its frame."""

    _written: tuple[str, ...] = ("intact", "present", "energy", "_long")  #: see `memory.remember`

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        dt: float,
        *,
        held: np.ndarray,
        damping: float = 0.0,
        alpha: float = 0.0,
        share: float = 0.2,
        long_step: int = 1,
    ):
        """``held``, ``damping``, ``alpha`` as in `Engine`; a piece with a held node is not loose.

        A free piece with less than ``share`` of the floe's area leaves the lattice (see `fragments.loose_pieces`).
        ``long_step`` is the largest number of windows in one step.
        """
        self.grid, self.ice, self.share, self.dt = grid, ice, share, dt
        self.held = np.asarray(held.reshape(grid.nodes, -1).any(axis=1))  #: nodes held in some direction, (nodes,)
        self.intact = np.ones(grid.cells, bool)
        self.present = np.ones(grid.nodes, bool)
        self.state = State.rest(grid.nodes)
        self.engine = Engine(grid, ice, springs, held_in_plane=held, damping=damping, alpha=alpha)
        self.engine.use(dt)
        self.energy = EnergyBooks(self.engine)
        self.support = Support(self.engine, held)
        self.utilisation = np.zeros(grid.cells)
        self.parts = 1
        self._longest, self._windows, self._wait = long_step, min(2, long_step), 0
        self._longest_time = long_step * dt
        self._known: tuple[bytes, np.ndarray, Array] | None = None
        self._long: LongStep | None = None

    def save(self) -> Memory:
        """The sheet between two windows, for `restore`. The contact is not part of it."""
        return [*remember(self, *self._written), *self.engine.save()]

    def restore(self, saved: Memory) -> None:
        """Sets the sheet back; what follows has the bits of what followed the first time."""
        recall(saved)

    def set_window(self, dt: float) -> None:
        """Length of the windows from now on [s]; a long step, which is cut into equal windows, is given up."""
        if dt != self.dt:
            self._drop_long_step()
            self._longest = max(1, round(self._longest_time / dt))
            self.dt, self._windows = dt, min(2, self._longest)

    def rest_under(self, force_u: Array, force_q: Array) -> None:
        """Puts the unbroken sheet into equilibrium with forces (n, 2), (n, 3); StepError if they break it."""
        self.state = self.engine.equilibrium(force_u, force_q)
        self.utilisation = self._utilisation(self.state)
        if self.utilisation.max() >= 1.0:
            raise StepError(f"the sheet at rest breaks under its load (utilisation {self.utilisation.max():.2f})")
        self.energy.begin(self.state, self.live_cells, self.present)

    def answer(self, nodes: IntArray) -> tuple[Array, Array]:
        """Displacements (k, 2) [m/N] and velocities (k, 2) [m/(N s)] of nodes in x and z, at the end of a window in
        which one newton has pressed on each of them, in x and in z.
        """
        force_u, force_q = np.zeros((self.grid.nodes, 2)), np.zeros((self.grid.nodes, 3))
        force_u[nodes, 0] = force_q[nodes, 0] = 1.0
        s = self.engine.step(0.0, self.dt, State.rest(self.grid.nodes), force_u, force_q, NoContact()).state
        return (
            np.column_stack((s.u[nodes, 0], s.q[nodes, 0])),
            np.column_stack((s.u_dot[nodes, 0], s.q_dot[nodes, 0])),
        )

    def advance(
        self, t: float, force_u: Array, force_q: Array, contact: EdgeContact, release: Callable[[IntArray], None]
    ) -> Outcome:
        """One window from time t under constant external forces (n, 2), (n, 3).

        A piece that comes loose leaves at once with its state at the start of the window: ``release`` is called with
        its nodes and must renew the edge of ``contact``.
        """
        force_u[~self.present], force_q[~self.present] = 0.0, 0.0
        if force_u.any() or force_q.any() or self._rotation().max() > TURNED:
            self._drop_long_step()
        else:
            out = self._from_long_step(t, force_u, force_q, contact)
            if out is not None:
                return out
        return self._solve_window(t, force_u, force_q, contact, release)

    # ---- long steps -------------------------------------------------------------------------------------------

    def _from_long_step(self, t: float, force_u: Array, force_q: Array, contact: EdgeContact) -> Outcome | None:
        """The window read off a long step, taken if there is none under way; None where it must be solved."""
        if self._long is None and not self._take_long_step(t, force_u, force_q, contact):
            return None
        plan = self._long
        assert plan is not None
        state = plan.step.at((plan.served + 1) / plan.windows)
        utilisation = self._utilisation(state)
        if utilisation.max() >= 1.0:
            self._drop_long_step()
            return None
        end = edge_displacement(state, contact.nodes, plan.step.height)
        force = contact.evaluate(t + self.dt, end)[0]
        out = Outcome(0.5 * (plan.contact + force), force, parts=self.parts)
        way = end - edge_displacement(self.state, contact.nodes, plan.step.height)
        plan.done.touch.add(self.dt, out.contact_mean, way / self.dt)
        plan.done.rub.add(self.dt, self.energy.friction_of(end, out.contact_mean), way / self.dt)
        mean = of_cubic(self.state, state, self.dt)
        out.reaction = between(self.support, self.state, state, self.dt, mean, self.live_cells, self.present)
        self.state, self.utilisation = state, utilisation
        plan.contact, plan.served = force, plan.served + 1
        if plan.served == plan.windows:
            self.energy.book_step(plan.step, force_u, force_q, contact.nodes, self.live_cells, self.present)
            self._long = None
        return out

    def _take_long_step(self, t: float, force_u: Array, force_q: Array, contact: EdgeContact) -> bool:
        if self._wait > 0 or self._longest == 1:
            self._wait -= 1
            return False
        step = self.engine.step(t, self._windows * self.dt, self.state, force_u, force_q, contact)
        if step.error > LONG_STEP_ERROR * self.ice.h:
            self._wait, self._windows = self._windows, max(self._windows // 2, 2)
            return False
        start = contact.evaluate(t, edge_displacement(self.state, contact.nodes, contact.height))[0]
        self._long = LongStep(step, self._windows, contact=start)
        self._windows = min(2 * self._windows, self._longest)
        return True

    def _drop_long_step(self) -> None:
        """Goes on from the last window served."""
        if (plan := self._long) is not None:
            states = [plan.step.at(k / plan.windows) for k in range(plan.served + 1)]
            loss = [self.energy.loss_rate(s, self.live_cells, self.present) for s in states]
            hold = [self.energy.holding(s.u, s.u_dot, np.zeros_like(s.u), self.live_cells) for s in states]
            plan.done.damping = self.dt * (sum(loss) - 0.5 * (loss[0] + loss[-1]))
            plan.done.hold = self.dt * (sum(hold) - 0.5 * (hold[0] + hold[-1]))
            self.energy.book_served(plan.done, self.state, self.live_cells, self.present)
            self._long, self._windows = None, min(2, self._longest)

    # ---- one window -------------------------------------------------------------------------------------------

    def _solve_window(
        self, t: float, force_u: Array, force_q: Array, contact: EdgeContact, release: Callable[[IntArray], None]
    ) -> Outcome:
        out = Outcome(np.empty((0, 3)), np.empty((0, 3)))
        if self._rotation().max() > TURNED:
            self._tear_off(t, contact, out, release)
            force_u[~self.present], force_q[~self.present] = 0.0, 0.0
        while True:
            step = self.engine.step(t, self.dt, self.state, force_u, force_q, contact)
            utilisation = self._utilisation(step.state)
            worst = int(np.argmax(utilisation))
            if utilisation[worst] < 1.0:
                break
            if out.failure is None:
                out.failure = self._locate(t, step, contact)
            self._fail(worst)
            out.failed.append(worst)
            self._release_loose(out, release)
            force_u[~self.present], force_q[~self.present] = 0.0, 0.0
        self.energy.book_step(step, force_u, force_q, contact.nodes, self.live_cells, self.present)
        applied = self.support.applied(slice(None), force_u[:, 0], force_q[:, 0])
        out.reaction = between(
            self.support, self.state, step.state, self.dt, of_step(step), self.live_cells, self.present, applied
        )
        self.state, self.utilisation = step.state, utilisation
        if out.failed:
            self._wait, self._windows = QUIET, min(2, self._longest)
        out.contact_mean, out.contact_end, out.parts = step.contact_mean, step.contact_end, self.parts
        return out

    def _locate(self, t: float, step: Step, contact: EdgeContact) -> tuple[float, Array]:
        """Instant at which the first utilisation reaches 1, by bisection, and the contact force then."""
        low, high = 0.0, 1.0
        while high - low > LOCATION:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self._utilisation(step.at(middle)).max() >= 1.0 else (middle, high)
        time = t + high * self.dt
        return time, contact.evaluate(time, edge_displacement(step.at(high), contact.nodes, step.height))[0]

    def _utilisation(self, state: State) -> Array:
        strains = cell_strains(self.grid.cell_nodes, self.grid.d, state.u, state.q)
        utilisation = combined_utilisation(strains, self._limits(), self.ice)
        if not np.isfinite(utilisation).all():
            raise FloatingPointError("the sheet's motion is not finite: use a shorter window (coupling.window)")
        return np.where(self.live_cells, utilisation, 0.0)

    def _limits(self) -> Array:
        return self._cells()[1]

    def _cells(self) -> tuple[np.ndarray, Array]:
        """Live cells and their tensile limits, kept until a cell fails or a node leaves."""
        key = self.intact.tobytes() + self.present.tobytes()
        if self._known is None or self._known[0] != key:
            live: np.ndarray = self.intact & self.present[self.grid.cell_nodes].all(axis=1)
            self._known = key, live, tensile_limits(self.grid, live, self.ice)
        return self._known[1:]

    def _fail(self, cell: int) -> None:
        self.energy.book_failure(cell, self.state)
        self.intact[cell] = False
        self.engine.remove(np.array([cell]))

    def _release_loose(
        self, out: Outcome, release: Callable[[IntArray], None], turned: np.ndarray | None = None
    ) -> None:
        pieces, self.parts = loose_pieces(self.grid, self.intact, self.present, self.held, self.share, turned)
        for piece in pieces:
            live = self.live_cells
            self.present[piece] = False
            self.energy.book_departure(piece, live & ~self.live_cells, self.state)
            out.pieces.append(piece)
            release(piece)

    def _rotation(self) -> Array:
        """Larger of the two rotations of each node that is present, (nodes,) [rad]."""
        return np.where(self.present, np.abs(self.state.q[:, 1:]).max(axis=1), 0.0)

    def _tear_off(self, t: float, contact: EdgeContact, out: Outcome, release: Callable[[IntArray], None]) -> None:
        """Parts a piece that has turned out of the range of small rotations, with what has gone half as far.

        A part that has turned as a whole leaves too, whatever its size and wherever it is held in the plane.
        """
        turned = self._rotation() > 0.5 * TURNED
        corners = turned[self.grid.cell_nodes]
        cells = np.flatnonzero(self.live_cells & corners.any(axis=1) & ~corners.all(axis=1)).tolist()
        force = contact.evaluate(t, edge_displacement(self.state, contact.nodes, contact.height))[0]
        for cell in cells:
            self._fail(cell)
        out.failed += cells
        self._release_loose(out, release, turned)
        if cells or out.pieces:
            out.failure = t, force

    def retire(self, nodes: IntArray) -> None:
        """Takes nodes out whose ice is gone (crushed), with the cells that they hold up."""
        self._drop_long_step()
        live = self.live_cells
        self.present[nodes] = False
        cells = np.flatnonzero(np.isin(self.grid.cell_nodes, nodes).any(axis=1) & self.intact)
        self.energy.book_departure(nodes, live & ~self.live_cells, self.state, crushed=True)
        self.intact[cells] = False
        if len(cells):
            self.engine.remove(cells)

    @property
    def live_cells(self) -> np.ndarray:
        """Intact cells whose nodes are all still in the lattice, (cells,). Not to be written to."""
        return self._cells()[0]

    @property
    def front(self) -> IntArray:
        """Row of the foremost node of each column, -1 where there is none."""
        return front_rows(self.grid, self.present)


def edge_displacement(state: State, nodes: IntArray, height: Array) -> Array:
    """Displacement of the points of edge nodes at these heights (m,), as an `EdgeContact` takes them, (m, 3) [m]."""
    return point_displacement(state.u, state.q, nodes, height)
