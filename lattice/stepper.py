"""Explicit time integration: M q'' + C q' + K q = F(t) by leapfrog (velocity Verlet with half-step velocities).

    v(n+1/2) = v(n-1/2) + dt / M (F - K q(n) - C v(n-1/2)),   q(n+1) = q(n) + dt v(n+1/2)

The damping force takes the velocity of half a step before, which shortens the stable step: it must stay below the dt
at which dt^2 A + 2 dt B reaches 4, A = M^-1/2 K M^-1/2 and B the same of C. For one mode that is the familiar
2 (sqrt(1 + xi^2) - xi) / omega. Stiffness-proportional damping is therefore dear: 1e-3 s makes the step of the beam
of Table 4-4 twenty times shorter. The late force also leaves an error of first order in dt C / M; without damping the
order is 2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import eigsh

from lattice.compiled import compiled
from lattice.grid import Array


class Pattern(NamedTuple):
    """Stiffness and damping on one sparsity pattern, row after row."""

    begin: NDArray[np.int32]  #: (n + 1,) where each row begins
    column: NDArray[np.int32]  #: (entries,)
    K: Array  #: (entries,) [N/m]
    C: Array  #: (entries,) [N s/m]


@compiled()
def advance(on: Pattern, m: Array, q: Array, v: Array, F: Array, dF: Array, dt: float, steps: int) -> None:
    """``steps`` leapfrog steps of q, v (n,) in place; the load F (n,) grows by dF (n,) per second."""
    force = np.empty_like(q)
    for step in range(steps):
        t = step * dt
        for i in range(q.size):
            total = F[i] + t * dF[i]
            for k in range(on.begin[i], on.begin[i + 1]):
                total -= on.K[k] * q[on.column[k]] + on.C[k] * v[on.column[k]]
            force[i] = total
        for i in range(q.size):
            v[i] += dt * force[i] / m[i]
            q[i] += dt * v[i]


def critical_step(K: sp.spmatrix, C: sp.spmatrix, m: Array) -> float:
    """Largest stable step, from the true largest eigenvalue of dt^2 A + 2 dt B [s]."""
    scale = sp.diags(1.0 / np.sqrt(m))
    A, B = (scale @ K @ scale).tocsr(), (scale @ C @ scale).tocsr()
    x = np.random.default_rng(1).standard_normal(len(m))
    dt = np.inf
    for _ in range(20):
        x = _largest_vector(A, B, dt, x)
        a, b = float(x @ (A @ x)), float(x @ (B @ x))
        last, dt = dt, 4.0 / (b + np.sqrt(b * b + 4.0 * a))  # a dt^2 + 2 b dt = 4; approaches from above
        if last - dt < 1e-9 * dt:
            break
    return float(dt)


def _largest_vector(A: sp.csr_matrix, B: sp.csr_matrix, dt: float, start: Array) -> Array:
    """Unit vector of the largest eigenvalue of dt A + 2 B (of A alone for an infinite dt)."""
    H = A if np.isinf(dt) else (dt * A + 2.0 * B).tocsr()
    return np.asarray(eigsh(H, k=1, which="LA", v0=start, tol=1e-9)[1][:, 0])


@dataclass
class Stepper:
    """A lattice in motion; only free degrees of freedom. Refuses a step that is not stable."""

    K: sp.csr_matrix  #: (n, n) stiffness
    C: sp.csr_matrix  #: (n, n) damping
    m: Array  #: (n,) mass
    dt: float  #: step [s]
    q: Array = field(init=False)  #: (n,) displacement at the time t
    v: Array = field(init=False)  #: (n,) velocity half a step before t
    t: float = field(init=False, default=0.0)  #: [s]

    def __post_init__(self) -> None:
        self.q, self.v = np.zeros(len(self.m)), np.zeros(len(self.m))
        self.exchange(self.K, self.C)

    def exchange(self, K: sp.spmatrix, C: sp.spmatrix) -> None:
        """New matrices, for example after a cell broke; q and v go on as they are."""
        limit = critical_step(K, C, self.m)
        if not 0.0 < self.dt <= limit:
            raise ValueError(
                f"time step {self.dt:.3g} s is not stable: use at most {limit:.3g} s "
                "(largest frequency of the lattice, damping included)"
            )
        self.K, self.C = K.tocsr(), C.tocsr()
        self._merge(self.K, self.C)

    def _merge(self, K: sp.csr_matrix, C: sp.csr_matrix) -> None:
        """K and C on one sparsity pattern for the kernel."""
        n = K.shape[0]
        both = (_ones(K) + _ones(C)).tocsr()
        both.sort_indices()
        rows = np.repeat(np.arange(n), np.diff(both.indptr))
        values = (np.asarray(A[rows, both.indices]).ravel() for A in (K, C))
        self._pattern = Pattern(both.indptr, both.indices, *values)

    def start(self, q: Array, velocity: Array, F: Array) -> None:
        """Displacement and velocity at the same instant t; v goes back by half a step."""
        self.q = q.copy()
        self.v = velocity - 0.5 * self.dt * (F - self.K @ q - self.C @ velocity) / self.m

    def run(self, steps: int, load: Callable[[float], Array], block: int | None = None) -> None:
        """March ``steps`` steps; the load is taken as linear over ``block`` steps (all of them)."""
        done = 0
        while done < steps:
            n = min(block or steps, steps - done)
            F = load(self.t)
            dF = (load(self.t + n * self.dt) - F) / (n * self.dt)
            advance(self._pattern, self.m, self.q, self.v, F, dF, self.dt, n)
            self.t += n * self.dt
            done += n

    def velocity(self, F: Array) -> Array:
        """Velocity at the time t, from half a step before [m/s]."""
        return np.asarray(self.v + 0.5 * self.dt * (F - self.K @ self.q - self.C @ self.v) / self.m)

    def energy(self, F: Array) -> float:
        """Kinetic plus elastic energy (springs and buoyancy) at the time t [J]."""
        v = self.velocity(F)
        return float(0.5 * v @ (self.m * v) + 0.5 * self.q @ (self.K @ self.q))


def _ones(A: sp.csr_matrix) -> sp.csr_matrix:
    return sp.csr_matrix((np.ones(A.nnz), A.indices, A.indptr), shape=A.shape)
