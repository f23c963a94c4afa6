"""The sheet: lattice, state and the cascade of failures within one step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from lattice.criteria import cell_strains, combined_utilisation, tensile_limits
from lattice.engine import EdgeContact, Engine, State
from lattice.fragments import front_rows, loose_pieces
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.stiffness import Springs


@dataclass
class Outcome:
    """What happened in one step."""

    contact_mean: Array  #: contact force on the edge nodes, mean over the step, (m, 3) [N]
    contact_end: Array  #: the same at its end
    failed: list[int] = field(default_factory=list)  #: cells in the order in which they failed
    pieces: list[IntArray] = field(default_factory=list)  #: nodes of the pieces that left, in order
    parts: int = 1  #: parts of the sheet that stay in the lattice


class Sheet:
    """A floe of intact and failed cells that drifts with its frame."""

    def __init__(self, grid: Grid, ice: Ice, springs: Springs, dt: float, *, held: np.ndarray, damping: float = 0.0,
                 alpha: float = 0.0, share: float = 0.2):
        """``held`` (nodes,) nodes that cannot move in plane; ``damping``, ``alpha`` as in `Engine`.

        A free piece with less than ``share`` of the floe's area leaves the lattice (see `fragments.loose_pieces`).
        """
        self.grid, self.ice, self.held, self.share = grid, ice, held, share
        self.intact = np.ones(grid.cells, bool)
        self.present = np.ones(grid.nodes, bool)
        self.state = State.rest(grid.nodes)
        self.engine = Engine(grid, ice, springs, dt, intact=self.intact, held_in_plane=held, damping=damping,
                             alpha=alpha)
        self.utilisation = np.zeros(grid.cells)
        self.parts = 1

    def advance(self, t: float, force_u: Array, force_q: Array, contact: EdgeContact,
                release: Callable[[IntArray], None]) -> Outcome:
        """One step from time t with failures.

        The most overloaded cell is removed and the same step is solved again from its start, until no cell is
        overloaded (thesis 4.2.1; one cell at a time, so that the order of a cascade is that of the utilisation).
        A piece that comes loose leaves at once with its state at the start of the step: ``release`` is called with
        its nodes and must renew the edge of ``contact``.
        """
        out = Outcome(np.empty((0, 3)), np.empty((0, 3)), parts=self.parts)
        while True:
            force_u[~self.present], force_q[~self.present] = 0.0, 0.0
            step = self.engine.step(t, self.state, force_u, force_q, contact)
            utilisation = self._utilisation(step.state)
            worst = int(np.argmax(utilisation))
            if utilisation[worst] < 1.0:
                break
            self._fail(worst)
            out.failed.append(worst)
            self._release_loose(out, release)
        self.state, self.utilisation = step.state, utilisation
        out.contact_mean, out.contact_end, out.parts = step.contact_mean, step.contact_end, self.parts
        return out

    def _utilisation(self, state: State) -> Array:
        strains = cell_strains(self.grid.cell_nodes, self.grid.d, state.u, state.q)
        utilisation = combined_utilisation(strains, tensile_limits(self.grid, self.live_cells, self.ice), self.ice)
        if not np.isfinite(utilisation).all():
            raise FloatingPointError("the sheet's motion is not finite: use a shorter window (coupling.window)")
        return np.where(self.live_cells, utilisation, 0.0)

    def _fail(self, cell: int) -> None:
        self.intact[cell] = False
        self.engine.remove(np.array([cell]))

    def _release_loose(self, out: Outcome, release: Callable[[IntArray], None]) -> None:
        pieces, self.parts = loose_pieces(self.grid, self.intact, self.present, self.held, self.share)
        for piece in pieces:
            self.present[piece] = False
            out.pieces.append(piece)
            release(piece)

    def retire(self, nodes: IntArray) -> None:
        """Takes nodes out whose ice is gone (crushed), with the cells that they hold up."""
        self.present[nodes] = False
        cells = np.flatnonzero(np.isin(self.grid.cell_nodes, nodes).any(axis=1) & self.intact)
        self.intact[cells] = False
        if len(cells):
            self.engine.remove(cells)

    @property
    def live_cells(self) -> np.ndarray:
        """Intact cells whose nodes are all still in the lattice, (cells,)."""
        return self.intact & self.present[self.grid.cell_nodes].all(axis=1)

    @property
    def front(self) -> IntArray:
        """Row of the foremost node of each column, -1 where there is none."""
        return front_rows(self.grid, self.present)
