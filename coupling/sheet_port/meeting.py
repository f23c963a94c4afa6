"""The sheet in lockstep with the rubble: its nodes as bodies of the contact solver, several times per window.

A node goes into a sub-step of the rubble with its place, its velocity, its mass in the lattice, and with what the
lattice alone would do to it: that has changed its velocity since the last meeting,

    gain = v - v_before - J_before / m,

and is taken to go on for one more sub-step (first order in its length). An edge that lies still against what presses on
it so keeps still; one that is hit by more answers in the same sub-step. In the sub-step the lattice answers to J softer
than a free node, c = 1, because its neighbours hold it: the error of the velocity then shrinks by (1 - c)^1/2 from
meeting to meeting.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coupling.interface import Array, IntArray, SheetForces
from coupling.sheet_port.energy import RUBBLE
from coupling.sheet_port.motion import Motion
from lattice.explicit_sheet import ExplicitSheet
from lattice.loads import NodeLoad


class Meeting:
    """A `lattice.loads.Partner`: asks ``answer`` for the forces of the rubble."""

    def __init__(self, sheet: ExplicitSheet, motion: Motion, every: float) -> None:
        """``every`` sub-step of the rubble [s]."""
        n, engine = sheet.grid.nodes, sheet.engine
        self._sheet, self._motion, self.every = sheet, motion, every
        self.load = NodeLoad(RUBBLE, np.zeros((n, 2)), np.zeros((n, 3)))
        mass = np.column_stack((engine.inertia_u.reshape(n, 2), engine.inertia_q.reshape(n, 3)[:, 0]))
        self._lightness = np.where(np.column_stack((engine.held, np.zeros(n, bool))), 0.0, 1.0 / mass)  #: (n, 3) [1/kg]
        self._velocity = motion.velocities()
        self._nodes, self._place = np.zeros(0, np.int64), np.zeros((0, 3))
        self.work = 0.0  #: of the forces in this window, in the fixed frame [J]
        self.answer: Callable[[], SheetForces] = SheetForces.none  #: the rubble's sub-step, forces in it

    def force(self, nodes: IntArray) -> Array:
        """Forces on nodes since the last meeting, (k, 3) [N]."""
        out = np.empty((len(nodes), 3))
        out[:, :2], out[:, 2] = self.load.force_u[nodes], self.load.force_q[nodes, 0]
        return out

    def meet(self, t: float) -> None:
        """The rubble's sub-step from time t [s] on."""
        self._motion.t = t
        self.note()
        forces = self.answer()
        self._velocity = self._motion.velocities()
        self.take(forces)

    def take(self, forces: SheetForces) -> None:
        """From now on these act."""
        self.load.force_u[:], self.load.force_q[:] = 0.0, 0.0
        self.load.force_u[forces.nodes] = forces.force[:, :2]
        self.load.force_q[forces.nodes, 0] = forces.force[:, 2]
        self._nodes, self._place = forces.nodes, self._motion.position(forces.nodes)

    def save(self, others: Callable[[], None]) -> Callable[[], None]:
        """The meeting between two windows, set back after the ``others`` of the sheet; see `Restore`."""
        own, load = dict(vars(self)), (self.load.force_u.copy(), self.load.force_q.copy())

        def back() -> None:
            others()
            vars(self).update(own)
            self.load.force_u[:], self.load.force_q[:] = load

        return back

    def power(self, window: float) -> float:
        """Mean power over a window of so many seconds that ends now, in the fixed frame [W]."""
        self.note()
        work, self.work = self.work, 0.0
        return work / window

    def note(self) -> None:
        """Books the work of the forces since the last meeting; the sheet is where its state says."""
        way = self._motion.position(self._nodes) - self._place
        self.work += float((self.force(self._nodes) * way).sum())
        self._place = self._place + way

    def nodes(self, nodes: IntArray) -> Array:
        """Nodes as the rubble meets them (m, 11): place x, z; velocity; gain; lightness, each x, y, z."""
        v, light, out = self._motion.velocities(nodes), self._lightness[nodes], np.empty((len(nodes), 11))
        gain = v - self._velocity[nodes] - self.every * self.force(nodes) * light
        out[:, :2], out[:, 2:5], out[:, 5:8], out[:, 8:] = self._motion.position(nodes)[:, ::2], v, gain, light
        return out
