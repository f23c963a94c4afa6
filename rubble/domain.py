"""Where blocks are followed."""

from __future__ import annotations

from math import inf
from typing import NamedTuple

import numpy as np

from rubble.arrays import Array, BoolArray


class Domain(NamedTuple):
    """Beyond these limits blocks are cleared [m]."""

    x_max: float = inf  #: downstream limit
    x_min: float = -inf
    depth: float = inf  #: greatest depth
    y_max: float = inf  #: greatest distance from the middle plane

    def holds(self, x: Array, y: Array, z: Array) -> BoolArray:
        """Which centres of mass are inside."""
        return (self.x_min <= x) & (x <= self.x_max) & (np.abs(y) <= self.y_max) & (z >= -self.depth)
