"""Participants with closed-form answers: a sheet of one mass on a spring, and rubble of one mass behind a spring.

The sheet's mass m_1 hangs on a spring k_1; the rubble's mass m_2 hangs on the sheet by a spring k and a dashpot c. In a
window the sheet moves under a constant force of the rubble, the rubble along a straight way of the sheet's edge; both
are solved exactly (matrix exponentials), so the only error is that of the coupling. Forces on the sheet come back as
means over the window.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.linalg import expm

from coupling.interface import BlockTable, SheetEdge, SheetForces, SheetReport

M1, K1, M2, K, C = 1.0, 3.0, 2.0, 5.0, 0.4
START = np.array([1.0, 0.0, -0.5, 0.0])  #: x_1, v_1, x_2, v_2
WHOLE = np.array(
    [[0, 1, 0, 0], [-(K1 + K) / M1, -C / M1, K / M1, C / M1], [0, 0, 0, 1], [K / M2, C / M2, -K / M2, -C / M2]]
)
NS = 1_000_000_000


def exact(t):
    """State of the two masses at time t [s]."""
    return expm(WHOLE * t) @ START


class MassOnSpring:
    """The sheet: m_1 and k_1, exact under a constant force."""

    def __init__(self):
        self.state, self.mass, self.crushed, self.energy, self.power = START[:2].copy(), 1.0, 0.0, {}, 0.0
        self._before, self._window = self.state, 1.0

    def save(self):
        return partial(vars(self).update, dict(vars(self)))

    def advance(self, t_ns, window_ns, rubble, rubble_load):
        force, self._before, self._window = rubble.force[:, 0].sum(), self.state, window_ns / NS
        A = np.zeros((3, 3))
        A[0, 1], A[1, 0], A[1, 2] = 1.0, -K1 / M1, force / M1
        self.state = (expm(A * self._window) @ [*self.state, 1.0])[:2]
        self.power = force * (self.state[0] - self._before[0]) / self._window
        return SheetReport(np.zeros(3))

    def edges(self, sections):
        return {0: edge(*self.state)}

    def path(self, sections):
        return {0: edge(self._before[0], (self.state[0] - self._before[0]) / self._window)}

    def compliance(self, sections):
        return np.zeros((2, len(sections), len(sections)))

    def view(self):
        return None


class MassBehindSpring:
    """The rubble: m_2 on k and c, exact while the edge goes along a straight line."""

    def __init__(self):
        self.state, self.mass, self.cleared_mass, self.power, self.calls = START[2:].copy(), 0.0, 0.0, 0.0, 0
        self.budget = {}
        self.energy, self.momenta = {}, {}
        self._force, self._edge = K * (START[2] - START[0]), START[:2]

    def save(self):
        return partial(vars(self).update, {k: v for k, v in vars(self).items() if k != "calls"})

    def sections_in_use(self):
        return [0]

    def set_sheet(self, edges, carried, compliance):
        self._edge = edges[0].x[0], edges[0].velocity[0, 0]

    def advance(self, window_ns):
        """Mean force from the change of momentum."""
        (x, v), dt, before = self._edge, window_ns / NS, self.state
        A = np.zeros((4, 4))  # x_2, v_2, edge, 1
        A[0, 1], A[1] = 1.0, [-K / M2, -C / M2, K / M2, C * v / M2]
        A[2, 3] = v
        self.state = (expm(A * dt) @ [*before, x, 1.0])[:2]
        self._force = -M2 * (self.state[1] - before[1]) / dt
        self.power, self.calls = self._force * v, self.calls + 1

    def forces_on_sheet(self):
        return SheetForces(np.array([0]), np.array([[self._force, 0.0, 0.0]]))

    def events(self, t_ns, load):
        return []

    def load(self):
        return np.zeros((3, 3))

    def blocks(self):
        return BlockTable.empty()


def edge(x, v):
    """An edge of one node."""
    return SheetEdge(np.array([x]), np.zeros(1), x, np.array([[v, 0.0]]), np.array([0]))
