"""The sheet whose cracks close: an overloaded cell becomes layered, and goes on carrying what closed cracks can carry.

Nothing is lost at the instant at which a cell begins to crack, so all cells that reach their limit in a sub-step begin
together. A piece is loose when no closed crack presses it any more and its cracks have opened or slipped by h/2, or
slipped by h in any case, or when it has turned by `TURNED`: not when its cells are cracked.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lattice.contact import EdgeContact, edge_displacement, lever_of
from lattice.cracks.begin import face_stresses
from lattice.cracks.engine import CrackingEngine
from lattice.cracks.hinges import DEEP, Hinges, hinges, no_hinges
from lattice.criteria.judge import Standing
from lattice.criteria.table import CRITERIA, Criterion
from lattice.explicit.forces import Touch
from lattice.explicit.window import Window
from lattice.explicit_sheet import CONTACT_TIME, LIVELY, ExplicitSheet
from lattice.floe import LOOSE, Release
from lattice.grid import Array, BoolArray, IntArray
from lattice.outcome import TURNED_TOO_FAR, Outcome
from lattice.sheet import TURNED
from lattice.strain import CellState

PRINCIPAL = (CRITERIA["principal-stress"],)


class CrackingSheet(ExplicitSheet):
    """`ExplicitSheet` with layered cells; ``intact`` are those that have not begun to crack."""

    engine: CrackingEngine
    lively = 0.05 * LIVELY  #: encounters last longer, and a floe that is pressed under water stores more

    def __init__(
        self,
        engine: CrackingEngine,
        *,
        share: float = LOOSE,
        contact_time: float = CONTACT_TIME,
        criteria: tuple[Criterion, ...] = PRINCIPAL,
    ):
        """As `ExplicitSheet`; the strengths of the ice are those of its layers."""
        super().__init__(engine, share=share, contact_time=contact_time, criteria=criteria)
        self._hinges: tuple[bytes, Hinges] | None = None  #: what they were found of, and they

    def _check_rest(self) -> None:
        """Cells that are overloaded at rest begin to crack in the first window."""

    # ---- what begins to crack ---------------------------------------------------------------------------------

    @property
    def standing(self) -> Standing:
        """Cells that are still elastic; their limit is that of the layers, beside a crack as anywhere."""
        key = self.intact.tobytes() + self.present.tobytes()
        if self._known is None or self._known[0] != key:
            live: BoolArray = self.intact & self.present[self.grid.cell_nodes].all(axis=1)
            nowhere, limit = np.zeros(self.grid.cells, bool), np.full(self.grid.cells, self.ice.sigma_t)
            self._known = key, Standing(live, nowhere, limit)
        return self._known[1]

    def _break(self, w: Window, done: int, out: Outcome, release: Release) -> None:  # noqa: ARG002  nothing leaves
        """Cells that reached their limit in the last sub-step begin to crack, all of them."""
        e, now, ended, half = self.engine, w.t + done * self.engine.dt, self._at(0.0), self._at(0.5)
        utilisation = self._utilisation(ended)
        cells = np.flatnonzero(utilisation >= 1.0)
        if not len(cells):
            return
        part = self._reached(cells, utilisation[cells])
        order = np.lexsort((cells, part))
        cells, part = cells[order], part[order]
        if out.failure is None:
            out.failure = (now - (1.0 - part[0]) * e.dt, e.touch(now, w.contact).force)
        self.failed_cells += cells.tolist()
        self.failure_times += (now - (1.0 - part) * e.dt).tolist()
        out.causes += self.judge.causes(ended.u, ended.q, self._eased(), cells)
        out.failed += cells.tolist()
        lean, thick = e.lean_strain()[:, cells], e.varied.thickness[cells]
        state = CellState.of(self.grid, ended.u, ended.q, cells, lean=lean, thick=thick)
        _, angles = face_stresses(state, self.ice)
        self.energy.fracture -= self._swing(cells)
        for cell, angle in zip(cells.tolist(), angles.tolist(), strict=True):
            self.energy.book_failure(cell, half)
            self.energy.fracture -= e.begin(cell, angle)
            self.intact[cell] = False
        e.lose_springs(cells)

    def _eased(self) -> Standing:
        return replace(self.standing, lean=self.engine.lean_strain())

    def _ease(self) -> None:
        """The limit is that of the layers: no cell carries more."""

    def _begin_cracked(self, cells: IntArray, angle: Array) -> None:
        for cell, normal in zip(cells.tolist(), angle.tolist(), strict=True):
            self.engine.begin_cracked(cell, normal)
        self.intact[cells] = False

    # ---- what holds together ----------------------------------------------------------------------------------

    @property
    def joins(self) -> BoolArray:
        """Elastic cells, and layered ones that are not parted, (cells,)."""
        joins = self.intact.copy()
        joins[self.engine.layered.cell[~self._parted()]] = True
        return joins

    @property
    def damage(self) -> Array:
        """Share of the thickness that is cracked across the first crack, (cells,)."""
        damage = np.asarray(~self.intact, np.float64)
        damage[self.engine.layered.cell] = self.engine.layered.depth
        return damage

    @property
    def hinges(self) -> Hinges:
        """What cracks that have passed the middle of the ice divide, at the end of the last window."""
        layered = self.engine.layered
        deep = layered.cell[layered.depth >= DEEP]
        if not len(deep):
            return no_hinges(self.grid.nodes)
        whole = self.joins
        key = whole.tobytes() + deep.tobytes() + self.present.tobytes()
        if self._hinges is None or self._hinges[0] != key:
            whole &= self.present[self.grid.cell_nodes].all(axis=1)
            whole[deep] = False
            self._hinges = key, hinges(self.grid, whole, deep, self.present, self.held, self.share)
        return self._hinges[1]

    def depart(self, nodes: IntArray, live: BoolArray, *, crushed: bool = False) -> None:
        """As `Floe.depart`; a layered cell goes with the first of its nodes, and is booked once."""
        super().depart(nodes, live, crushed=crushed)
        self.engine.layered.drop(self._gone())

    def _gone(self) -> BoolArray:
        """Layered cells that have lost a node, (count,)."""
        return np.asarray(~self.present[self.grid.cell_nodes[self.engine.layered.cell]].all(axis=1))

    def _parted(self) -> BoolArray:
        """Layered cells whose crack is through, pressed by nothing, and open or slipped by h/2, (count,)."""
        layered = self.engine.layered
        return layered.parted(self.grid.d, self.ice.h * self.engine.varied.thickness[layered.cell])

    def let_go(self, t: float, contact: EdgeContact, out: Outcome, release: Release) -> None:
        """At the start of a window: pieces that nothing presses any more, and those that have turned too far."""
        rotation = np.where(self.present, np.abs(self.state.q[:, 1:]).max(axis=1), 0.0)
        turned = None
        if rotation.max() > TURNED:
            turned = rotation > 0.5 * TURNED
            corners = turned[self.grid.cell_nodes]
            self._cut(np.asarray(corners.any(axis=1) & ~corners.all(axis=1)), out)
        elif not self._parted().any():
            return
        self._release_loose(out, release, turned)
        if out.pieces:
            out.failure = t, contact.evaluate(t, edge_displacement(self.state, contact.nodes, lever_of(contact)))[0]

    def _cut(self, mask: BoolArray, out: Outcome) -> None:
        """Cells that part a piece which has turned too far carry nothing any more."""
        cells = np.flatnonzero(mask & self.live_cells)
        for cell in cells.tolist():
            self.energy.book_failure(cell, self.state)
        self.intact[cells] = False
        out.failed += cells.tolist()
        out.causes += [TURNED_TOO_FAR] * len(cells)
        self.energy.fracture += self.engine.lose(mask[self.engine.layered.cell], self.state)

    def _book_half(self, part: float, w: Window, touch: Touch) -> None:
        super()._book_half(part, w, touch)
        self.engine.book_pull(part * self.engine.dt)
