"""Stresses of the cells of the sheet in the plane of Mohr's circle: mean and half the difference of the principal ones.

Every criterion that judges the circle of a cell is a straight line there: a cell fails where
``along_mean`` s + ``along_radius`` t reaches its limit, with s = (sigma_1 + sigma_2) / 2 and
t = (sigma_1 - sigma_2) / 2 of the face that the criterion looks at, in plane stress: s = E / (1 - nu) times the mean of
the circle of strain, t = E / (1 + nu) times its radius. Curvature is scaled as in (4.17)-(4.20) of the thesis.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

import numpy as np

from coupling.interface import Array, IntArray


@dataclass(frozen=True)
class Line:
    """Where a criterion is met in the plane, of mean ice."""

    along_mean: float  #: [-]
    along_radius: float  #: [-]
    strength: float  #: what is reached there [Pa]


@dataclass(frozen=True)
class Stresses:
    """Some cells in the plane, n of them, each with the criterion that is nearest to being met."""

    lines: Mapping[str, Line]  #: by the name of their criterion, all that are judged and have a place in the plane
    cell: IntArray  #: (n,) number of the cell
    criterion: IntArray  #: (n,) place of the criterion in ``lines``
    mean: Array  #: (n,) s [Pa]
    radius: Array  #: (n,) t [Pa]
    limit: Array  #: (n,) what the line is compared with in this cell, the strength or that beside a crack tip [Pa]

    @classmethod
    def none(cls, lines: Mapping[str, Line]) -> Self:
        """Of no cell."""
        whole = np.empty(0, np.int64)
        return cls(lines, whole, whole, np.empty(0), np.empty(0), np.empty(0))

    @property
    def utilisation(self) -> Array:
        """(n,): a cell fails at 1."""
        weights = np.array([(line.along_mean, line.along_radius) for line in self.lines.values()]).reshape(-1, 2)
        along, across = weights[self.criterion].T
        return np.asarray((along * self.mean + across * self.radius) / self.limit)
