"""The cells of a running sheet, watched: the stresses at which they begin to crack, and those of the most used ones.

Of a cell that fails the state is kept that is nearer to its limit: that in which it was found overloaded, or the one
that was judged last, which on the implicit engine is the one that was located.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Self

import numpy as np

from cosim.stresses import Line, Stresses
from coupling.scheduler import Scheduler
from lattice.criteria.judge import EVERY, Judge, Standing
from lattice.criteria.laws import BETA, INTERCEPT, SLOPE
from lattice.criteria.mohr import Circle, circle, circle_of_connections, faces
from lattice.floe import Floe
from lattice.grid import Array, BoolArray, IntArray
from lattice.ice import Ice
from lattice.strain import CellState

WORST = 24  #: cells of a recorded frame that are kept, those of the largest utilisation
LEAST = 0.1  #: utilisation below which a cell is not kept

Circles = Callable[[CellState, Ice], list[Circle]]


def _bent(*sides: float) -> Circles:
    return lambda state, ice: [circle(state.strains.bending_only(), side * 0.5 * ice.h) for side in sides]


def _beside_crack(state: CellState, ice: Ice) -> list[Circle]:
    """The face that is stretched, (4.24), (4.25)."""
    mean, radius = circle_of_connections(state.bending)
    return [Circle(0.5 * ice.h * np.abs(mean), 0.5 * ice.h * radius)]


#: circles of strain of the faces that a criterion looks at, the worse of which counts
CIRCLES: dict[str, Circles] = {
    "combined-tension": lambda state, ice: list(faces(state.strains, ice)),
    "combined-compression": lambda state, ice: list(faces(state.strains, ice)),
    "principal-stress": lambda state, ice: list(faces(state.strains, ice)),
    "tension": lambda state, _: [circle(state.strains)],
    "compression": lambda state, _: [circle(state.strains)],
    "spalling": lambda state, _: [circle(state.strains)],
    "bending-top": _bent(1.0),
    "bending-bottom": _bent(-1.0),
    "upward-bending": _bent(-1.0),
    "downward-bending": _bent(1.0),
    "crack-tip-splitting": lambda state, _: [circle_of_connections(state.membrane)],
    "crack-tip-bending": _beside_crack,
}


def line_of(name: str, ice: Ice, d: float) -> Line | None:
    """Of a criterion in cells of size ``d`` [m]; None for one that looks at no circle (out-of-plane shear)."""
    tensile = {
        "combined-tension": (ice.sigma_t, ice.sigma_t),
        "tension": (ice.sigma_t, ice.sigma_t),
        "bending-top": (ice.sigma_f, ice.sigma_f),
        "bending-bottom": (ice.sigma_f, ice.sigma_f),
        "upward-bending": (ice.sigma_f_upward, ice.sigma_f_upward),
        "downward-bending": (ice.sigma_f_downward, ice.sigma_f_downward),
        "crack-tip-splitting": (ice.sigma_t, float(np.sqrt(2.0 / (np.pi * d))) * ice.K_IC),
    }
    if name == "crack-tip-bending":
        return _tensile(ice, ice.sigma_f, ice.stress_beside_crack(d))
    if name in tensile:
        return _tensile(ice, *tensile[name])
    if name in ("combined-compression", "compression"):  # (4.5)
        across = (1.0 + ice.nu) * (np.sin(2.0 * BETA) + SLOPE * np.cos(2.0 * BETA)) / INTERCEPT
        return Line(SLOPE * (1.0 - ice.nu) / INTERCEPT, float(across), ice.sigma_c)
    if name == "spalling":  # (4.9)
        return Line(-2.0, 0.0, -ice.sigma_spall)
    return Line(1.0, 1.0, ice.sigma_t) if name == "principal-stress" else None


def _tensile(ice: Ice, strength: float, limit: float) -> Line:
    """(4.6): q s + t = (1 + q) / 2 strength, with q from the compressive over this strength."""
    ratio = ice.sigma_c / strength
    q = 1.0 if np.isinf(ratio) else (ratio - 1.0) / (ratio + 1.0)
    return Line(2.0 * q / (1.0 + q), 2.0 / (1.0 + q), limit)


class Watching(Judge):
    """A judge that keeps the stresses at which cells reach their limit, until they are asked for."""

    lines: dict[str, Line]  #: of the criteria that have a place in the plane
    _reached: dict[int, tuple[float, ...]]  #: by cell: miss of its limit, criterion, mean, radius, limit
    _last: tuple[Array, Array, Standing] | None

    @classmethod
    def of(cls, judge: Judge) -> Self:
        """The same judge, its arrays shared."""
        new = cls.__new__(cls)
        vars(new).update(vars(judge), _reached={}, _last=None)
        found = {c.name: line_of(c.name, judge.ice, judge.grid.d) for c in judge.criteria}
        new.lines = {name: line for name, line in found.items() if line is not None}
        return new

    def __getstate__(self) -> dict[str, Any]:
        """What a checkpoint keeps: between two windows nothing is left of what is watched."""
        return {name: value for name, value in vars(self).items() if name not in ("_reached", "_last")}

    def utilisation(self, u: Array, q: Array, standing: Standing, cells: IntArray | slice = EVERY) -> Array:
        """As `Judge.utilisation`."""
        self._last = u, q, standing
        return super().utilisation(u, q, standing, cells)

    def causes(self, u: Array, q: Array, standing: Standing, cells: IntArray) -> list[str]:
        """As `Judge.causes`; of this state and the one judged last, that which is nearer to the limit is kept."""
        for cell in cells.tolist():
            self._reached.pop(cell, None)
        judged = [] if self._last is None else [self._last]
        for state in ((u, q, standing), *judged):
            found = self.stresses(*state, cells)
            miss = np.abs(found.utilisation - 1.0)
            rows = np.column_stack((miss, found.criterion, found.mean, found.radius, found.limit)).tolist()
            for cell, row in zip(found.cell.tolist(), rows, strict=True):
                if cell not in self._reached or row[0] < self._reached[cell][0]:
                    self._reached[cell] = tuple(row)
        return super().causes(u, q, standing, cells)

    def reached(self, broken: BoolArray) -> Stresses:
        """Stresses at which cells that are now ``broken`` (cells,) reached their limit; all are forgotten then."""
        kept = {cell: row for cell, row in self._reached.items() if broken[cell]}
        self._reached = {}
        values = np.array(list(kept.values())).reshape(-1, 5)
        cells, criterion = np.array(list(kept), np.int64), values[:, 1].astype(np.int64)
        return Stresses(self.lines, cells, criterion, values[:, 2], values[:, 3], values[:, 4])

    def now(self, u: Array, q: Array, cells: IntArray) -> Stresses:
        """Of these cells, against the limits that were asked for last."""
        if self._last is None:
            return Stresses.none(self.lines)
        return self.stresses(u, q, self._last[2], cells)

    def stresses(self, u: Array, q: Array, standing: Standing, cells: IntArray) -> Stresses:
        """Of these cells at a state; those whose criterion has no place in the plane are left out."""
        lean = None if standing.lean is None else standing.lean[:, cells]
        state = CellState.of(self.grid, u, q, cells, standing.limit[cells], lean, self.varied.thickness[cells])
        worst = np.argmax(self._each(state, standing.beside[cells]), axis=0)
        names = [c.name for c in self.criteria]
        if not self.lines:
            return Stresses.none(self.lines)
        parts = [
            self._on_line(number, name, cells, state, np.flatnonzero(worst == names.index(name)))
            for number, name in enumerate(self.lines)
        ]
        return Stresses(self.lines, *(np.concatenate(column) for column in zip(*parts, strict=True)))

    def _on_line(self, number: int, name: str, cells: IntArray, state: CellState, mine: IntArray) -> tuple[Any, ...]:
        """Columns of `Stresses` of those of the cells that this criterion judges."""
        line, ice = self.lines[name], self.ice
        circles = CIRCLES[name](state, ice)
        s = np.array([ice.E / (1.0 - ice.nu) * c.mean[mine] for c in circles])
        t = np.array([ice.E / (1.0 + ice.nu) * c.radius[mine] for c in circles])
        face = (line.along_mean * s + line.along_radius * t).argmax(axis=0), np.arange(len(mine))
        limited = next(c.limited for c in self.criteria if c.name == name)
        limit = np.broadcast_to(state.limit_or(line.strength) if limited else line.strength, len(cells))
        limit = limit[mine] / self.varied.weakness[cells[mine]]
        return cells[mine], np.full(len(mine), number), s[face], t[face], limit


class Strained:
    """The cells of a running sheet, for observers. Reads only."""

    def __init__(self, sheet: Floe) -> None:
        self._sheet, self._judge = sheet, Watching.of(sheet.judge)
        sheet.judge = self._judge

    @classmethod
    def of(cls, scheduler: Scheduler) -> Strained | None:
        """Of a run; None for a sheet that is not this project's lattice."""
        sheet = getattr(scheduler.sheet, "sheet", None)
        return cls(sheet) if isinstance(sheet, Floe) else None

    @property
    def elastic(self) -> BoolArray:
        """Cells that have not begun to crack, (cells,)."""
        return self._sheet.intact

    def began(self) -> Stresses:
        """Stresses at which cells began to crack, or failed, since this was asked before."""
        return self._judge.reached(~self._sheet.intact)

    def worst(self) -> Stresses:
        """Stresses of the cells that are used most now, at most `WORST`."""
        sheet = self._sheet
        use = np.where(sheet.live_cells, sheet.utilisation, 0.0)
        cells = np.argsort(-use, kind="stable")[:WORST]
        return self._judge.now(sheet.state.u, sheet.state.q, cells[use[cells] > LEAST])
