"""What both participants speak of: forces between them, forces by term, and going back to the start of a window."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from coupling.interface.units import Array, IntArray

ForcePairs = Mapping[str, tuple[float, float]]  #: mean force in x and z by term of `coupling.budget` [N]

#: A saved state, opaque to all but who made it: calling it sets its participant back to where it was when it was made,
#: as often as one likes. What follows has the same bits every time.
Restore = Callable[[], None]


@dataclass(slots=True)
class SheetForces:
    """Mean forces of the rubble on sheet nodes over a window (force on the sheet, the sheet's reaction is opposite)."""

    nodes: IntArray  #: (k,) node numbers, each at most once
    force: Array  #: (k, 3) [N]

    @classmethod
    def none(cls) -> SheetForces:
        """No rubble touches the sheet."""
        return cls(np.empty(0, np.int64), np.empty((0, 3)))
