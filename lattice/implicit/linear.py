"""Factorised system matrix that loses cells as low-rank updates.

With A the matrix at factorisation and U the scaled spring rows of the cells removed since, the present matrix is
A - U U^T, see `lattice.implicit.columns`. When the rank has grown past `MAX_RANK` the matrix is factorised anew.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.assembly import CellSprings, cell_stiffness
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.implicit.columns import NOTHING, Columns, Lost
from lattice.implicit.factors import Factors
from lattice.implicit.substitution import Way
from lattice.memory import Memory, remember
from lattice.springs import SpringTable

MAX_RANK = 300  #: columns of U at which a new factorisation is cheaper than carrying them (40 x 40 to 240 x 240 nodes)
MAX_AT_ONCE = 12  #: cells removed between two uses at which a new factorisation is cheaper than an update


class Points(NamedTuple):
    """Dof that forces act on."""

    dof: IntArray  #: (m,)
    way: Way  #: from them
    unit: Columns  #: of a unit force on each
    lost: Lost | None  #: for which ``compliance`` holds
    compliance: Array  #: (m, m)


class CrackedSystem:
    """Solves ``(scale * K(intact) + diag) x = b`` with some degrees of freedom held at zero."""

    def __init__(
        self, grid: Grid, springs: CellSprings, intact: BoolArray, diagonal: Array, scale: float, held: BoolArray
    ):
        self._grid, self._rows = grid, np.sqrt(scale) * springs.rows
        self._cell_stiffness = cell_stiffness(self._rows, springs.share)
        self._diagonal, self._held, self._springs = diagonal, held, SpringTable.of(grid, *springs)
        self._dof = self._springs.dof
        self._intact = intact.copy()
        self._pending: list[int] = []
        self._factorise()

    def _factorise(self) -> None:
        self._lu = Factors(self._grid, self._cell_stiffness, self._intact, self._diagonal, self._held)
        self._lost = Lost(NOTHING, np.empty((0, 0)))  #: rows of the cells that were removed since
        self._points: Points | None = None  #: asked for last
        self._right, self._forward = np.empty(0), np.empty(0)  #: right side asked for last, and L^-1 of it

    def save(self) -> Memory:
        """What `memory.recall` sets back; factors and columns are kept by reference."""
        return remember(self, "_intact", "_pending")

    def remove(self, cells: IntArray) -> None:
        """Takes cells out of the matrix; the work is done when it is used next."""
        self._intact[cells] = False
        self._pending.extend(int(c) for c in cells)

    def _update(self) -> None:
        """Brings the solver up to date with the cells that were removed."""
        cells, self._pending = self._pending, []
        if len(cells) > MAX_AT_ONCE or self._lost.rank + len(cells) * len(self._rows) > MAX_RANK:
            self._factorise()
        elif cells:
            dof, U = self._spring_columns(cells)
            self._lost = self._lost.with_more(self._lu.columns(dof, self._lu.way(dof), U))

    def _spring_columns(self, cells: list[int]) -> tuple[IntArray, Array]:
        """Dof of some cells (m,) and U there, (m, rank)."""
        dof, r = np.unique(self._dof[cells]), len(self._rows)
        U = np.zeros((len(dof), r * len(cells)))
        for k, cell in enumerate(cells):
            root = self._root(cell)
            U[np.searchsorted(dof, self._dof[cell]), k * r : (k + 1) * r] = (root[:, None] * self._rows).T
        return dof, U

    def _root(self, cell: int) -> Array:
        """Roots of the share of each spring of a cell, (springs,)."""
        return np.asarray(np.sqrt(self._springs.share[cell])[self._springs.kind])

    def solve(self, b: Array) -> Array:
        """X for a right side b over all degrees of freedom, held ones come back as 0, (n,)."""
        return self.whole(self.half(b))

    def half(self, b: Array) -> Array:
        """The first half of a solution for b (n,), to which forces may be added before the second half.

        A step that is made again because a cell has failed begins with the same b: only the correction is new.
        """
        self._update()
        if not np.array_equal(b, self._right):
            self._right, self._forward = b.copy(), self._lu.forward(b)
        y = self._forward.copy()
        self._lost.correct(y)
        return y

    def at(self, dof: IntArray, half: Array) -> Array:
        """What the solution will be at some dof (m,)."""
        return self._lu.at(dof, self._points_at(dof).way, half)

    def add(self, dof: IntArray, b: Array, half: Array) -> None:
        """Adds what a right side b (m,) that acts on `dof` only does, in place."""
        (rows, values), more = self._points_at(dof).unit, np.zeros_like(half)
        more[rows] = values @ b
        self._lost.correct(more)
        half += more

    def whole(self, half: Array) -> Array:
        """The solution (n,); its first half is lost."""
        return self._lu.backward(half)

    def compliance(self, dof: IntArray) -> Array:
        """Rows and columns `dof` of the inverse, (m, m); zero for held ones."""
        self._update()
        points = self._points_at(dof)
        if points.lost is not self._lost:
            points = self._points = points._replace(lost=self._lost, compliance=self._lost.product(points.unit))
        return points.compliance

    def _points_at(self, dof: IntArray) -> Points:
        """Of some dof (m,), kept until others are asked for."""
        if self._points is None or not np.array_equal(dof, self._points.dof):
            way = self._lu.way(dof)
            unit = self._lu.columns(dof, way, np.eye(len(dof)))
            self._points = Points(dof.copy(), way, unit, None, np.empty((0, 0)))
        return self._points
