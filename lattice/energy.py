"""Energy of the sheet and where it goes, exactly as the time integration has it.

For M a + C v + K x = f and the two stages (x_i, v_i, a_i) of SDIRK2 with weights b = (1 - gamma, gamma),

    E_1 - E_0 = dt sum_i b_i (f_i . v_i - v_i . C v_i) - N,   N = (gamma dt)^2 / 2 (|g_2|^2 - |g_1|^2),

with |g_i|^2 = v_i . K v_i + a_i . M a_i (Runge-Kutta energy identity; the scheme's stability matrix is
gamma^2 diag(-1, 1)). N is what the scheme takes from motions shorter than its step. Removing a cell takes its elastic
energy at the start of the step; a piece that leaves takes all it has. What then is missing is the residual.

Energies are those of an observer who drifts with the ice, to whom the structure moves and does the work. One at rest
finds V times the impulse along x more for every force, and for what holds the edge nothing else. That force is read off
the springs at the held nodes and momentum off all nodes, so that the two frames check each other.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field

import numpy as np

from lattice.compiled import compiled
from lattice.contact import point_displacement
from lattice.grid import Array, BoolArray, IntArray
from lattice.implicit.engine import Engine
from lattice.implicit.step import GAMMA, Step
from lattice.loads import Loads, total
from lattice.springs import pull_on, spring_energy
from lattice.state import State
from lattice.stock import Served, Stock, Work


@compiled()
def weighted_square(weight: Array, x: Array, present: BoolArray) -> float:
    """Sum of weight x^2 over the nodes that are present; ``weight`` (n k,), ``x`` (n, k)."""
    total, k = 0.0, x.shape[1]
    for n in range(x.shape[0]):
        if present[n]:
            for i in range(k):
                total += weight[n * k + i] * x[n, i] ** 2
    return total


@compiled()
def momentum_of(mass: Array, u_dot: Array, present: BoolArray) -> float:
    """Momentum along x of the nodes that are present [N s]; ``mass`` (2 n,), ``u_dot`` (n, 2)."""
    total = 0.0
    for n in range(u_dot.shape[0]):
        if present[n]:
            total += mass[2 * n] * u_dot[n, 0]
    return total


def no_friction(y: Array, force: Array) -> Array:  # noqa: ARG001  as every law of friction
    """A contact without friction."""
    return np.zeros_like(force)


@dataclass
class EnergyBooks:
    """Running sums since the start of a run [J]."""

    engine: Engine
    touch: Work = field(default_factory=Work)  #: of the structure
    rub: Work = field(default_factory=Work)  #: the part of it that is friction
    loads: dict[str, Work] = field(default_factory=dict)  #: of other external forces, by name of `NodeLoad`
    hold: float = 0.0  #: impulse along x of what holds the edge [N s]
    damping: float = 0.0  #: hydrodynamic and material damping
    scheme: float = 0.0  #: taken by the time integration from motions shorter than its step
    fracture: float = 0.0  #: elastic energy of cells when they failed
    pieces: Stock = field(default_factory=Stock)  #: what pieces took along
    crushed: Stock = field(default_factory=Stock)  #: what rows took along of which nothing was left
    now: Stock = field(default_factory=Stock)  #: what the sheet has
    friction_of: Callable[[Array, Array], Array] = no_friction  #: part of the forces on nodes at y (m, 3) [N]

    def __copy__(self) -> EnergyBooks:
        """A copy with records of its own, see `memory.remember`."""
        new = object.__new__(EnergyBooks)
        new.__dict__.update({k: copy(v) if isinstance(v, Work | Stock) else v for k, v in vars(self).items()})
        new.loads = {name: copy(work) for name, work in self.loads.items()}
        return new

    def __post_init__(self) -> None:
        e = self.engine
        self._held = e.held_x
        self._held_cells = np.flatnonzero(self._held[e.springs_u.dof].any(axis=1))
        self.now.mass = float(e.M_u[::2].sum())

    @property
    def contact(self) -> float:
        """Work of the structure on the sheet [J]."""
        return self.touch.work

    def load(self, name: str) -> Work:
        """Book of the external force of this name, opened when it is first asked for."""
        return self.loads.setdefault(name, Work())

    @property
    def received(self) -> float:
        """Work of all external forces but the contact [J]."""
        return sum(work.work for work in self.loads.values())

    def received_at(self, drift: float) -> float:
        """The same for a fixed observer when the frame drifts [J]."""
        return sum(work.at(drift) for work in self.loads.values())

    @property
    def handed_over(self) -> float:
        """Energy of what has left [J]."""
        return self.pieces.energy + self.crushed.energy

    @property
    def stored(self) -> float:
        """Elastic, foundation and kinetic energy of the sheet now [J]."""
        return self.now.energy

    @property
    def residual(self) -> float:
        """Energy that no term explains [J]."""
        spent = self.damping + self.scheme + self.fracture + self.handed_over + sum(self.engine.crack_losses.values())
        return self.contact + self.received - spent - self.stored

    def springs(self, u: Array, q: Array, live: BoolArray) -> float:
        """Elastic energy of live cells [J]."""
        e = self.engine
        return float(spring_energy(e.springs_u, live, u.ravel()) + spring_energy(e.springs_q, live, q.ravel()))

    def begin(self, s: State, live: BoolArray, present: BoolArray, loads: Loads) -> None:
        """Starts from rest under loads that have brought the sheet there: each in proportion to its force and path."""
        self.measure(s, live, present)
        parts = [float(np.vdot(load.force_u, s.u) + np.vdot(load.force_q, s.q)) for load in loads]
        for load, part in zip(loads, parts, strict=True):
            self.load(load.name).work = self.stored * (part / sum(parts)) if part else 0.0

    def measure(self, s: State, live: BoolArray, present: BoolArray) -> None:
        """Takes stock of a state."""
        self.now = self._stock(s, live, present)

    def _stock(self, s: State, live: BoolArray, present: BoolArray, leaving: BoolArray | None = None) -> Stock:
        e = self.engine
        return Stock(
            self.springs(s.u, s.q, live) + e.lean_energy(s.u, live) + e.layered_energy(s.u, s.q, leaving),
            self._foundation(s.q, present),
            self._kinetic(s, present),
            float(momentum_of(e.inertia_u, s.u_dot, present)),
            float(e.M_u[::2][present].sum()),
        )

    def holding(self, u: Array, u_dot: Array, force_u: Array, live: BoolArray) -> float:
        """Force along x that the held nodes need beside the springs and ``force_u`` (n, 2) [N]."""
        e = self.engine
        pull = pull_on(e.springs_u, self._held_cells, live, self._held, (u + e.alpha * u_dot).ravel())
        return float(pull) - float(force_u.ravel()[self._held].sum())

    def on_held(self, nodes: IntArray, force: Array) -> float:
        """Part along x of contact forces (m, 3) on nodes (m,) that are held: these pass it on at once [N]."""
        return float(force[self._held[2 * nodes], 0].sum())

    def _kinetic(self, s: State, present: BoolArray) -> float:
        e = self.engine
        return 0.5 * float(
            weighted_square(e.inertia_u, s.u_dot, present) + weighted_square(e.inertia_q, s.q_dot, present)
        )

    def _foundation(self, q: Array, present: BoolArray) -> float:
        return 0.5 * float(weighted_square(self.engine.k_f, q, present))

    def book_step(self, step: Step, loads: Loads, nodes: IntArray, live: BoolArray, present: BoolArray) -> None:
        """Books one accepted step; ``nodes`` are those of the contact."""
        e, dt, force_u = self.engine, step.dt, total(loads, self.engine.grid.nodes)[0]
        norms = []
        for b, stage in zip((1.0 - GAMMA, GAMMA), step.stages, strict=True):
            s = stage.state
            v = point_displacement(s.u_dot, s.q_dot, nodes, step.lever)
            y = point_displacement(s.u, s.q, nodes, step.lever)
            self.touch.add(dt * b, stage.contact, v)
            self.rub.add(dt * b, self.friction_of(y, stage.contact), v)
            for load in loads:
                book = self.load(load.name)
                book.add(dt * b, load.force_u, s.u_dot)
                book.work += dt * b * float(np.vdot(load.force_q, s.q_dot))
            self.hold += dt * b * (self.holding(s.u, s.u_dot, force_u, live) - self.on_held(nodes, stage.contact))
            rate = self.springs(s.u_dot, s.q_dot, live)
            water = float(weighted_square(e.C_q, s.q_dot, present))
            self.damping += dt * b * (water + 2.0 * e.alpha * rate)
            acceleration = State(s.u, s.q, stage.u_acc, stage.q_acc)
            norms.append(2.0 * (rate + self._foundation(s.q_dot, present) + self._kinetic(acceleration, present)))
        self.scheme += 0.5 * (GAMMA * dt) ** 2 * (norms[1] - norms[0])
        self.measure(step.state, live, present)

    def book_served(self, served: Served, s: State, live: BoolArray, present: BoolArray) -> None:
        """Books the part of a step that was used before the rest was given up; s is the state at its end."""
        for mine, done in ((self.touch, served.touch), (self.rub, served.rub)):
            mine.work, mine.push = mine.work + done.work, mine.push + done.push
        self.damping, self.hold = self.damping + served.damping, self.hold + served.hold
        self.measure(s, live, present)

    def loss_rate(self, s: State, live: BoolArray, present: BoolArray) -> float:
        """Power taken by damping in a state [W]."""
        water = float(weighted_square(self.engine.C_q, s.q_dot, present))
        alpha = self.engine.alpha
        return water + 2.0 * alpha * self.springs(s.u_dot, s.q_dot, live) if alpha else water

    def book_failure(self, cell: int, s: State) -> None:
        """Books the elastic energy of a cell that fails in state s."""
        live = np.zeros(self.engine.grid.cells, bool)
        live[cell] = True
        self.fracture += self.springs(s.u, s.q, live) + self.engine.lean_energy(s.u, live)

    def book_departure(self, nodes: IntArray, cells: BoolArray, s: State, *, crushed: bool = False) -> None:
        """Books ice that leaves with all its energy; ``cells`` is the mask of its live cells."""
        mask = np.zeros(self.engine.grid.nodes, bool)
        mask[nodes] = True
        (self.crushed if crushed else self.pieces).add(self._stock(s, cells, mask, mask))
