"""The explicit engine of a sheet whose cracked cells go on carrying load."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lattice.cracks.begin import face_stresses
from lattice.cracks.blocks import GIVEN
from lattice.cracks.cells import HOURGLASS, SWITCHING, Plate
from lattice.cracks.law import CrackLaw, local_of
from lattice.cracks.lean import book_pull, gather_lean, lean_energy
from lattice.cracks.march import Stretch, march_cracked
from lattice.cracks.motion import Nodes, crack_forces, energies, evaluate_at, give, hourglass_energy, pull_on_held
from lattice.cracks.state import LayeredCells
from lattice.explicit import layout
from lattice.explicit.engine import TRUE_INERTIA, ExplicitEngine, SubSteps
from lattice.explicit.forces import Made, PointForces, Sums, Touch
from lattice.explicit.kernels import push, sweep
from lattice.explicit.layout import LANES, Motion
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import Springs
from lattice.strain import CellState
from lattice.team import ALONE, CREW, Team
from lattice.varied import Varied

#: largest material damping where inertia is scaled, as share of the critical sub-step: a tenth of the sub-step is lost,
#: waves still die out within some ten periods, and the peak of the 165 m floe moves by 0.2 % (1e-4 against 1e-3 s) [-]
SLOW_DAMPING = 0.1


#: sub-steps of slow interaction: the factor 1 instead of 4 moves the peak of the 165 m floe by 0.7 %
SLOW = SubSteps(scaling=4.0)


class CrackingEngine(ExplicitEngine):
    """Leapfrog of a lattice with layered cells, which are none of its springs."""

    _written = (*ExplicitEngine._written, "layered")
    slopes = True  #: strain the middle plane; False: rotations are small

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        window: float,
        *,
        law: CrackLaw,
        rigid: float | None = None,
        **options: Any,
    ):
        """As `ExplicitEngine`, with the ``law`` of the cracks; ``rigid`` as in `local_of`, for ice that varies."""
        plate = Plate(grid.d, ice.h, 0.5 * springs.K_out, HOURGLASS * ice.E * ice.h)
        varied = options.get("varied") or Varied.uniform(grid.cells)
        E, s, t = (layout.at_places(grid, values) for values in (varied.E, varied.strength, varied.thickness))
        self.layered = LayeredCells(law, plate, local_of(law, E, s, t, rigid))
        self.layered.leans = self.slopes
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

    def set_cells(self, live: BoolArray, limits: Array, present: BoolArray) -> None:
        """As `ExplicitEngine`; of cells that are gone the slope does nothing any more."""
        super().set_cells(live, limits, present)
        lean, carries = self.layered.lean, self._at_cells(live)
        lean.stress[:] *= carries
        carries[self.layered.corner] = 1.0
        lean.pull[:] *= carries
        my, places = self.motion.y.shape[2], self.motion.y[0].size
        gather_lean((0, places), my, self.layered.view())

    def lose_springs(self, cells: IntArray) -> None:
        """As `set_cells` with these no longer live, and all else as it was."""
        (i, j), my, lean = np.divmod(cells, self.grid.ny - 1), self.motion.y.shape[2], self.layered.lean
        for share in self.mesh.intact:
            share[i + 1, j + 1] = 0.0
        self.mesh.threshold[i, j] = np.inf
        lean.stress[:, i * my + j] *= 0.0
        gather_lean((0, lean.stress.shape[1]), my, self.layered.view())

    def _at_cells(self, values: NDArray[Any]) -> Array:
        """Values (cells,) at the places of their nodes 0, (places,)."""
        padded, g = np.zeros_like(self.motion.y[0]), self.grid
        padded[: g.nx - 1, : g.ny - 1] = values.reshape(g.nx - 1, g.ny - 1)
        flat: Array = padded.reshape(-1)
        return flat

    def _nodes(self) -> Nodes:
        y, v = (a.reshape(5, -1) for a in self.motion)
        return Nodes(y, v, self.motion.y.shape[2], self.alpha, self.dt)

    def book_pull(self, time: float) -> None:
        """Books the work of slopes at the present velocity for a time [s]."""
        v, layered = self.motion.v.reshape(5, -1), self.layered.view()
        book_pull(0, (0, v.shape[1]), time, v, layered)

    def hold(self) -> float:
        """As `ExplicitEngine.hold`, from layered cells and slopes as well."""
        layered, y = self.layered.view(), self.motion.y
        crack_forces(y.shape[2], y.reshape(5, -1), layered)
        return super().hold() + float(pull_on_held((0, y[0].size), self.mesh.held.reshape(-1), layered.nodes.force))

    def loop(self, steps: int, stride: int, load: PointForces, touch: Touch, sums: Sums) -> Made:
        """The compiled loop with the forces of the layered cells."""
        layered = self.layered.view()

        def go(team: Team) -> Made:
            stretch = Stretch(steps, stride, team)
            made: Made = march_cracked(stretch, self.motion, self.mesh, self.screen, load, touch, sums, layered)
            return made

        if self.threads == 1:
            return go(ALONE)
        made: Made = CREW.run(go, self.threads, (layered.used // LANES + 1) * GIVEN)
        return made

    def begin(self, cell: int, angle: float) -> float:
        """A cell becomes layered as it is now; returns the energy that it then stores [J]."""
        k, nodes = self.layered.add(cell, self._corner(cell), angle), self._nodes()
        layered = self.layered.view()
        stored = float(evaluate_at(k, nodes, layered))
        # what the springs of the cell had is booked by who takes them away
        layered.cells.losses[0, SWITCHING] += stored
        return stored + float(hourglass_energy(k, nodes, layered))

    def begin_cracked(self, cell: int, angle: float) -> None:
        """A cell at rest is cracked through across this direction, and the crack is closed."""
        k = self.layered.add(cell, self._corner(cell), angle)
        self.layered.crack_through(k)
        evaluate_at(k, self._nodes(), self.layered.view())

    def crack(self, live: BoolArray) -> None:
        """Cells of ``live`` (cells,) at or past the strength of the layers become layered, and leave the mask."""
        g, (u, q) = self.grid, self.displacement()
        state = CellState.of(g, u, q, lean=self.lean_strain(), thick=self.varied.thickness)
        stress, angle = face_stresses(state, self.ice)
        for cell in np.flatnonzero(live & (self.varied.weakness * stress >= self.ice.sigma_t)):
            self.begin(int(cell), float(angle[cell]))
            live[cell] = False
        self.set_cells(live, np.full(g.cells, self.ice.sigma_t), np.ones(g.nodes, bool))

    def _corner(self, cell: int) -> int:
        i, j = divmod(cell, self.grid.ny - 1)
        my: int = self.motion.y.shape[2]
        return i * my + j

    def _next_velocity(self, now: Motion, forces: tuple[PointForces, ...]) -> Array:
        mesh, trial, layered = self.mesh, Motion(now.y, now.v.copy()), self.layered.view()
        crack_forces(now.y.shape[2], now.y.reshape(5, -1), layered)
        sweep(trial, mesh.intact, mesh.kick, mesh.springs, mesh.pace, mesh.rows)
        for f in forces:
            push(f.row, f.column, f.force, trial, mesh.kick, mesh.pace.go)
        give((0, self.grid.nx), trial, mesh.kick, mesh.pace.go, layered.nodes.force)
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
        each: Array = energies(x.shape[2], x.reshape(5, -1), layered)
        return each

    def lean_energy(self, u: Array, live: BoolArray) -> float:
        """As `Engine.lean_energy`."""
        my, layered = self.motion.y.shape[2], self.layered.view()
        return float(lean_energy(self.grid.ny, my, np.ascontiguousarray(u), live, self.varied.springs, layered))

    def lean_strain(self) -> Array:
        """Membrane strain of all cells from their slopes: xx, yy, shear in engineering measure, (3, cells)."""
        g, strain = self.grid, self.layered.lean.strain.reshape(3, *self.motion.y.shape[1:])
        held: Array = strain[:, : g.nx - 1, : g.ny - 1].reshape(3, -1)
        return held

    @property
    def crack_losses(self) -> dict[str, float]:
        """What cracking, crushing, rubbing and switching have taken [J]."""
        return self.layered.losses

    def lose(self, cells: BoolArray, s: State) -> float:
        """Layered cells, marked in ``cells`` (count,), go; returns their energy in this state [J]."""
        stored = float(self._energies(s.u, s.q)[cells].sum())
        self.layered.drop(cells)
        return stored
