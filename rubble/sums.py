"""Sums of a section: impulses over a window, and work since its start."""

from __future__ import annotations

from typing import Any

import numpy as np

from rubble.arrays import Records
from rubble.contacts import NODE, ON_BLOCK, ON_SHEET, Impulses
from rubble.lateral import LATERAL_WORK
from rubble.losses import PAIR_LOSS, PAIRS, STEP_WORK
from rubble.overload import COUNT, OVERLOAD
from rubble.stepping import Sums, Work
from rubble.water import WATER_IMPULSE, WATER_WORK


class SectionSums:
    """The sums of one section; what belongs to blocks has a row for each of them."""

    def __init__(self) -> None:
        self.block = np.zeros(0, ON_BLOCK)
        self.sheet = np.zeros(1, ON_SHEET)
        self.water_impulse = np.zeros(1, WATER_IMPULSE)
        self.momentum_gain = np.zeros(2)  #: of the blocks with added mass over the last window, x and z [N s]
        self.dead_load = np.zeros(2)  #: weight and constant thrust of the blocks in the last window, x and z [N]
        self.water = np.zeros(1, WATER_WORK)
        self.step = np.zeros(1, STEP_WORK)
        self.loss = np.zeros(len(PAIRS), PAIR_LOSS)
        self.lateral = np.zeros(1, LATERAL_WORK)
        self.thrust_work = 0.0  #: [J]
        self._overload, self._count = np.zeros(0, OVERLOAD), np.zeros(1, COUNT)

    def __getstate__(self) -> dict[str, Any]:
        """All but the overloaded pairs, which are dealt with at the end of their window."""
        return {name: value for name, value in self.__dict__.items() if name not in ("_overload", "_count")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._overload, self._count = np.zeros(0, OVERLOAD), np.zeros(1, COUNT)

    @property
    def overloads(self) -> Records:
        """Overloaded pairs of the last window, OVERLOAD; a view."""
        return self._overload[: int(self._count["pairs"][0])]

    def start_window(self) -> None:
        """Sums over a window start from zero."""
        for table in (self.block, self.sheet, self.water_impulse, self._count):
            table.view(np.uint8).fill(0)  # all fields at once

    def make_room(self, pairs: int) -> None:
        """Room for all pairs of another sub-step, should all of them be overloaded."""
        known = len(self.overloads)
        if len(self._overload) < known + pairs:
            old, self._overload = self.overloads, np.zeros(2 * (known + pairs), OVERLOAD)
            self._overload[:known] = old

    def for_kernels(self, nodes: Records | None) -> Sums:
        """The same for the compiled loop; ``nodes`` of the sheet, if there is one."""
        node = _NO_NODES if nodes is None else nodes
        impulses = Impulses(self.block, self.sheet, node, self._overload, self._count)
        return Sums(impulses, Work(self.water, self.water_impulse, self.step, self.loss))


_NO_NODES = np.zeros(0, NODE)
