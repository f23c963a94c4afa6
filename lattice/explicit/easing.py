"""Cells that have come to lie beside a crack tip, and what they carried before.

The limit beside a crack tip (4.31) belongs to the concentrated strain of a cell that the tip has loaded. When a cell
breaks, its neighbours on the flanks still carry the strain from before, which may exceed (4.31) until they have
unloaded: a few wave passages, and never less than alpha. Such a cell fails only if its load *rises*; as it falls, its
limit comes down with it to (4.31). Without that, both flanks of the first cell of every crack break off.
"""

from __future__ import annotations

import numpy as np

from lattice.grid import Array

#: part by which a cell beside a new crack tip must be loaded further to fail: more than rounding and small waves add to
#: a cell that unloads, far less than a tip adds to the cell ahead of it [-]
RISE = 1e-3


class Easing:
    """Limits of the cells of a sheet that a crack tip has just reached."""

    def __init__(self, cells: int, sigma_t: float):
        self._eased = np.zeros(cells)  #: their limit, else 0 [Pa]
        self._before = np.full(cells, sigma_t)  #: limits before the last failure [Pa]

    @property
    def any(self) -> bool:
        """Some cell still carries more than its limit."""
        return bool(self._eased.any())

    def limits(self, limit: Array) -> Array:
        """The limits (cells,) [Pa] with those of eased cells raised."""
        return np.maximum(limit, self._eased)

    def look(self, stress: Array, limit: Array) -> None:
        """Follows the ``stress`` (cells,) that is compared with ``limit`` (cells,), both [Pa]."""
        eased = np.where(limit < self._before, np.inf, self._eased)
        self._eased = np.where((eased > 0.0) & (stress > limit), np.minimum(eased, (1.0 + RISE) * stress), 0.0)
        self._before = limit
