"""Energy of the sheet and where it goes, exactly as the time integration has it.

For M a + C v + K x = f and the two stages (x_i, v_i, a_i) of SDIRK2 with weights b = (1 - gamma, gamma),

    E_1 - E_0 = dt sum_i b_i (f_i . v_i - v_i . C v_i) - N,   N = (gamma dt)^2 / 2 (|g_2|^2 - |g_1|^2),

with |g_i|^2 = v_i . K v_i + a_i . M a_i (Runge-Kutta energy identity; the scheme's stability matrix is
gamma^2 diag(-1, 1)). N is what the scheme takes from motions shorter than its step. Removing a cell takes its elastic
energy at the start of the step; a piece that leaves takes all it has. What then is missing is the residual.

Energies are those of an observer who drifts with the ice, to whom the structure moves and does the work.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from lattice.engine import GAMMA, Engine, State, Step, point_displacement
from lattice.grid import Array, IntArray
from lattice.springs import spring_energy


@njit(cache=True)
def weighted_square(weight, x, present):
    """Sum of weight x^2 over the nodes that are present; ``weight`` (n k,), ``x`` (n, k)."""
    total, k = 0.0, x.shape[1]
    for n in range(x.shape[0]):
        if present[n]:
            for i in range(k):
                total += weight[n * k + i] * x[n, i] ** 2
    return total


@dataclass
class EnergyBooks:
    """Running sums since the start of a run [J]."""

    engine: Engine
    contact: float = 0.0  #: work of the structure on the sheet
    rubble: float = 0.0  #: work of other external forces
    damping: float = 0.0  #: hydrodynamic and material damping
    scheme: float = 0.0  #: taken by the time integration from motions shorter than its step
    fracture: float = 0.0  #: elastic energy of cells when they failed
    handed_over: float = 0.0  #: energy of pieces that left
    stored: float = 0.0  #: elastic + foundation + kinetic of the sheet now
    kinetic: float = 0.0
    elastic: float = 0.0
    foundation: float = 0.0

    @property
    def residual(self) -> float:
        """Energy that no term explains [J]."""
        spent = self.damping + self.scheme + self.fracture + self.handed_over
        return self.contact + self.rubble - spent - self.stored

    def springs(self, u: Array, q: Array, live: np.ndarray) -> float:
        """Elastic energy of live cells [J]."""
        e = self.engine
        return float(spring_energy(e.dof_u, *e.sparse_u, live, u.ravel())
                     + spring_energy(e.dof_q, *e.sparse_q, live, q.ravel()))

    def begin(self, s: State, live: np.ndarray, present: np.ndarray) -> None:
        """Starts from a deflected state: the work that brought the sheet there counts as the rubble's."""
        self.measure(s, live, present)
        self.rubble = self.stored

    def measure(self, s: State, live: np.ndarray, present: np.ndarray) -> None:
        """Takes stock of a state."""
        self.elastic = self.springs(s.u, s.q, live)
        self.kinetic, self.foundation = self._kinetic(s, present), self._foundation(s.q, present)
        self.stored = self.elastic + self.kinetic + self.foundation

    def _kinetic(self, s: State, present: np.ndarray) -> float:
        e = self.engine
        return 0.5 * float(weighted_square(e.M_u, s.u_dot, present) + weighted_square(e.M_q, s.q_dot, present))

    def _foundation(self, q: Array, present: np.ndarray) -> float:
        return 0.5 * float(weighted_square(self.engine.k_f, q, present))

    def book_step(self, step: Step, force_u: Array, force_q: Array, nodes: IntArray, live: np.ndarray,
                  present: np.ndarray) -> None:
        """Books one accepted step; ``nodes`` are those of the contact."""
        e, dt = self.engine, step.dt
        norms = []
        for b, stage in zip((1.0 - GAMMA, GAMMA), step.stages, strict=True):
            s = stage.state
            v = point_displacement(s.u_dot, s.q_dot, nodes, step.height)
            self.contact += dt * b * float((stage.contact * v).sum())
            self.rubble += dt * b * float(np.vdot(force_u, s.u_dot) + np.vdot(force_q, s.q_dot))
            rate = self.springs(s.u_dot, s.q_dot, live)
            water = float(weighted_square(e.C_q, s.q_dot, present))
            self.damping += dt * b * (water + 2.0 * e.alpha * rate)
            acceleration = State(s.u, s.q, stage.u_acc, stage.q_acc)
            norms.append(2.0 * (rate + self._foundation(s.q_dot, present) + self._kinetic(acceleration, present)))
        self.scheme += 0.5 * (GAMMA * dt) ** 2 * (norms[1] - norms[0])
        self.measure(step.state, live, present)

    def book_served(self, work: float, damping: float, s: State, live: np.ndarray, present: np.ndarray) -> None:
        """Books the part of a step that was used before the rest was given up; s is the state at its end."""
        self.contact += work
        self.damping += damping
        self.measure(s, live, present)

    def loss_rate(self, s: State, live: np.ndarray, present: np.ndarray) -> float:
        """Power taken by damping in a state [W]."""
        water = float(weighted_square(self.engine.C_q, s.q_dot, present))
        alpha = self.engine.alpha
        return water + 2.0 * alpha * self.springs(s.u_dot, s.q_dot, live) if alpha else water

    def book_failure(self, cell: int, s: State) -> None:
        """Books the elastic energy of a cell that fails in state s."""
        live = np.zeros(self.engine.grid.cells, bool)
        live[cell] = True
        self.fracture += self.springs(s.u, s.q, live)

    def book_departure(self, nodes: IntArray, cells: np.ndarray, s: State) -> None:
        """Books a piece that leaves with all its energy; ``cells`` is the mask of its live cells."""
        mask = np.zeros(self.engine.grid.nodes, bool)
        mask[nodes] = True
        self.handed_over += self.springs(s.u, s.q, cells) + self._kinetic(s, mask) + self._foundation(s.q, mask)
