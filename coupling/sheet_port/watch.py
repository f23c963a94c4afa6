"""Watches the sheet for events, window by window."""

from __future__ import annotations

import numpy as np

from coupling.interface import NS, Array, Event, Fragment
from coupling.sheet_port import events
from coupling.sheet_port.motion import Motion
from lattice.cracks.hinges import Hinges
from lattice.floe import Floe
from lattice.outcome import Outcome

HINGED_MORE = 0.2  #: by how much more ice is hinged before it is told again [-]


class Watch:
    """What it has seen already: whether cells failed in the last window, whether the sheet has left the water."""

    def __init__(self, sheet: Floe, motion: Motion):
        self._sheet, self._motion = sheet, motion
        self.draft = sheet.ice.h - sheet.ice.freeboard  #: lift at which the floating sheet leaves the water [m]
        self._quiet, self._afloat = True, True
        self._deep, self._deepening, self._hinged, self._halves = 0, False, 0.0, 1

    def window(
        self, out: Outcome, parts_before: int, left: list[tuple[Fragment, bool]], load: Array, rubble_load: Array
    ) -> list[Event]:
        """Events of a window under the mean loads (3,) of sheet and rubble; ``left`` with `at the structure` or not."""
        found = self._failures(out, parts_before, left, rubble_load) if out.failure else []
        found += self.lifted_out(rubble_load + load)
        self._quiet = not out.failed
        return found

    def _failures(
        self, out: Outcome, parts_before: int, left: list[tuple[Fragment, bool]], rubble_load: Array
    ) -> list[Event]:
        """Those of a window in which cells failed, with the time of the first failure and the load then."""
        assert out.failure is not None
        t_ns, load = round(out.failure[0] * NS), rubble_load - out.failure[1].sum(axis=0)
        failed = events.Failed(len(out.failed), ", ".join(dict.fromkeys(out.causes)))
        found = []
        if out.failed:
            where = self._motion.position(self._sheet.grid.cell_nodes[out.failed].ravel()).mean(axis=0)
            parts = out.parts if out.parts > parts_before else None
            found += events.failures(t_ns, load, failed, where, parts, self._quiet)
        for fragment, at_structure in left:
            found += events.departure(t_ns, load, failed, fragment, at_structure)
        return found

    def cracks(self, hinges: Hinges, load: Array) -> list[Event]:
        """Cracks that become hinges after a quiet window, pieces that they surround, halves that they part."""
        t_ns, found, grid = round(self._motion.t * NS), [], self._sheet.grid
        grows, area = len(hinges.cells) > self._deep, float(grid.area[hinges.hinged].sum())
        if grows and not self._deepening:
            where = self._motion.position(grid.cell_nodes[hinges.cells].ravel()).mean(axis=0)
            found.append(events.crack(t_ns, load, where, len(hinges.cells) * grid.d))
        if area > (1.0 + HINGED_MORE) * self._hinged:
            where = self._motion.position(np.flatnonzero(hinges.hinged)).mean(axis=0)
            found.append(events.hinge(t_ns, load, where, area))
        if hinges.parts > self._halves:
            where = self._motion.position(grid.cell_nodes[hinges.cells].ravel()).mean(axis=0)
            found.append(events.hinged_apart(t_ns, load, where, hinges.parts))
        self._deep, self._deepening = len(hinges.cells), grows
        self._hinged, self._halves = (area if area > self._hinged else self._hinged), max(self._halves, hinges.parts)
        return found

    def lifted_out(self, load: Array) -> list[Event]:
        """One event of a run, when the sheet first leaves the water."""
        w = np.where(self._sheet.present, self._sheet.state.q[:, 0], 0.0)
        highest = int(np.argmax(w))
        if not self._afloat or w[highest] <= self.draft:
            return []
        self._afloat = False
        where = self._motion.position(np.array([highest]))[0]
        linear = self._sheet.tops is None
        return [events.lifted_out(round(self._motion.t * NS), load, where, float(w[highest]), self.draft, linear)]
