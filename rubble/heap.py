"""Shape of a heap of rubble round a structure: a flank of one slope that falls away from it on all sides.

At a distance s from the structure's outline at the side of the sheet where the rubble lies, the heap is
``(reach - s) tan(slope)`` thick, wherever there is ice to lie at. Rubble that a structure has pushed along, or that
goes round it, lies against it like this; before a plane face the heap is a wedge.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, sqrt

import numpy as np
from scipy.spatial import cKDTree

from rubble.arrays import Array

STEP = 0.05  #: of the sums over a heap, in thicknesses


@dataclass(frozen=True)
class Place:
    """Where rubble lies: under the ice in front of a structure, or on top of it."""

    fronts: Mapping[int, tuple[float, float]]  #: of each section, where ice begins and how high, x and z [m]
    foot: Array  #: (n, 2) x and y along the structure's outline at that z, close beside the thickness of the ice [m]
    above: bool = False

    @property
    def side(self) -> float:
        """1 below the ice, -1 above."""
        return -1.0 if self.above else 1.0

    def within(self, sections: Collection[int]) -> Place:
        """The same in some sections only."""
        return replace(self, fronts={k: front for k, front in self.fronts.items() if k in sections})

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.foot)

    def distance(self, x: Array, y: float) -> Array:
        """Of points x in the plane y from the structure [m]."""
        found: Array = self._tree.query(np.column_stack([x, np.full(len(x), y)]))[0]
        return found


@dataclass(frozen=True)
class Flank:
    """A heap in one section."""

    x: Array  #: (n,) from the front outwards, evenly [m]
    thickness: Array  #: (n,) of ice and pores [m]

    @property
    def area(self) -> float:
        """[m^2]."""
        return float(self.thickness.sum()) * float(self.x[0] - self.x[1])

    def places(self, count: int, random: np.random.Generator) -> Array:
        """(count,) x of equal shares of the area, in random order: one anywhere in each share [m]."""
        share = (random.permutation(count) + random.uniform(size=count)) / count
        places: Array = np.interp(share, np.cumsum(self.thickness) / self.thickness.sum(), self.x)
        return places


def heap(
    place: Place, y: Mapping[int, float], bulk: float, slope: float, thickness: float, room: float = inf
) -> dict[int, Flank]:
    """The flanks of a heap, without sections that it does not reach.

    ``y`` of the sections' planes [m]; ``bulk``, area of ice and pores of all sections together [m^2]; ``slope`` [rad];
    ``thickness`` of the ice [m]; ``room`` for it, to the sea bed [m].
    """
    from scipy.optimize import brentq  # takes a tenth of a second to load, and most runs lay no heap

    step, tangent = STEP * thickness, float(np.tan(slope))
    nearest = min(float(place.distance(np.array([x]), y[k])[0]) for k, (x, _) in place.fronts.items())
    farthest = nearest + sqrt(2.0 * bulk / tangent) + bulk / room + 2.0 * step  # one section holds all
    x = {k: np.arange(front - 0.5 * step, front - farthest, -step) for k, (front, _) in place.fronts.items()}
    distance = {k: place.distance(at, y[k]) for k, at in x.items()}

    def thick(reach: float) -> dict[int, Array]:
        return {k: np.clip(tangent * (reach - s), 0.0, room) for k, s in distance.items()}

    reach = brentq(lambda r: step * sum(float(t.sum()) for t in thick(r).values()) - bulk, nearest, farthest)
    return {k: Flank(x[k], t) for k, t in thick(reach).items() if t.any()}
