"""One window of the explicit engine: what acts in it, and integrals over its blocks of sub-steps."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lattice.contact import EdgeContact
from lattice.explicit.forces import NOTHING, PointForces, Pressed, point_forces, pressed
from lattice.explicit.layout import U_X, W
from lattice.explicit.readings import Path
from lattice.grid import Array, BoolArray, IntArray
from lattice.loads import Loads, NodeLoad, keep
from lattice.reaction import Pair
from lattice.state import State


@dataclass
class Window:
    """What acts, and running integrals over time."""

    t: float  #: at which it begins [s]
    start: State
    loads: Loads
    contact: EdgeContact
    columns: int  #: nodes across
    impulse: Array  #: (n, 3) of the contact [N s]
    path: Path  #: of deflection and rotation
    push: Array  #: (loads, 2) impulse of each load along x and z [N s]
    held: BoolArray  #: (n,) nodes that are held along x
    load: PointForces = NOTHING  #: the loads on nodes that are still in the lattice
    hold: float = 0.0  #: impulse along x of the held nodes on the sheet, less what loads bring to them at once [N s]

    def __post_init__(self) -> None:
        self._parts: dict[int, Pressed] = {}
        self.sums = np.zeros_like(self.push)  #: of each load along x and z [N]
        self._look_at(self.loads)

    @classmethod
    def begin(
        cls, t: float, start: State, loads: Loads, contact: EdgeContact, columns: int, path: Path, held: BoolArray
    ) -> Window:
        """A window that begins with this state; ``columns`` nodes across, of which those ``held`` (n,) stand still."""
        impulse, push = np.zeros((len(start.q), 3)), np.zeros((len(loads), 2))
        return cls(t, start, loads, contact, columns, impulse, path, push, held=held)

    def keep(self, present: BoolArray) -> None:
        """Takes the loads off nodes that have left."""
        keep(self.loads, present)
        self._look_at(self.loads)

    def renew(self, load: NodeLoad, present: BoolArray) -> None:
        """One of the loads has changed; it does not act on nodes that have left."""
        keep([load], present)
        self._look_at([load])

    def _look_at(self, loads: Loads) -> None:
        """Where these of the loads press, their sums, and that of all along x on held nodes."""
        for k, each in enumerate(self.loads):
            if any(each is load for load in loads):
                self._parts[k] = _, force = pressed(each)
                self.sums[k] = force[:, U_X].sum(), force[:, W].sum()
        self.load = point_forces(list(self._parts.values()), self.columns)
        on_held = self.held[self.load.row * self.columns + self.load.column]
        self.at_held = float(self.load.force[on_held, U_X].sum())  #: [N]

    def by_name(self) -> Iterator[tuple[str, slice]]:
        """Each load, and where its forces stand in ``load``."""
        for k, each in enumerate(self.loads):
            yield each.name, slice(self.load.first[k], self.load.first[k + 1])

    def mean(self, dt: float) -> State:
        """Mean deflection and rotation over a window of ``dt`` [s]; the rest is that of its start."""
        return State(self.start.u, self.path.total() / dt, self.start.u_dot, self.start.q_dot)

    def contact_mean(self, dt: float) -> tuple[Array, IntArray]:
        """Mean contact force (m, 3) [N] and its nodes (m,): those of the edge now, then others that have had any."""
        mean, nodes = self.impulse / dt, self.contact.nodes
        left = np.setdiff1d(np.flatnonzero(mean.any(axis=1)), nodes)
        touched = np.concatenate((nodes, left))
        return np.asarray(mean[touched]), touched

    def applied(self, dt: float) -> dict[str, Pair]:
        """Mean loads by name, along x and z [N]."""
        pairs = (self.push / dt).tolist()
        return {n.name: (x, z) for n, (x, z) in zip(self.loads, pairs, strict=True)}
