"""Slopes of the sheet and what they do to its membrane strain: the arrays, see `lattice.cracks.lean`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lattice.grid import Array


class Lean(NamedTuple):
    """What the slopes of cells do in the present sub-step; a cell lies at the place of its node 0, as in `Cracks`."""

    strain: Array  #: (3, places) membrane strain along x and y from the slope, and shear [-]
    stress: Array  #: (3, places) its stress over the thickness in elastic cells, along x and y and shear [N/m]
    pull: Array  #: (2, places) N . s of the membrane forces N per width and the slopes s [N/m]
    force: Array  #: (3, places) of all this on the nodes, along x, y and z [N]
    gained: Array  #: (places,) energy that the last change of slope has given to cells, over d^2 [J/m2]


def level(places: int) -> Lean:
    """No slope."""
    three, two = (3, places), (2, places)
    return Lean(np.zeros(three), np.zeros(three), np.zeros(two), np.zeros(three), np.zeros(places))
