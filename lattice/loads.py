"""External forces on the sheet's nodes, by name. Each is booked under its name in the energy and in the reaction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lattice.grid import Array, BoolArray


@dataclass(frozen=True)
class NodeLoad:
    """Forces that stay constant over a window. The arrays are written to: nodes that leave lose their force."""

    name: str
    force_u: Array  #: (n, 2) on u_x, u_y [N]
    force_q: Array  #: (n, 3) on w [N], phi_x, phi_y [N m]

    def keep(self, present: BoolArray) -> None:
        """Takes the force off nodes that are no longer in the lattice."""
        self.force_u[~present], self.force_q[~present] = 0.0, 0.0

    @property
    def acts(self) -> bool:
        """Some force is not zero."""
        return bool(self.force_u.any() or self.force_q.any())


Loads = Sequence[NodeLoad]


def keep(loads: Loads, present: BoolArray) -> None:
    """Takes all loads off nodes that are no longer in the lattice. ValueError if two have the same name."""
    if len({load.name for load in loads}) < len(loads):
        raise ValueError(f"two loads of one name among {', '.join(load.name for load in loads)}: name each differently")
    for load in loads:
        load.keep(present)


def total(loads: Loads, nodes: int) -> tuple[Array, Array]:
    """Sum of all loads on the nodes of a lattice, (n, 2), (n, 3); not to be written to."""
    if not loads:
        return np.zeros((nodes, 2)), np.zeros((nodes, 3))
    force_u, force_q = loads[0].force_u, loads[0].force_q
    for load in loads[1:]:
        force_u, force_q = force_u + load.force_u, force_q + load.force_q
    return force_u, force_q
