"""Columns L^-1 U of a matrix A = L L^T, and that matrix without them: A - U U^T.

U is zero at most dof, so L^-1 U is so too, see `lattice.implicit.substitution`. With Y = L^-1 U,

    A - U U^T = L (I - Y Y^T) L^T,    (I - Y Y^T)^-1 = I + Y (I - Y^T Y)^-1 Y^T    (Woodbury),

so the correction stands between the two substitutions of a solution, and takes as long as Y has numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from lattice.grid import Array, IntArray


class Columns(NamedTuple):
    """Some columns L^-1 U."""

    rows: IntArray  #: (k,) where they are not zero, ascending, in the order of elimination
    values: Array  #: (k, r)

    def joined(self, other: Columns) -> Columns:
        """These and then those of another."""
        rows, r = np.union1d(self.rows, other.rows), self.values.shape[1]
        values = np.zeros((len(rows), r + other.values.shape[1]))
        values[np.searchsorted(rows, self.rows), :r] = self.values
        values[np.searchsorted(rows, other.rows), r:] = other.values
        return Columns(rows, values)

    def inner(self, other: Columns) -> Array:
        """Products of these r columns with the s of another, (r, s)."""
        _, i, j = np.intersect1d(self.rows, other.rows, assume_unique=True, return_indices=True)
        return np.asarray(self.values[i].T @ other.values[j])


NOTHING = Columns(np.empty(0, np.int64), np.empty((0, 0)))  #: no column


class Lost:
    """The columns that a matrix has lost. It is never written to: `with_more` makes another one."""

    def __init__(self, columns: Columns, products: Array):
        """``products`` (r, r) of all columns with each other."""
        self._columns, self._products = columns, products
        self._inner = la.lu_factor(np.eye(len(products)) - products)

    @property
    def rank(self) -> int:
        """How many columns."""
        return len(self._products)

    def with_more(self, more: Columns) -> Lost:
        """These columns and more."""
        across = self._columns.inner(more)
        products = np.block([[self._products, across], [across.T, more.inner(more)]])
        return Lost(self._columns.joined(more), products)

    def correct(self, y: Array) -> None:
        """(I - Y Y^T)^-1 y in place, (n,)."""
        if self.rank:
            rows, Y = self._columns
            y[rows] += Y @ la.lu_solve(self._inner, Y.T @ y[rows], check_finite=False)

    def product(self, points: Columns) -> Array:
        """P^T (I - Y Y^T)^-1 P of columns P, (m, m)."""
        G = points.inner(points)
        if self.rank:
            across = self._columns.inner(points)
            G += across.T @ la.lu_solve(self._inner, across, check_finite=False)
        return G
