"""The explicit engine of a sheet whose cracked cells go on carrying load."""

from __future__ import annotations

from typing import Any

import numpy as np

from lattice.cracks.cells import HOURGLASS, SWITCHING, Plate
from lattice.cracks.law import CrackLaw
from lattice.cracks.march import Stretch, march_cracked
from lattice.cracks.motion import Nodes, crack_forces, energies, evaluate_at, give
from lattice.cracks.state import LayeredCells
from lattice.explicit.engine import TRUE_INERTIA, ExplicitEngine, SubSteps
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import push, sweep
from lattice.explicit.layout import U_X, Motion
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import Springs

#: largest material damping where inertia is scaled, as share of the critical sub-step: a tenth of the sub-step is lost,
#: waves still die out within some ten periods, and the peak of the 165 m floe moves by 0.2 % (1e-4 against 1e-3 s) [-]
SLOW_DAMPING = 0.1


#: sub-steps of slow interaction: the factor 1 instead of 4 moves the peak of the 165 m floe by 0.7 %
SLOW = SubSteps(scaling=4.0)


class CrackingEngine(ExplicitEngine):
    """Leapfrog of a lattice with layered cells, which are none of its springs."""

    _written = (*ExplicitEngine._written, "layered")

    def __init__(self, grid: Grid, ice: Ice, springs: Springs, window: float, *, law: CrackLaw, **options: Any):
        """As `ExplicitEngine`, with the ``law`` of the cracks."""
        plate = Plate(grid.d, ice.h, 0.5 * springs.K_out, HOURGLASS * ice.E * ice.h)
        self.layered = LayeredCells(law, plate)
        self.slow = options.get("sub_steps", TRUE_INERTIA).scaling > 1.0
        super().__init__(grid, ice, springs, window, **options)

    def _critical_step(self) -> float:
        """As `ExplicitEngine`; with scaled inertia material damping is cut to `SLOW_DAMPING` of the undamped one.

        Stiffness-proportional damping does nothing to slow motion, but shortens sub-steps in proportion.
        """
        if self.slow:
            asked, self.alpha = self.alpha, 0.0
            self.alpha = min(asked, SLOW_DAMPING * super()._critical_step())
        return super()._critical_step()

    def loop(self, steps: int, stride: int, load: PointForces, touch: Touch, sums: Sums) -> Made:
        """The compiled loop with the forces of the layered cells."""
        stretch, layered = Stretch(steps, stride), self.layered.view()
        made: Made = march_cracked(stretch, self.motion, self.mesh, self.screen, load, touch, sums, layered)
        return made

    def begin(self, cell: int, angle: float) -> float:
        """A cell becomes layered as it is now; returns the energy that its layers store [J]."""
        y, v = (a.reshape(5, -1) for a in self.motion)
        k = self.layered.add(cell, self._corner(cell), angle)
        room, layered = self.mesh.scratch, self.layered.view()
        x, way = room.before.reshape(5, -1), room.after.reshape(5, -1)
        nodes = Nodes(y, v, x, way, self.motion.y.shape[2], self.alpha, self.dt)
        stored = float(evaluate_at(k, nodes, layered))
        layered.cells.losses[SWITCHING] += stored  # what the springs of the cell had is booked by who takes them away
        return stored

    def _corner(self, cell: int) -> int:
        i, j = divmod(cell, self.grid.ny - 1)
        my: int = self.motion.y.shape[2]
        return i * my + j

    def _next_velocity(self, now: Motion, forces: tuple[PointForces, ...]) -> Array:
        mesh, trial, layered = self.mesh, Motion(now.y, now.v.copy()), self.layered.view()
        crack_forces(layered.used, now.y.shape[2], now.y.reshape(5, -1), 1.0, layered.plate, layered.cells)
        sweep(trial, mesh.intact, mesh.kick, mesh.springs, mesh.pace, mesh.rows)
        for f in forces:
            push(f.row, f.column, f.force, trial, mesh.kick, mesh.pace.go)
        give(layered.used, trial, mesh.kick, mesh.pace.go, layered.cells)
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
        each: Array = energies(layered.used, x.shape[2], x.reshape(5, -1), layered.plate, layered.cells)
        return each

    def pull(self, held: BoolArray) -> float:
        """Force along x that nodes in ``held`` (nodes,) need against the layered cells now [N]."""
        layered, y = self.layered.view(), self.motion.y
        crack_forces(layered.used, y.shape[2], y.reshape(5, -1), 1.0, layered.plate, layered.cells)
        on = held[self.grid.cell_nodes[self.layered.cell]]  # (count, 4)
        return -float((layered.cells.force[:, U_X, : layered.used].T * on).sum())

    @property
    def crack_losses(self) -> dict[str, float]:
        """What cracking, crushing, rubbing and switching have taken [J]."""
        return self.layered.losses

    def lose(self, cells: BoolArray, s: State) -> float:
        """Layered cells, marked in ``cells`` (count,), go; returns their energy in this state [J]."""
        stored = float(self._energies(s.u, s.q)[cells].sum())
        self.layered.drop(cells)
        return stored
