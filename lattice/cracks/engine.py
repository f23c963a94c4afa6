"""The explicit engine of a sheet whose cracked cells go on carrying load."""

from __future__ import annotations

from typing import Any

import numpy as np

from lattice.cracks.cells import HOURGLASS, Plate
from lattice.cracks.law import CrackLaw
from lattice.cracks.march import CrackedLattice, march_cracked
from lattice.cracks.motion import Nodes, crack_forces, energies, evaluate_at, give
from lattice.cracks.state import LayeredCells
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import push, sweep
from lattice.explicit.layout import U_X, Motion
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import Springs

CORNERS = np.array([0, 5, 10, 15])  #: rows of `Cracks.force` at which the forces on nodes 0 to 3 begin


class CrackingEngine(ExplicitEngine):
    """Leapfrog of a lattice with layered cells, which are none of its springs."""

    _written = (*ExplicitEngine._written, "layered")

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        window: float,
        *,
        law: CrackLaw,
        **options: Any,
    ):
        """As `ExplicitEngine`, with the ``law`` of the cracks."""
        plate = Plate(grid.d, ice.h, 0.5 * springs.K_out, HOURGLASS * ice.E * ice.h)
        self.layered = LayeredCells(law, plate)
        super().__init__(grid, ice, springs, window, **options)

    def loop(self, steps: int, stride: int, load: PointForces, touch: Touch, sums: Sums) -> Made:
        """The compiled loop with the forces of the layered cells."""
        made: Made = march_cracked(steps, stride, self.motion, self._lattice(), load, touch, sums)
        return made

    def _lattice(self) -> CrackedLattice:
        return CrackedLattice(self.mesh, self.screen, self.layered.view())

    def begin(self, cell: int, angle: float) -> float:
        """A cell becomes layered as it is now; returns the energy that its layers store [J]."""
        y, v = (a.reshape(5, -1) for a in self.motion)
        k = self.layered.add(cell, self._corner(cell), angle)
        room, my = self.mesh.scratch, self.motion.y.shape[2]
        x, way = room.before.reshape(5, -1), room.after.reshape(5, -1)
        stored = float(evaluate_at(k, Nodes(my, y, v, self.alpha, self.dt, x, way), self.layered.view()))
        losses = self.layered.view().cells.losses
        losses[-1] += stored  # what the springs of the cell had is booked by whoever takes them away
        return stored

    def _corner(self, cell: int) -> int:
        i, j = divmod(cell, self.grid.ny - 1)
        return i * int(self.motion.y.shape[2]) + j

    def _next_velocity(self, now: Motion, forces: tuple[PointForces, ...]) -> Array:
        mesh, trial, layered = self.mesh, Motion(now.y, now.v.copy()), self.layered.view()
        crack_forces(layered.number, now.y.shape[2], now.y.reshape(5, -1), 1.0, layered.plate, layered.cells)
        sweep(trial, mesh.intact, mesh.kick, mesh.springs, mesh.pace, mesh.rows)
        for f in forces:
            push(f.row, f.column, f.force, trial, mesh.kick, mesh.pace.go)
        give(layered.number, trial, mesh.kick, mesh.pace.go, layered.cells)
        return trial.v

    # ---- what others ask of the layered cells -----------------------------------------------------------------

    def layered_energy(self, u: Array, q: Array, touching: BoolArray | None = None) -> float:
        """Energy of layered cells in a state, of those with a node in ``touching`` or of all [J]."""
        each = self._energies(u, q)
        if touching is not None:
            each = each[touching[self.grid.cell_nodes[self.layered.cell]].any(axis=1)]
        return float(each.sum())

    def _energies(self, u: Array, q: Array) -> Array:
        layered, x = self.layered.view(), np.zeros_like(self.motion.y)
        self.put(x, np.hstack((u, q)))
        each: Array = energies(layered.number, x.shape[2], x.reshape(5, -1), layered.plate, layered.cells)
        return each

    def pull(self, held: BoolArray) -> float:
        """Force along x that nodes in ``held`` (nodes,) need against the layered cells now [N]."""
        layered, y = self.layered.view(), self.motion.y
        crack_forces(layered.number, y.shape[2], y.reshape(5, -1), 1.0, layered.plate, layered.cells)
        on = held[self.grid.cell_nodes[self.layered.cell]]  # (count, 4)
        return -float((layered.cells.force[CORNERS + U_X, : layered.number].T * on).sum())

    @property
    def crack_losses(self) -> dict[str, float]:
        """What cracking, crushing, rubbing and switching have taken [J]."""
        return self.layered.losses

    def lose(self, cells: BoolArray, s: State) -> float:
        """Layered cells, marked in ``cells`` (count,), go; returns their energy in this state [J]."""
        stored = float(self._energies(s.u, s.q)[cells].sum())
        self.layered.drop(cells)
        return stored
