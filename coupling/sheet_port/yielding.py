"""How the sheet yields while the rubble presses on it: the full compliance of its edge over all sections.

Under a constant force on the front node of one section the front nodes of all sections have moved after a window: one
column of a symmetric matrix (the lattice is linear between two failures). In the window the rubble answers with forces
that are other than those that the lattice knows; by this matrix its edge goes where the lattice would.

A column costs as much as a window of the lattice. The field that it is read from is kept for its node; where pieces
have left, the nodes that are in front now have columns of their own. All are found anew when the window is another one
or when so many cells have failed that the sheet is another one.
"""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, IntArray
from lattice.contact import NoContact
from lattice.floe import Floe
from lattice.state import State

OTHER_SHEET = 0.02  #: share of the cells that fail before the compliance is found anew


class Yielding:
    """Keeps the answers of the sheet to one newton on a node, in x and in z."""

    def __init__(self, sheet: Floe) -> None:
        self._sheet = sheet
        self._window, self._live = 0.0, 0
        self._fields: dict[int, Array] = {}  #: (nodes, 2) displacement of all nodes in x and z [m/N]

    def matrix(self, nodes: IntArray) -> Array:
        """Displacement of nodes in x, and in z, after a window under one newton on each of them (2, k, k) [m/N]."""
        s = self._sheet
        live = int(s.live_cells.sum())
        if s.dt != self._window or abs(live - self._live) > OTHER_SHEET * len(s.live_cells):
            self._window, self._live, self._fields = s.dt, live, {}
        if not len(nodes):
            return np.zeros((2, 0, 0))
        fields = np.array([self._field(int(n))[nodes] for n in nodes])
        one_way = np.moveaxis(fields, 2, 0)
        return np.asarray(0.5 * (one_way + np.swapaxes(one_way, 1, 2)))

    def _field(self, node: int) -> Array:
        if node not in self._fields:
            s, n = self._sheet, self._sheet.grid.nodes
            force_u, force_q = np.zeros((n, 2)), np.zeros((n, 3))
            force_u[node, 0] = force_q[node, 0] = 1.0
            end = s.engine.step(0.0, s.dt, State.rest(n), force_u, force_q, NoContact()).state
            self._fields[node] = np.column_stack((end.u[:, 0], end.q[:, 0]))
        return self._fields[node]
