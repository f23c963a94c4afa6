"""Where the nodes of the drifting lattice are and how they move in the fixed frame, now and over the last window."""

from __future__ import annotations

import numpy as np

from coupling.interface import Array, IntArray
from lattice.contact import Lever, edge_displacement
from lattice.floe import Floe
from lattice.state import State

EVERY = slice(None)  #: nodes


class Motion:
    """The frame of the lattice drifts along +x with ``velocity``; its states are displacements in that frame."""

    def __init__(self, sheet: Floe, velocity: float):
        self.sheet, self.velocity = sheet, velocity
        self.z_mid = sheet.ice.freeboard - 0.5 * sheet.ice.h  #: middle of the floating sheet [m]
        self.setback = 0.0  #: distance by which the floe starts farther back than its grid [m]
        self.t = 0.0  #: now [s]
        self._start = 0.0, sheet.state  #: time and state at the start of the last window

    def begin(self, t: float) -> None:
        """A window begins at ``t`` [s] with the state that the sheet has."""
        self.t = t
        self._start = t, self.sheet.state

    def position(self, nodes: IntArray) -> Array:
        """Positions of nodes now, (n, 3) [m]."""
        return self._place(nodes, self.sheet.state, self.t)

    def points(self, nodes: IntArray, lever: Lever) -> Array:
        """Positions of points at the end of levers on nodes now, (n, 3) [m]."""
        x, y = self.sheet.grid.xy[nodes].T
        at_rest = np.column_stack(
            (x - self.setback + self.velocity * self.t + lever.lead, y, self.z_mid + lever.height)
        )
        return at_rest + edge_displacement(self.sheet.state, nodes, lever)

    def velocities(self, nodes: IntArray | slice = EVERY) -> Array:
        """Velocities of nodes now, (n, 3) [m/s]."""
        in_plane, up = self.sheet.state.u_dot[nodes], self.sheet.state.q_dot[nodes, 0]
        out = np.empty((len(up), 3))
        np.add(in_plane, (self.velocity, 0.0), out=out[:, :2])
        out[:, 2] = up
        return out

    def displacement(self, nodes: IntArray) -> Array:
        """How far nodes have come in the last window, (n, 3) [m]."""
        return self.position(nodes) - self._before(nodes)

    def now(self, nodes: IntArray) -> tuple[Array, Array]:
        """Position (n, 3) [m] and velocity in x and z (n, 2) [m/s] now."""
        return self.position(nodes), self.velocities(nodes)[:, ::2]

    def mean(self, nodes: IntArray) -> tuple[Array, Array]:
        """The same at the start of the last window, and on average over it."""
        return self._before(nodes), (self.displacement(nodes) / self.window)[:, ::2]

    @property
    def window(self) -> float:
        """Length of the last window [s]."""
        return self.t - self._start[0]

    def _before(self, nodes: IntArray) -> Array:
        t, state = self._start
        return self._place(nodes, state, t)

    def _place(self, nodes: IntArray, s: State, t: float) -> Array:
        out, xy = np.empty((len(nodes), 3)), self.sheet.grid.xy[nodes]
        xy[:, 0] = xy[:, 0] - self.setback + self.velocity * t
        np.add(xy, s.u[nodes], out=out[:, :2])
        np.add(self.z_mid, s.q[nodes, 0], out=out[:, 2])
        return out
