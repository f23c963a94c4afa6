"""Ice that varies from cell to cell: each cell's strength, thickness and Young's modulus over those of `Ice`.

A cell's springs in the plane and in shear go with E h, those of bending and torsion with E h^3; its stress at a given
strain with E, the strain of its faces with h, and what it bears with its strength, of every kind. What floats and
weighs (mass, foundation, freeboard), what the structure meets and what leaves as a piece is of the mean thickness.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from lattice.grid import Array, IntArray

PLANE, BEND = range(2)  #: kinds of springs, by what they go with


@dataclass(frozen=True)
class Varied:
    """Ratios to the sheet's `Ice`, (cells,) each, all above 0."""

    strength: Array  #: of every kind
    thickness: Array
    E: Array

    def __post_init__(self) -> None:
        for field in fields(self):
            values = getattr(self, field.name)
            if not (np.isfinite(values).all() and (values > 0.0).all()):
                raise ValueError(f"{field.name} of a cell is {np.min(values):g} of the mean: it must be above 0")

    @classmethod
    def uniform(cls, cells: int) -> Varied:
        """Ice that is the same everywhere."""
        one = np.ones(cells)
        return cls(one, one, one)

    @cached_property
    def springs(self) -> Array:
        """By how much springs of the kinds `PLANE` and `BEND` are stiffer, (cells, 2)."""
        return np.column_stack((self.E * self.thickness, self.E * self.thickness**3))

    @cached_property
    def weakness(self) -> Array:
        """Share of its strength that a strain uses, over that of uniform ice, (cells,)."""
        return self.E / self.strength


def kinds(rows: Array) -> IntArray:
    """Kind of each row of a spring table of `assembly`: bending and torsion, which touch rotations alone, or not."""
    of_node = rows.shape[1] // 4
    if of_node == 2:
        return np.full(len(rows), PLANE, np.int64)
    return np.where(rows[:, ::of_node].any(axis=1), PLANE, BEND).astype(np.int64)
