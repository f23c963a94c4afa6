"""What the rubble meets of the sheet: its edge and underside, section by section, and how they yield."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from coupling.interface import Array, IntArray, SheetEdge, SimulationError
from coupling.sheet_port.crushed_edge import CrushedEdge
from coupling.sheet_port.motion import Motion
from coupling.sheet_port.yielding import Yielding
from lattice.floe import Floe

NodeMotion = Callable[[IntArray], tuple[Array, Array]]  #: position (n, 3) and velocity in x and z (n, 2) of nodes

#: length of sheet behind its edge that the rubble meets, in thicknesses; so many times as long as the rubble reaches
#: back, because what lies farther behind would rise into open water. Whole steps, because contacts with the sheet start
#: anew where its outline has
REACH = 10.0


class Underside:
    """Gives a `SheetEdge` for every section that asks."""

    def __init__(self, sheet: Floe, motion: Motion, edge: CrushedEdge, columns_per_section: int):
        self._sheet, self._motion, self._edge, self._columns = sheet, motion, edge, columns_per_section
        self._yielding = Yielding(sheet)

    def edges(self, sections: Mapping[int, float], motion: NodeMotion) -> dict[int, SheetEdge]:
        """Edges where there is ice in front, back to the x given [m], with places and velocities by ``motion``."""
        columns = self._in_front(sections)
        column, rear = np.array(list(columns.values()), np.int64), np.array([sections[key] for key in columns])
        front = self._edge.front[column]
        row, offset = self._rows(column, front, motion(front * self._sheet.grid.ny + column)[0][:, 0], rear)
        nodes = row * self._sheet.grid.ny + np.repeat(column, np.diff(offset))
        position, velocity = motion(nodes)
        self._check_apart(position, offset)
        x, z, ends = position[:, 0].copy(), position[:, 2].copy(), offset.tolist()
        foremost = (x[offset[:-1]] + self._edge.lead(front)).tolist()
        return {
            key: SheetEdge(x[a:b], z[a:b], foremost[k], velocity[a:b], nodes[a:b])
            for k, (key, a, b) in enumerate(zip(columns, ends, ends[1:], strict=False))
        }

    def compliance(self, sections: Sequence[int]) -> Array:
        """As `SheetParticipant.compliance`."""
        columns = list(self._in_front(sections).values())
        return self._yielding.matrix(self._edge.front[columns] * self._sheet.grid.ny + np.array(columns, np.int64))

    def _in_front(self, sections: Iterable[int]) -> dict[int, int]:
        """The column that stands for each section: the rearmost, so that no ice beside a new plate overlaps it."""
        ny, across = self._sheet.grid.ny, self._columns
        front = np.full(-(-ny // across) * across, self._sheet.grid.nx)
        front[:ny] = self._edge.front
        of_section = front.reshape(-1, across)
        rearmost, ice = of_section.argmin(axis=1).tolist(), (of_section.min(axis=1) >= 0).tolist()
        return {k: k * across + rearmost[k] for k in sections if 0 <= k < len(ice) and ice[k]}

    def _rows(self, column: IntArray, front: IntArray, foremost: Array, rear: Array) -> tuple[IntArray, IntArray]:
        """Rows of columns, from the ``front`` at ``foremost`` [m] to ``rear`` [m] or the first gap; where each begins.

        As many sheets as `REACH` says.
        """
        g, step = self._sheet.grid, REACH * self._sheet.ice.h
        reach = step * np.maximum(1.0, np.ceil((foremost - rear + self._sheet.ice.h) / step))
        count = np.minimum((np.minimum(reach / g.d, g.nx)).astype(np.int64), front) + 1
        back = np.arange(count.max(initial=0))
        row = front[:, None] - back
        there = (back < count[:, None]) & self._sheet.present[np.maximum(row, 0) * g.ny + column[:, None]]
        on = np.logical_and.accumulate(there, axis=1)
        return row[on], np.concatenate(([0], np.cumsum(on.sum(axis=1))))

    def _check_apart(self, position: Array, offset: IntArray) -> None:
        """Refuses rows (m, 3), front first, of which one has passed the next."""
        behind = np.diff(position[:, 0]) < 0.0
        behind[offset[1:-1] - 1] = True  # from one section to the next
        if not behind.all():
            x, y = position[int(np.argmin(behind)), :2]
            raise SimulationError(
                f"t = {self._motion.t:.3f} s: parts of the floe overlap by a cell at x = {x:.2f}, "
                f"y = {y:.2f} m, because cracks carry no pressure between parts that stay in the "
                "lattice; use a larger floe, so that a free part of it becomes rubble"
            )
