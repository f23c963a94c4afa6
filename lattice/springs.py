"""Sums over the springs of all live cells, in compiled loops. A spring touches at most four dof of its cell."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.assembly import cell_dof
from lattice.compiled import compiled
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.varied import kinds

TOUCHED = 4  #: dof of a cell with which one spring is connected, at most


class SpringTable(NamedTuple):
    """The springs of every cell: where they are fastened, and the entries of `assembly`'s rows that are not zero."""

    dof: IntArray  #: (cells, dof of a cell)
    place: IntArray  #: (springs, 4) places in a row of ``dof``
    value: Array  #: (springs, 4) roots of stiffness [sqrt(N/m)], or 0
    kind: IntArray  #: (springs,) column of ``share``
    share: Array  #: (cells, 2) by how much the springs of a cell are stiffer, see `lattice.varied`

    @classmethod
    def of(cls, grid: Grid, rows: Array, share: Array | None = None) -> SpringTable:
        """From a spring table (springs, dof of a cell) that holds for all cells of a grid, but for ``share``."""
        place, value = np.zeros((len(rows), TOUCHED), np.int64), np.zeros((len(rows), TOUCHED))
        for k, row in enumerate(rows):
            at = np.flatnonzero(row)
            place[k, : len(at)], value[k, : len(at)] = at, row[at]
        share = np.ones((grid.cells, 2)) if share is None else share
        return cls(dof=cell_dof(grid, rows.shape[1] // 4), place=place, value=value, kind=kinds(rows), share=share)

    def of_cells(self, cells: IntArray, dof: IntArray) -> SpringTable:
        """The springs of some cells (k,), fastened at other places ``dof`` (k, dof of a cell)."""
        return self._replace(dof=dof, share=self.share[cells])


@compiled(inline="always")
def elongation(springs: SpringTable, x: Array, c: int, k: int) -> float:
    """Elongation of spring k of cell c, times the root of its stiffness."""
    e = 0.0
    for i in range(TOUCHED):
        e += springs.value[k, i] * x[springs.dof[c, springs.place[k, i]]]
    return e


@compiled()
def spring_energy(springs: SpringTable, live: BoolArray, x: Array) -> float:
    """Sum over live cells of half the square of each spring's elongation [J]; ``x`` (n,)."""
    total = 0.0
    for c in range(springs.dof.shape[0]):
        if live[c]:
            for k in range(springs.place.shape[0]):
                e = elongation(springs, x, c, k)
                total += springs.share[c, springs.kind[k]] * e * e
    return 0.5 * total


@compiled()
def spring_force(springs: SpringTable, live: BoolArray, x: Array) -> Array:
    """K x of the springs of live cells, (n,) [N], [N m]."""
    out = np.zeros_like(x)
    for c in range(springs.dof.shape[0]):
        if live[c]:
            for k in range(springs.place.shape[0]):
                e = springs.share[c, springs.kind[k]] * elongation(springs, x, c, k)
                for i in range(TOUCHED):
                    out[springs.dof[c, springs.place[k, i]]] += e * springs.value[k, i]
    return out


@compiled()
def pull_on(springs: SpringTable, cells: IntArray, live: BoolArray, chosen: BoolArray, x: Array) -> float:
    """Sum of K x over the ``chosen`` dof (n,), of the springs of those ``cells`` that are live [N]."""
    total = 0.0
    for c in cells:
        if live[c]:
            for k in range(springs.place.shape[0]):
                e = springs.share[c, springs.kind[k]] * elongation(springs, x, c, k)
                for i in range(TOUCHED):
                    if chosen[springs.dof[c, springs.place[k, i]]]:
                        total += e * springs.value[k, i]
    return total
