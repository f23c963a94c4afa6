"""The front of the sheet: which nodes meet the structure, and the ice that is crushed off them."""

from __future__ import annotations

import numpy as np

from coupling.contact import OverlapContact
from coupling.interface import Array, BoolArray, ContactForces, IntArray, Structure
from coupling.sheet_port.crushed_edge import CrushedEdge
from coupling.sheet_port.motion import Motion
from lattice.contact import Lever, edge_displacement, lever_of
from lattice.floe import Floe
from lattice.memory import Memory, remember
from lattice.outcome import Outcome


class Front:
    """Keeps contact and crushed edge in step with the lattice; counts the mass of its ice."""

    def __init__(self, sheet: Floe, motion: Motion, structure: Structure, contact: OverlapContact):
        g, ice = sheet.grid, sheet.ice
        self._sheet, self._motion, self.contact = sheet, motion, contact
        y = np.asarray(g.y0 + np.arange(g.ny) * g.d, np.float64)
        self.ice_y = y.copy()  #: middle of each column's ice [m]
        self.ice_y[[0, -1]] += 0.25 * g.d * np.array([1.0, -1.0])
        self._structure = structure
        self.meets, tan = self._ahead(np.zeros(6))  #: columns in whose way the structure stands
        self.edge = CrushedEdge((g.nx, g.ny), g.d, ice.h, tan)
        self._crushed_before = 0.0  #: mass crushed off nodes that have left [kg]
        self._set_edge()

    def _ahead(self, place: Array) -> tuple[BoolArray, Array]:
        """Columns before the structure where it is displaced by ``place`` (6,), and the steepness of its face there."""
        z = np.full(len(self.ice_y), self.contact.touching_z) - place[2]
        normal = self._structure.normal(self.ice_y - place[1], z)
        meets = np.isfinite(normal[:, 0]) & (normal[:, 0] < 0.0)
        with np.errstate(invalid="ignore", divide="ignore"):
            return meets, np.where(meets, np.abs(normal[:, 0] / normal[:, 2]), 1.0)

    def stand(self, place: Array) -> None:
        """The structure is displaced by ``place`` (6,) now: other columns may stand before it."""
        meets, tan = self._ahead(place)
        self.edge.tan = np.where(meets, tan, self.edge.tan)
        if (meets != self.meets).any():
            self.meets = meets
            self.renew()

    def save(self) -> Memory:
        """Front, crushed edge and contact, for `lattice.memory.recall`."""
        return [*remember(self), *remember(self.edge, "depth"), *remember(self.contact)]

    # ---- contact ----------------------------------------------------------------------------------------------

    def renew(self) -> None:
        """The nodes in front, after the lattice has lost some."""
        self._set_edge()
        self.contact.find(self._motion.t, self.displacement)

    def _set_edge(self) -> None:
        g, front = self._sheet.grid, self._sheet.front
        self.edge.set_front(front)
        column = np.flatnonzero(self.meets & (front >= 0))
        row = front[column]
        nodes = row * g.ny + column
        lead = self.edge.lead(row)
        x_front = g.xy[nodes, 0] + lead - self._motion.setback
        self.contact.set_edge(nodes, x_front, self.ice_y[column], self.edge.width[column], lead)
        self._column = column

    def set_back(self) -> None:
        """Moves the floe back until its front just touches the structure, before a run."""
        overlap, _ = self.contact.overlap(0.0, self.displacement())
        self._motion.setback += max(float(overlap.max(initial=0.0)), 0.0)
        self._set_edge()

    def displacement(self) -> Array:
        """Of the points of contact in the drifting frame, (m, 3) [m]."""
        return edge_displacement(self._sheet.state, self.contact.nodes, lever_of(self.contact))

    def forces(self, out: Outcome) -> ContactForces:
        """The contact of a window, node by node, at the points where it acts; before the edge is crushed."""
        nodes, c = out.contact_nodes, self.contact
        height, lead = np.zeros((2, len(nodes)))
        height[: len(c.nodes)], lead[: len(c.nodes)] = c.height, c.lead
        at = self._motion.points(nodes, Lever(height, lead))
        at[:, 1] += self._aside(nodes)
        return ContactForces(nodes, at, out.contact_mean, np.zeros(len(nodes), bool))

    def _aside(self, nodes: IntArray) -> Array:
        """How far the middle of their ice is from nodes along y, (n,) [m]."""
        g, column = self._sheet.grid, nodes % self._sheet.grid.ny
        return np.asarray(self.ice_y[column] - (g.y0 + column * g.d))

    def crush(self) -> None:
        """Takes the overlapped ice off the edge, and rows of which nothing is left out of the lattice."""
        if not len(self.contact.nodes):
            return
        self.edge.crush(self._column, self.contact.close_window(self._motion.t, self.displacement))
        spent = self.edge.spent()
        if len(spent):
            nodes = self.edge.front[spent] * self._sheet.grid.ny + spent
            self._crushed_before += float(self.whole_mass(nodes).sum())
            self._sheet.retire(nodes)
            self.renew()

    # ---- ice --------------------------------------------------------------------------------------------------

    def whole_mass(self, nodes: IntArray) -> Array:
        """Mass of nodes without crushing [kg]."""
        return self._sheet.ice.rho_i * self._sheet.ice.h * self._sheet.grid.area[nodes]

    def leave(self, nodes: IntArray) -> Array:
        """Mass that nodes take along which leave now [kg]; what was crushed off them stays counted here."""
        crushed = self._crushed_off(nodes)
        self._crushed_before += float(crushed.sum())
        return self.whole_mass(nodes) - crushed

    @property
    def mass(self) -> float:
        """Ice in the lattice, without what was crushed off its edge [kg]."""
        ice = self._sheet.ice
        whole = self._sheet.grid.area[self._sheet.present].sum() * ice.rho_i * ice.h
        return float(whole) - self._crushed_now()

    @property
    def crushed(self) -> float:
        """All ice crushed off the edge so far [kg]."""
        return self._crushed_before + self._crushed_now()

    def _crushed_off(self, nodes: IntArray) -> Array:
        """Mass crushed off nodes that are in the lattice [kg]."""
        row, column = np.divmod(nodes, self._sheet.grid.ny)
        return self._sheet.ice.rho_i * self.edge.width[column] * self.edge.crushed_area(row, column)

    def _crushed_now(self) -> float:
        """Mass crushed off the nodes that are in the lattice: those of the rows that the cuts reach [kg]."""
        column = np.flatnonzero((self.edge.depth > 0.0) & (self.edge.front >= 0))
        if not len(column):
            return 0.0
        reach = int(self.edge.depth.max() / self._sheet.grid.d) + 2
        row = self.edge.front[column, None] - np.arange(reach)
        nodes = (row * self._sheet.grid.ny + column[:, None])[row >= 0]
        return float(self._crushed_off(nodes[self._sheet.present[nodes]]).sum())
