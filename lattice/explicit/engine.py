"""The explicit engine: the same lattice as `lattice.implicit.engine`, marched in sub-steps below the critical one.

Waves and the inertia of a crack are resolved. The sub-step is a fixed share of the critical step of the true largest
frequency, damping included; failed cells only lower that frequency, since their mass stays.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from lattice.assembly import assemble
from lattice.contact import EdgeContact, lever_of
from lattice.criteria.laws import combined_tension
from lattice.explicit import layout
from lattice.explicit.forces import Made, PointForces, Sums, Touch, touch_at
from lattice.explicit.kernels import pull_of_springs, push, sweep, unpack
from lattice.explicit.layout import Motion, PerNode
from lattice.explicit.march import march
from lattice.explicit.readings import add_path, deflections, points
from lattice.explicit.screen import Judge, screen_of, thresholds
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.state import State
from lattice.stepper import critical_step
from lattice.stiffness import Springs

#: longest sub-step: the critical one is exact (a test runs 0.999 and 1.01 of it), a tenth is left for the contact's
#: stiffness, which the frequency of the lattice alone does not know [-]
SHARE_OF_CRITICAL = 0.9


class SubSteps(NamedTuple):
    """How long sub-steps are, and may be."""

    longest: float | None = None  #: [s]; None: `SHARE_OF_CRITICAL` of the critical one
    #: factor on the mass in the plane and the rotary inertia, whose waves are the fastest: where the inertia of cracks
    #: does not matter sub-steps may be longer. The mass of the deflection stays the true one [-]
    scaling: float = 1.0


TRUE_INERTIA = SubSteps()  #: as long as is stable


@dataclass(frozen=True)
class Marched:
    """Some sub-steps."""

    steps: int
    failed: bool  #: a cell is overloaded at the end of the last one
    contact: Array  #: mean force on the nodes of the contact, (m, 3) [N]
    contact_work: float  #: [J]
    work: Array  #: (loads,) of the other forces [J]
    loss: float  #: taken by hydrodynamic and material damping [J]
    hold: float  #: mean force along x that held nodes take from all cells [N]


class ExplicitEngine(Engine):
    """Leapfrog of a sheet that loses cells; `Engine` keeps masses, springs and the stiffness of single points.

    Nothing in its arrays outlives a window: `set_cells` and `start` fill them.
    """

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        window: float,
        *,
        sub_steps: SubSteps = TRUE_INERTIA,
        **options: Any,
    ):
        """As `Engine`; ``window`` [s] is cut into equal sub-steps. ValueError if they are not stable."""
        step, scaling = sub_steps
        super().__init__(grid, ice, springs, **options)
        self._thick = layout.at_cells(grid, self.varied.thickness, 1.0)
        self.inertia_u = scaling * self.M_u
        self.inertia_q = (self.M_q.reshape(-1, 3) * (1.0, scaling, scaling)).ravel()
        self.critical = self._critical_step()
        self._springs, self._longest = layout.half_springs(springs, grid.d), step
        if step is not None and not 0.0 < step <= self.critical:
            raise ValueError(
                f"sub-step {step:.3g} s of the explicit engine is not stable: use at most "
                f"{self.critical:.3g} s (largest frequency of the lattice, damping included)"
            )
        self.damping = options.get("damping", 0.0)
        self._judge: Judge = combined_tension
        self.parts = 1  #: equal parts of a window that are whole numbers of sub-steps
        self._jump = np.zeros((grid.nodes, 5))  #: change of the velocities in the sub-step after the last state
        self.set_window(window)

    def set_window(self, window: float) -> None:
        """Cuts windows of this length [s] from the next `start` on."""
        self.window = window
        longest = self._longest or SHARE_OF_CRITICAL * self.critical
        self.sub_steps = self.parts * math.ceil(window / self.parts / longest)
        self.allocate(window / self.sub_steps)

    def watch(self, judge: Judge) -> None:
        """From now on `march` stops where this law of `screen.SCREENED` says so."""
        self._judge, self.screen = judge, screen_of(self.ice, self._thick, judge)

    def _critical_step(self) -> float:
        share = self.varied.springs
        K_u, K_q = (assemble(self.grid, rows, share=share).tocsr() for rows in (self.rows_u, self.rows_q))
        floating, damped = K_q + sp.diags(self.k_f), self.alpha * K_q + sp.diags(self.C_q)
        in_plane = critical_step(K_u, self.alpha * K_u, self.inertia_u)
        return min(in_plane, critical_step(floating, damped, self.inertia_q))

    def allocate(self, dt: float) -> None:
        """New arrays for sub-steps of this length [s], whether it is stable or not; all cells and nodes are there."""
        g, ice = self.grid, self.ice
        self.dt = dt
        u, q = self.inertia_u[::2], self.inertia_q
        kick = PerNode(np.where(self._held[::2], 0.0, dt / u), dt / q[::3], dt / q[1::3])
        pace = layout.pace(ice, dt, self.alpha, self.damping)
        self.mesh = layout.mesh(g, self.held[:, 0], kick, self._springs, pace, dt)
        self.screen = screen_of(ice, self._thick, self._judge)
        self.motion = layout.motion(g)
        self.set_cells(np.ones(g.cells, bool), np.full(g.cells, ice.sigma_t), np.ones(g.nodes, bool))

    def set_cells(self, live: BoolArray, limits: Array, present: BoolArray) -> None:
        """Cells that carry force, their tensile limits (cells,) [Pa], and the nodes that are still in the lattice.

        `march` stops at a limit; an infinite one stops it never. Limits are those of the mean ice.
        """
        g = self.grid
        shape = (g.nx - 1, g.ny - 1)
        for share, values in zip(self.mesh.intact, self.varied.springs.T, strict=True):
            share[1 : g.nx, 1 : g.ny] = np.where(live, values, 0.0).reshape(shape)
        threshold = thresholds(limits, self.ice, g.d, self._judge) / self.varied.weakness
        threshold = np.where(live, threshold, np.inf)
        self.mesh.threshold[: g.nx - 1, : g.ny - 1] = threshold.reshape(shape)
        gone = ~present.reshape(g.nx, g.ny)
        for array in self.motion:
            array[:, : g.nx, : g.ny][:, gone] = 0.0

    # ---- states ------------------------------------------------------------------------------------------------

    def start(self, s: State, present: BoolArray, forces: tuple[PointForces, ...]) -> None:
        """Takes over a state; the velocity goes back by half a sub-step."""
        on, now = present[:, None], self.motion
        self.put(now.y, np.hstack((s.u, s.q)) * on)
        self.put(now.v, np.hstack((s.u_dot, s.q_dot)) * on)
        x, v = now.y.copy(), now.v.copy()
        now.v[:] = 1.5 * v - 0.5 * self._next_velocity(Motion(x + self.alpha * v, v), forces)
        now.y[:] = x + self.alpha * now.v

    def state(self, old: State, present: BoolArray, forces: tuple[PointForces, ...]) -> State:
        """The state now under these forces; nodes that have left keep theirs."""
        (y, before), after, on = self.motion, self.look_ahead(forces), present[:, None]
        x, x_dot = self.get(y - self.alpha * before), self.get(0.5 * (before + after))
        return State(
            np.where(on, x[:, :2], old.u),
            np.where(on, x[:, 2:], old.q),
            np.where(on, x_dot[:, :2], old.u_dot),
            np.where(on, x_dot[:, 2:], old.q_dot),
        )

    def look_ahead(self, forces: tuple[PointForces, ...]) -> Array:
        """Velocities after one more sub-step under these forces, as `Motion.v`; `ripple` is then that of now."""
        after = self._next_velocity(Motion(self.motion.y.copy(), self.motion.v), forces)
        self._jump = self.get(after - self.motion.v)
        return after

    def moving(self, old: State, present: BoolArray) -> State:
        """The state now with the velocity of half a sub-step ago; nodes that have left keep theirs."""
        v = self.motion.v
        now, then = (*self.displacement(), *self._at_nodes(Motion(v, v), 0.0)), (old.u, old.q, old.u_dot, old.q_dot)
        gone = np.flatnonzero(~present)
        for new, was in zip(now, then, strict=True):
            new[gone] = was[gone]
        return State(*now)

    def ripple(self, nodes: BoolArray) -> float:
        """dt^2/8 a . M a of ``nodes`` (n,), by which the energy of their last state exceeds what leapfrog conserves."""
        square = self._jump**2
        u, q = self.inertia_u.reshape(-1, 2) * square[:, :2], self.inertia_q.reshape(-1, 3) * square[:, 2:]
        return 0.125 * float(u[nodes].sum() + q[nodes].sum())

    def _next_velocity(self, now: Motion, forces: tuple[PointForces, ...]) -> Array:
        """Velocity after one more sub-step; ``y`` is used up, ``v`` is not."""
        mesh, trial = self.mesh, Motion(now.y, now.v.copy())
        sweep(trial, mesh.intact, mesh.kick, mesh.springs, mesh.pace, mesh.rows)
        for f in forces:
            push(f.row, f.column, f.force, trial, mesh.kick, mesh.pace.go)
        return trial.v

    def put(self, array: Array, values: Array) -> None:
        """Writes values (nodes, 5) into one of the arrays of `Motion`."""
        array[:] = 0.0
        array[:, : self.grid.nx, : self.grid.ny] = values.T.reshape(5, self.grid.nx, self.grid.ny)

    def get(self, array: Array) -> Array:
        """Values (nodes, 5) of one of the arrays of `Motion`."""
        return array[:, : self.grid.nx, : self.grid.ny].reshape(5, -1).T

    def displacement(self, ago: float = 0.0) -> tuple[Array, Array]:
        """U (n, 2) and q (n, 3) now, or ``ago`` sub-steps before, up to one."""
        return self._at_nodes(self.motion, self.alpha + ago * self.dt)

    def _at_nodes(self, motion: Motion, ago: float) -> tuple[Array, Array]:
        """Values y - ago v of all nodes, (n, 2) and (n, 3)."""
        u, q = np.empty((self.grid.nodes, 2)), np.empty((self.grid.nodes, 3))
        unpack(motion, ago, self.grid.ny, u, q)
        return u, q

    def deflections(self, q: Array) -> None:
        """Writes w, phi_x and phi_y of all nodes now into q (n, 3)."""
        deflections(self.motion, self.alpha, self.grid.ny, q)

    def add_path(self, time: float, before: Array, path: Array) -> None:
        """Adds what they do in a ``time`` [s] to their integral, by the trapezoidal rule; both (n, 3)."""
        add_path(self.motion, self.alpha, self.grid.ny, 0.5 * time, before, path)

    # ---- forces ------------------------------------------------------------------------------------------------

    def touch(self, t: float, contact: EdgeContact) -> Touch:
        """Contact force and tangent at time t for the displacements now."""
        return touch_at(t, contact, self.touching(contact), self.grid.ny)

    def touching(self, contact: EdgeContact) -> Array:
        """Displacements of the points of action now, (m, 3) [m]."""
        lever = map(np.ascontiguousarray, lever_of(contact))
        return np.asarray(points(contact.nodes, self.grid.ny, *lever, self.motion, self.alpha))

    def march(self, steps: int, load: PointForces, touch: Touch, lively: bool) -> Marched:
        """Up to ``steps`` sub-steps, to the first failure; damping is taken stock of in each or in the first only."""
        m = len(touch.row)
        sums = Sums(np.zeros((m, 5)), np.zeros((m, 3)), np.zeros(len(load.first) - 1))
        made = self.loop(steps, 1 if lively else steps, load, touch, sums)
        loss = made.loss * (1 if lively else made.steps)
        work, contact_work = self.dt * sums.work, self.dt * made.contact_work
        n, failed = made.steps, made.overloaded > 0
        return Marched(n, failed, sums.contact / n, contact_work, work, loss, made.hold / n)

    def hold(self) -> float:
        """Force along x that held nodes take from all cells now [N]."""
        every, mesh = (0, self.grid.nx), self.mesh
        return float(pull_of_springs(every, self.motion, mesh.intact, mesh.held, mesh.springs))

    def loop(self, steps: int, stride: int, load: PointForces, touch: Touch, sums: Sums) -> Made:
        """The compiled loop. A lattice whose cells carry more than springs runs its own here."""
        return Made(*march(steps, stride, self.motion, self.mesh, self.screen, load, touch, sums))
