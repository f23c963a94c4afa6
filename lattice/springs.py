"""Sums over the springs of all live cells, in compiled loops. A spring touches at most four dof of its cell."""

from __future__ import annotations

import numpy as np

from lattice.compiled import compiled
from lattice.grid import Array, IntArray

TOUCHED = 4  #: dof of a cell with which one spring is connected, at most


def sparse_rows(rows: Array) -> tuple[IntArray, Array]:
    """The entries of a spring table (springs, dof of a cell) that are not zero: place and value, (springs, 4)."""
    place, value = np.zeros((len(rows), TOUCHED), np.int64), np.zeros((len(rows), TOUCHED))
    for k, row in enumerate(rows):
        at = np.flatnonzero(row)
        place[k, : len(at)], value[k, : len(at)] = at, row[at]
    return place, value


@compiled(inline="always")
def elongation(dof, place, value, x, c, k):
    """Elongation of spring k of cell c, times the root of its stiffness."""
    e = 0.0
    for i in range(TOUCHED):
        e += value[k, i] * x[dof[c, place[k, i]]]
    return e


@compiled()
def spring_energy(dof, place, value, live, x):
    """Sum over live cells of half the square of each spring's elongation [J]; ``x`` (n,)."""
    total = 0.0
    for c in range(dof.shape[0]):
        if live[c]:
            for k in range(place.shape[0]):
                e = elongation(dof, place, value, x, c, k)
                total += e * e
    return 0.5 * total


@compiled()
def spring_force(dof, place, value, live, x):
    """K x of the springs of live cells, (n,) [N], [N m]."""
    out = np.zeros_like(x)
    for c in range(dof.shape[0]):
        if live[c]:
            for k in range(place.shape[0]):
                e = elongation(dof, place, value, x, c, k)
                for i in range(TOUCHED):
                    out[dof[c, place[k, i]]] += e * value[k, i]
    return out


@compiled()
def pull_on(dof, place, value, cells, live, chosen, x):
    """Sum of K x over the ``chosen`` dof (n,), of the springs of those ``cells`` that are live [N]."""
    total = 0.0
    for c in cells:
        if live[c]:
            for k in range(place.shape[0]):
                e = elongation(dof, place, value, x, c, k)
                for i in range(TOUCHED):
                    if chosen[dof[c, place[k, i]]]:
                        total += e * value[k, i]
    return total
