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
        return {key: self._section(column, motion, sections[key]) for key, column in self._in_front(sections).items()}

    def compliance(self, sections: Sequence[int]) -> Array:
        """As `SheetParticipant.compliance`."""
        columns = list(self._in_front(sections).values())
        return self._yielding.matrix(self._edge.front[columns] * self._sheet.grid.ny + np.array(columns, np.int64))

    def _in_front(self, sections: Iterable[int]) -> dict[int, int]:
        """The column that stands for each section: the rearmost, so that no ice beside a new plate overlaps it."""
        columns = {}
        for key in sections:
            first = key * self._columns
            if 0 <= first < self._sheet.grid.ny:
                front = self._edge.front[first : first + self._columns]
                if front.min() >= 0:
                    columns[key] = first + int(np.argmin(front))
        return columns

    def _reach(self, front: float, rear: float) -> float:
        """Length of sheet behind its front that rubble meets which reaches back to ``rear`` [m]."""
        step = REACH * self._sheet.ice.h
        return step * max(1.0, float(np.ceil((front - rear + self._sheet.ice.h) / step)))

    def _section(self, column: int, motion: NodeMotion, rear: float) -> SheetEdge:
        g, front = self._sheet.grid, int(self._edge.front[column])
        foremost = float(motion(np.array([front * g.ny + column]))[0][0, 0])
        rows = np.arange(front, max(front - int(min(self._reach(foremost, rear) / g.d, g.nx)) - 1, -1), -1)
        present = self._sheet.present[rows * g.ny + column]
        rows = rows[: int(np.argmin(present))] if not present.all() else rows
        nodes = rows * g.ny + column
        position, velocity = motion(nodes)
        self._check_apart(position)
        return SheetEdge(
            x=position[:, 0],
            z=position[:, 2],
            front=float(position[0, 0]) + float(self._edge.lead(rows[:1])[0]),
            velocity=velocity,
            nodes=nodes,
        )

    def _check_apart(self, position: Array) -> None:
        """Refuses rows (m, 3), front first, of which one has passed the next."""
        passed = np.flatnonzero(np.diff(position[:, 0]) >= 0.0)
        if len(passed):
            x, y = position[passed[0], :2]
            raise SimulationError(
                f"t = {self._motion.t:.3f} s: parts of the floe overlap by a cell at x = {x:.2f}, "
                f"y = {y:.2f} m, because cracks carry no pressure between parts that stay in the "
                "lattice; use a larger floe, so that a free part of it becomes rubble"
            )
