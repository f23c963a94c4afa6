"""External forces on the sheet's nodes, by name. Each is booked under its name in the energy and in the reaction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from lattice.grid import Array, BoolArray, IntArray


@dataclass(frozen=True)
class NodeLoad:
    """Forces that stay constant over a window. The arrays are written to: nodes that leave lose their force."""

    name: str
    force_u: Array  #: (n, 2) on u_x, u_y [N]
    force_q: Array  #: (n, 3) on w [N], phi_x, phi_y [N m]

    def drop(self, nodes: IntArray) -> None:
        """Takes the force off nodes that are no longer in the lattice."""
        self.force_u[nodes], self.force_q[nodes] = 0.0, 0.0

    @property
    def acts(self) -> bool:
        """Some force is not zero."""
        return bool(self.force_u.any() or self.force_q.any())


Loads = Sequence[NodeLoad]


class Partner(Protocol):
    """What presses on a sheet in answer to how it moves, and is asked more often than once per window."""

    @property
    def every(self) -> float:
        """Time between two meetings [s]; windows are a whole number of it."""
        ...

    @property
    def load(self) -> NodeLoad:
        """Forces until the next meeting; one of the loads of the window."""
        ...

    def meet(self, t: float) -> None:
        """Writes new forces into ``load``; the state of the sheet is that of time t, see `ExplicitEngine.moving`."""
        ...


def keep(loads: Loads, present: BoolArray) -> None:
    """Takes all loads off nodes that are no longer in the lattice. ValueError if two have the same name."""
    if len({load.name for load in loads}) < len(loads):
        raise ValueError(f"two loads of one name among {', '.join(load.name for load in loads)}: name each differently")
    gone = np.flatnonzero(~present)
    for load in loads:
        load.drop(gone)


def total(loads: Loads, nodes: int) -> tuple[Array, Array]:
    """Sum of all loads on the nodes of a lattice, (n, 2), (n, 3); not to be written to."""
    if not loads:
        return np.zeros((nodes, 2)), np.zeros((nodes, 3))
    force_u, force_q = loads[0].force_u, loads[0].force_q
    for load in loads[1:]:
        force_u, force_q = force_u + load.force_u, force_q + load.force_q
    return force_u, force_q
