"""The explicit engine: the same lattice as `lattice.engine`, marched in sub-steps below the critical one.

Waves and the inertia of a crack are resolved. The sub-step is a fixed share of the critical step of the true largest
frequency, damping included; failed cells only lower that frequency, since their mass stays.
"""

from __future__ import annotations

import math

import numpy as np
import scipy.sparse as sp

from lattice.assembly import assemble
from lattice.criteria import mohr_factors
from lattice.engine import EdgeContact, Engine, State, point_displacement
from lattice.grid import Array, Grid, IntArray
from lattice.ice import Ice
from lattice.kernels import LANES, LINE, LINES, push, sweep
from lattice.march import Marched, NodeForces, march
from lattice.stepper import critical_step
from lattice.stiffness import Springs

SHARE_OF_CRITICAL = 0.9  #: longest sub-step


def aligned(*shape: int) -> Array:
    """Zeros that begin at a cache line: a vector that lies across two lines costs two accesses (measured: 30 %)."""
    raw = np.zeros(math.prod(shape) + LANES)
    start = -raw.ctypes.data // 8 % LANES
    return raw[start : start + math.prod(shape)].reshape(shape)


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
        held_in_plane: np.ndarray,
        damping: float = 0.0,
        alpha: float = 0.0,
        step: float | None = None,
    ):
        """``window`` [s] is cut into equal sub-steps of at most ``step`` [s] (default: `SHARE_OF_CRITICAL`)."""
        super().__init__(grid, ice, springs, held_in_plane=held_in_plane, damping=damping, alpha=alpha)
        self.critical = self._critical_step()
        self._springs, self._longest = springs, step
        if step is not None and not 0.0 < step <= self.critical:
            raise ValueError(
                f"sub-step {step:.3g} s of the explicit engine is not stable: use at most "
                f"{self.critical:.3g} s (largest frequency of the lattice, damping included)"
            )
        self.damping = damping
        self.ripple = 0.0  #: dt^2/8 a . M a, by which the energy of a state exceeds what leapfrog conserves [J]
        self.set_window(window)

    def set_window(self, window: float) -> None:
        """Cuts windows of this length [s] from the next `start` on."""
        self.window = window
        self.sub_steps = math.ceil(window / (self._longest or SHARE_OF_CRITICAL * self.critical))
        self.dt = window / self.sub_steps
        self._allocate(self._springs)

    def _critical_step(self) -> float:
        K_u, K_q = assemble(self.grid, self.rows_u).tocsr(), assemble(self.grid, self.rows_q).tocsr()
        floating, damped = K_q + sp.diags(self.k_f), self.alpha * K_q + sp.diags(self.C_q)
        return min(critical_step(K_u, self.alpha * K_u, self.M_u), critical_step(floating, damped, self.M_q))

    def _allocate(self, s: Springs) -> None:
        """Arrays of `lattice.kernels`."""
        g, ice, dt = self.grid, self.ice, self.dt
        columns = -(-g.ny // LANES) * LANES
        wide = columns + LANES
        if wide > LINE:
            raise ValueError(f"{g.ny} nodes across are too many for the explicit engine: use at most {LINE - LANES}")
        self.y, self.v = aligned(5, g.nx + 1, wide), aligned(5, g.nx + 1, wide)
        self._scratch, self._rows = aligned(3, 5, g.nx + 1, wide), aligned(LINES * LINE)
        self._cells, self._kick = aligned(g.nx + 1, wide), aligned(3, g.nx, columns)
        self._limit, self._mass = aligned(g.nx, columns), aligned(3, g.nx, columns)
        self._limit[:] = np.inf
        free = np.where(self._held[::2], 0.0, dt / self.M_u[::2])
        for k, kick in enumerate((free, dt / self.M_q[::3], dt / self.M_q[1::3])):
            self._kick[k, :, : g.ny] = kick.reshape(g.nx, g.ny)
        np.divide(dt, self._kick, out=self._mass, where=self._kick > 0.0)
        self._spring = np.array(
            [
                0.5 * s.K_n_axi,
                0.5 * s.K_s_axi,
                0.5 * s.K_out,
                0.5 * s.G_r_axi,
                0.5 * s.G_t_axi,
                0.5 * s.K_n_dia,
                0.5 * s.G_dia,
                0.5 * g.d,
            ]
        )
        per_mass = dt / (ice.rho_i * ice.h)
        self._pace = np.array(
            [self.alpha, dt + self.alpha, per_mass * ice.k_f, per_mass * (self.damping - self.alpha * ice.k_f)]
        )
        F_1, self._F_2 = mohr_factors(ice.nu, np.inf if np.isinf(ice.sigma_t) else ice.sigma_c / ice.sigma_t)
        ratio = 1.0 if ice.sigma_t == ice.sigma_f else ice.sigma_t / ice.sigma_f
        self._crack = np.array([F_1, 0.5 * ice.h * ratio])
        self.set_cells(np.ones(g.cells, bool), np.full(g.cells, ice.sigma_t), np.ones(g.nodes, bool))

    def set_cells(self, live: np.ndarray, limits: Array, present: np.ndarray) -> None:
        """Cells that carry force, their tensile limits [Pa] (cells,), and the nodes that are still in the lattice."""
        g = self.grid
        shape = (g.nx - 1, g.ny - 1)
        self._cells[1 : g.nx, 1 : g.ny] = live.reshape(shape)
        threshold = np.where(live, 4.0 * g.d * self._F_2 * limits / self.ice.E, np.inf)
        self._limit[: g.nx - 1, : g.ny - 1] = threshold.reshape(shape)
        gone = ~present.reshape(g.nx, g.ny)
        for array in (self.y, self.v):
            array[:, : g.nx, : g.ny][:, gone] = 0.0

    # ---- states ------------------------------------------------------------------------------------------------

    def start(self, s: State, present: np.ndarray, forces: tuple[NodeForces, ...]) -> None:
        """Takes over a state; the velocity goes back by half a sub-step."""
        on = present[:, None]
        self._put(self.y, np.hstack((s.u, s.q)) * on)
        self._put(self.v, np.hstack((s.u_dot, s.q_dot)) * on)
        x, v = self.y.copy(), self.v.copy()
        self.v[:] = 1.5 * v - 0.5 * self._next_velocity(x + self.alpha * v, v, forces)
        self.y[:] = x + self.alpha * self.v

    def state(self, old: State, present: np.ndarray, forces: tuple[NodeForces, ...]) -> State:
        """The state now under these forces; nodes that have left keep theirs."""
        after = self._next_velocity(self.y.copy(), self.v, forces)
        v, jump = 0.5 * (self.v + after), self._get(after - self.v)
        self.ripple = 0.125 * float(
            (self.M_u * jump[:, :2].ravel() ** 2).sum() + (self.M_q * jump[:, 2:].ravel() ** 2).sum()
        )
        x, x_dot, on = self._get(self.y - self.alpha * self.v), self._get(v), present[:, None]
        return State(
            np.where(on, x[:, :2], old.u),
            np.where(on, x[:, 2:], old.q),
            np.where(on, x_dot[:, :2], old.u_dot),
            np.where(on, x_dot[:, 2:], old.q_dot),
        )

    def _next_velocity(self, y: Array, v: Array, forces: tuple[NodeForces, ...]) -> Array:
        v = v.copy()
        sweep(y, v, self._cells, self._kick, self._spring, self._pace, self._rows)
        for f in forces:
            push(f.row, f.column, f.padded(), y, v, self._kick, self._pace[1])
        return v

    def _put(self, array: Array, values: Array) -> None:
        array[:] = 0.0
        array[:, : self.grid.nx, : self.grid.ny] = values.T.reshape(5, self.grid.nx, self.grid.ny)

    def _get(self, array: Array) -> Array:
        return array[:, : self.grid.nx, : self.grid.ny].reshape(5, -1).T

    def displacement(self, ago: float = 0.0) -> tuple[Array, Array]:
        """U (n, 2) and q (n, 3) now, or ``ago`` sub-steps before, up to one."""
        x = self._get(self.y - (self.alpha + ago * self.dt) * self.v)
        return np.ascontiguousarray(x[:, :2]), np.ascontiguousarray(x[:, 2:])

    # ---- forces ------------------------------------------------------------------------------------------------

    def constant(self, force_u: Array, force_q: Array) -> NodeForces:
        """Forces (n, 2), (n, 3) that are not zero."""
        force = np.hstack((force_u, force_q))
        nodes = np.flatnonzero(force.any(axis=1))
        return NodeForces(*np.divmod(nodes, self.grid.ny), np.ascontiguousarray(force[nodes]))

    def contact(self, t: float, contact: EdgeContact) -> NodeForces:
        """Contact force and tangent at time t for the displacements now."""
        return self.contact_at(t, contact, self.touching(contact))

    def touching(self, contact: EdgeContact) -> Array:
        """Displacements of the points of action now, (m, 3) [m]."""
        u, q = np.split(self.at(contact.nodes), [2], axis=1)
        return point_displacement(u, q, np.arange(len(u)), contact.height)

    def contact_at(self, t: float, contact: EdgeContact, at: Array) -> NodeForces:
        """The same for displacements ``at`` (m, 3) of the points of action [m]."""
        force, tangent = contact.evaluate(t, np.ascontiguousarray(at))
        return NodeForces(
            *np.divmod(contact.nodes, self.grid.ny),
            force,
            np.ascontiguousarray(at),
            tangent,
            np.ascontiguousarray(contact.height),
        )

    def at(self, nodes: IntArray) -> Array:
        """Displacements of some nodes now, (k, 5)."""
        row, column = np.divmod(nodes, self.grid.ny)
        return (self.y[:, row, column] - self.alpha * self.v[:, row, column]).T

    def march(self, steps: int, load: NodeForces, contact: NodeForces, lively: bool) -> Marched:
        """Up to ``steps`` sub-steps, to the first failure; damping is taken stock of in each or in the first only."""
        m = len(contact.row)
        total, books = np.zeros((m, 3)), np.zeros(3)
        made, count = march(
            steps,
            1 if lively else steps,
            self.y,
            self.v,
            self._scratch,
            self._cells,
            self._kick,
            self._mass,
            self._limit,
            self._spring,
            self._pace,
            self._crack,
            self._rows,
            load.row,
            load.column,
            load.force,
            contact.row,
            contact.column,
            contact.height,
            contact.at,
            contact.force,
            contact.tangent,
            np.zeros((m, 5)),
            total,
            books,
        )
        loss = books[2] * (1 if lively else made)
        return Marched(made, count > 0, total / made, self.dt * books[0], self.dt * books[1], loss)
