"""Implicit dynamics of the sheet between two failures.

The sheet obeys M a + C v + K x = f(t, x): lumped mass, hydrodynamic damping on w and stiffness-proportional material
damping (2.27)-(2.33), springs and Kelvin foundation, with external forces and the nonlinear contact of its edge.
The scheme is that of `lattice.implicit.step`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lattice.assembly import (
    CellSprings,
    foundation,
    in_plane_mass,
    in_plane_springs,
    out_of_plane_mass,
    out_of_plane_springs,
)
from lattice.contact import EdgeContact, Lever, lever_of, point_displacement
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.implicit.edge import Edge
from lattice.implicit.linear import CrackedSystem
from lattice.implicit.step import GAMMA, Stage, Step
from lattice.memory import Memory, remember
from lattice.springs import SpringTable
from lattice.state import State
from lattice.stiffness import Springs
from lattice.team import CREW, TILES, Team
from lattice.varied import Varied


class Engine:
    """Time integration of a sheet that loses cells. Factorisations are kept for every step length in use."""

    _written: tuple[str, ...] = ("_intact", "_systems")  #: see `memory.remember`

    def __init__(
        self,
        grid: Grid,
        ice: Ice,
        springs: Springs,
        *,
        held_in_plane: BoolArray,
        damping: float = 0.0,
        alpha: float = 0.0,
        varied: Varied | None = None,
        threads: int = 1,
    ):
        """``held_in_plane`` (nodes,) nodes held in x and y, or (nodes, 2) each direction on its own.

        ``damping`` is the hydrodynamic damping per area [N s/m3], ``alpha`` the material damping [s] (2.27), ``varied``
        what differs from cell to cell. ``threads`` work together, at most `team.TILES`; bits are the same for any
        number.
        """
        if not 1 <= threads <= TILES:
            raise ValueError(f"a sheet on {threads} threads; give 1 to {TILES}")
        self.threads = threads
        self.grid, self.ice, self.alpha = grid, ice, alpha
        self.M_u, self.M_q = in_plane_mass(grid, ice), out_of_plane_mass(grid, ice)
        self.inertia_u, self.inertia_q = self.M_u, self.M_q  #: with which the nodes move, see `ExplicitEngine`
        self.C_q, self.k_f = foundation(grid, damping), foundation(grid, ice.k_f)
        self.rows_u, self.rows_q = in_plane_springs(springs), out_of_plane_springs(springs, grid.d)
        self.varied = Varied.uniform(grid.cells) if varied is None else varied
        self._cells = tuple(CellSprings(rows, self.varied.springs) for rows in (self.rows_u, self.rows_q))
        self.springs_u, self.springs_q = (SpringTable.of(grid, *springs) for springs in self._cells)
        self.held = np.broadcast_to(held_in_plane.reshape(grid.nodes, -1), (grid.nodes, 2))  #: (nodes, 2) in x and y
        self._held = self.held.ravel()
        self._intact = np.ones(grid.cells, bool)
        self._systems: dict[float, tuple[CrackedSystem, CrackedSystem]] = {}

    @property
    def held_x(self) -> BoolArray:
        """In-plane dof that are held along x, (2 nodes,)."""
        return np.asarray(self._held & (np.arange(2 * self.grid.nodes) % 2 == 0))

    def use(self, dt: float) -> None:
        """Makes the systems of this step length the present ones."""
        a = self._a = float(GAMMA * dt)
        if dt not in self._systems:
            scale, free = 1.0 + self.alpha / a, np.zeros(3 * self.grid.nodes, bool)
            on_q = self.M_q / a**2 + self.C_q / a + self.k_f
            self._systems[dt] = (
                CrackedSystem(self.grid, self._cells[0], self._intact, self.M_u / a**2, scale, self._held),
                CrackedSystem(self.grid, self._cells[1], self._intact, on_q, scale, free),
            )
        self._in, self._out = self._systems[dt]

    def save(self) -> Memory:
        """What `memory.recall` sets back. A system that is first used later is made anew then."""
        systems = [s for pair in self._systems.values() for s in pair]
        return [*remember(self, *self._written), *(m for s in systems for m in s.save())]

    def remove(self, cells: IntArray) -> None:
        """Takes failed cells out of all systems (thesis 4.2.1: springs go, mass stays)."""
        self._intact[cells] = False
        for pair in self._systems.values():
            for system in pair:
                system.remove(cells)

    def layered_energy(self, u: Array, q: Array, touching: BoolArray | None = None) -> float:  # noqa: ARG002
        """Energy of cracked cells that go on carrying load, of those with a node in ``touching`` or of all [J]."""
        return 0.0

    def lean_energy(self, u: Array, live: BoolArray) -> float:  # noqa: ARG002
        """Energy by which the slopes of elastic cells, those in ``live`` (cells,), add to that of their springs [J]."""
        return 0.0

    @property
    def crack_losses(self) -> dict[str, float]:
        """What such cells have taken, by cause [J]."""
        return {}

    def equilibrium(self, force_u: Array, force_q: Array) -> State:
        """State of rest under constant forces (n, 2), (n, 3); a floe that nothing holds stays where it is in plane."""
        g, n = self.grid, self.grid.nodes
        supported = np.zeros(3 * n, bool)
        q = CrackedSystem(g, self._cells[1], self._intact, self.k_f, 1.0, supported).solve(force_q.ravel())
        u = np.zeros(2 * n)
        if self._held.any():
            u = CrackedSystem(g, self._cells[0], self._intact, np.zeros(2 * n), 1.0, self._held).solve(force_u.ravel())
        return State(u.reshape(n, 2), q.reshape(n, 3), np.zeros((n, 2)), np.zeros((n, 3)))

    def step(self, t: float, dt: float, state: State, force_u: Array, force_q: Array, contact: EdgeContact) -> Step:
        """One step from time t. ``force_u`` (n, 2) and ``force_q`` (n, 3) are constant external forces.

        Displacements are relative to the frame that drifts with the ice.
        """
        self.use(dt)
        first = self._euler(t + self._a, state, force_u, force_q, contact)
        back, s1 = (1.0 - GAMMA) * dt, first.state
        start = State(
            state.u + back * s1.u_dot,
            state.q + back * s1.q_dot,
            state.u_dot + back * first.u_acc,
            state.q_dot + back * first.q_acc,
        )
        return Step(dt, state, (first, self._euler(t + dt, start, force_u, force_q, contact)), lever_of(contact))

    def _euler(self, t: float, s: State, force_u: Array, force_q: Array, contact: EdgeContact) -> Stage:
        """Backward Euler over a: (D + (1 + alpha/a) K) x = f + M (x_0/a^2 + v_0/a) + C x_0/a + alpha/a K x_0.

        D = M/a^2 + C/a + k_f. With x = c x_0 + d, c = (alpha/a) / (1 + alpha/a), the product with K goes:
        (D + (1 + alpha/a) K) d = f + M ((1 - c) x_0/a^2 + v_0/a) + (1 - c) C x_0/a - c k_f x_0.
        """
        a, nodes, f = self._a, contact.nodes, np.zeros((0, 3))
        c = self.alpha / (a + self.alpha)
        old_u, old_q = s.u.ravel(), s.q.ravel()
        b_u = force_u.ravel() + self.M_u * ((1.0 - c) / a**2 * old_u + s.u_dot.ravel() / a)
        b_q = force_q.ravel() + self.M_q * ((1.0 - c) / a**2 * old_q + s.q_dot.ravel() / a)
        b_q += ((1.0 - c) / a * self.C_q - c * self.k_f) * old_q
        half_u, half_q = self._both(lambda: self._in.half(b_u), lambda: self._out.half(b_q))
        if len(nodes):
            edge, start = self.edge(nodes, lever_of(contact)), point_displacement(s.u, s.q, nodes, lever_of(contact))
            f = edge.force(t, c * start + edge.free(half_u, half_q), contact)
            if f.any():
                edge.push(f, half_u, half_q)
        whole_u, whole_q = self._both(lambda: self._in.whole(half_u), lambda: self._out.whole(half_q))
        u, q = c * s.u + whole_u.reshape(-1, 2), c * s.q + whole_q.reshape(-1, 3)
        u_dot, q_dot = (u - s.u) / a, (q - s.q) / a
        return Stage(State(u, q, u_dot, q_dot), (u_dot - s.u_dot) / a, (q_dot - s.q_dot) / a, f)

    def _both(self, in_plane: Callable[[], Array], out_of_plane: Callable[[], Array]) -> tuple[Array, Array]:
        """What two calls, one for each system, return: at the same time where there are two threads."""
        if self.threads == 1:
            return in_plane(), out_of_plane()
        calls, found = (out_of_plane, in_plane), [np.empty(0), np.empty(0)]

        def one(team: Team) -> None:
            found[team.member] = calls[team.member]()

        CREW.run(one, 2, 0)
        return found[1], found[0]

    def edge(self, nodes: IntArray, lever: Lever) -> Edge:
        """Points at the end of these levers on nodes (m,), in the systems in use."""
        length = self.grid.d * max(self.grid.nx, self.grid.ny)
        return Edge((self._in, self._out), nodes, lever, length)
