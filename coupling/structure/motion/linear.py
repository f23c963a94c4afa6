"""A structure of masses, dampers and springs: M q'' + C q' + K q = B^T F, displacement B q.

Exact for a load that is constant over a window T. With z = (q, q', F) the motion is z' = A z, and

    z(T) = exp(A T) z(0),    int_0^T q' . C q' dt = z(0) . Q z(0),    Q = int_0^T exp(A s)^T W exp(A s) ds,

for a step h that is short against all periods from one exponential of twice the size (C. F. Van Loan, Computing
integrals involving the matrix exponential, IEEE Trans. Automatic Control 23, 1978, eq. 1.2), and for T = 2^k h by
doubling, Q(2 h) = Q(h) + Phi(h)^T Q(h) Phi(h), Phi(2 h) = Phi(h)^2: so no growing exponential is formed, however stiff
or damped the structure is. What the load puts in, F . B (q(T) - q(0)), is then what is stored and what the dampers
take, to rounding. Against a load that varies in the window the mean is second order in T.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np
from scipy.linalg import expm

from coupling.interface.exchange import Restore
from coupling.interface.units import Array

SHORT = 0.25  #: norm of A h of the step that is doubled
KEPT = 8  #: window lengths whose matrices are kept


class LinearMotion:
    """Generalised coordinates q (n,); see above."""

    def __init__(self, mass: Array, damping: Array, stiffness: Array, shape: Array) -> None:
        """``mass``, ``damping``, ``stiffness`` (n, n), ``shape`` B (6, n), all SI. ValueError if they fit no structure.

        ``mass`` is symmetric and positive definite, the others symmetric and none of them negative.
        """
        self._M, self._C, self._K = (np.array(m, np.float64) for m in (mass, damping, stiffness))
        self._B = np.array(shape, np.float64)
        n = len(self._M)
        for name, matrix in (("mass", self._M), ("damping", self._C), ("stiffness", self._K)):
            _is_of_a_structure(name, matrix, n)
        if self._B.shape != (6, n):
            raise ValueError(f"shapes of {n} degrees of freedom need {n} columns of 6; they have {self._B.shape}")
        self._inverse = np.linalg.inv(self._M)
        self._q, self._v = np.zeros(n), np.zeros(n)
        self._lost = 0.0  #: to the dampers so far [J]
        self._steps: dict[float, tuple[Array, Array]] = {}

    @property
    def displacement(self) -> Array:
        """As `Motion.displacement`."""
        return np.asarray(self._B @ self._q)

    @property
    def velocity(self) -> Array:
        """As `Motion.velocity`."""
        return np.asarray(self._B @ self._v)

    @property
    def coordinates(self) -> Array:
        """Generalised coordinates (n,): amplitudes of the modes, or the degrees of freedom themselves."""
        return self._q.copy()

    @property
    def energy(self) -> dict[str, float]:
        """As `Motion.energy`."""
        return {
            "structure_kinetic": 0.5 * float(self._v @ self._M @ self._v),
            "structure_elastic": 0.5 * float(self._q @ self._K @ self._q),
            "structure_damping_loss": self._lost,
        }

    def after(self, t: float, window: float, load: Array) -> Array:  # noqa: ARG002 - it knows no time
        """As `Motion.after`."""
        n = len(self._q)
        return np.asarray(self._B @ (self._step(window)[0] @ self._state(load))[:n])

    def advance(self, t: float, window: float, load: Array) -> None:  # noqa: ARG002 - it knows no time
        """As `Motion.advance`."""
        n, z = len(self._q), self._state(load)
        forward, lost = self._step(window)
        self._lost += float(z @ lost @ z)
        z = forward @ z
        self._q, self._v = z[:n], z[n : 2 * n]

    def save(self) -> Restore:
        """As `Motion.save`."""
        return partial(self._restore, self._q, self._v, self._lost)

    def _restore(self, q: Array, v: Array, lost: float) -> None:
        self._q, self._v, self._lost = q, v, lost

    def _state(self, load: Array) -> Array:
        return np.concatenate((self._q, self._v, self._B.T @ load))

    def _step(self, window: float) -> tuple[Array, Array]:
        """Phi and Q of a window."""
        if window not in self._steps:
            if len(self._steps) >= KEPT:
                self._steps.clear()
            self._steps[window] = self._over(window)
        return self._steps[window]

    def _over(self, window: float) -> tuple[Array, Array]:
        n = len(self._q)
        none, one = np.zeros((n, n)), np.eye(n)
        scale = self._scale(window)  #: of velocities and forces, so that the exponential sees entries alike
        rate = np.block(
            [
                [none, one * scale[1], none],
                [-self._inverse @ self._K / scale[1], -self._inverse @ self._C, self._inverse * scale[2] / scale[1]],
                [none, none, none],
            ]
        )
        weight = np.zeros((3 * n, 3 * n))
        weight[n : 2 * n, n : 2 * n] = self._C * scale[1] ** 2
        doublings = max(0, math.ceil(math.log2(max(float(np.linalg.norm(rate, 1)) * window / SHORT, 1.0))))
        step = window / 2**doublings
        both = expm(np.block([[-rate.T, weight], [np.zeros_like(rate), rate]]) * step)
        forward = both[3 * n :, 3 * n :]
        lost = forward.T @ both[: 3 * n, 3 * n :]
        for _ in range(doublings):
            lost, forward = lost + forward.T @ lost @ forward, forward @ forward
        units = np.repeat(scale, n)
        return forward * units[:, None] / units, 0.5 * (lost + lost.T) / np.outer(units, units)

    def _scale(self, window: float) -> Array:
        """Units of q, q' and F in which A is balanced."""
        stiff = math.sqrt(float(np.linalg.norm(self._inverse @ self._K, 2)))
        speed = max(stiff, 1.0 / window)
        return np.array([1.0, speed, speed**2 / float(np.linalg.norm(self._inverse, 2))])


def spring(freedoms: Sequence[int], mass: Array, damping: Array, stiffness: Array) -> LinearMotion:
    """Some of the six degrees of freedom (n,), by their numbers, on springs; the others are held."""
    shape = np.zeros((6, len(freedoms)))
    shape[list(freedoms), np.arange(len(freedoms))] = 1.0
    return LinearMotion(mass, damping, stiffness, shape)


def modal(frequency: Array, ratio: Array, mass: Array, shape: Array) -> LinearMotion:
    """Modes of these frequencies (n,) [Hz], damping ratios (n,), generalised masses (n,), and shapes (n, 6).

    m q'' + 2 zeta omega m q' + omega^2 m q = phi . F, the shape phi being the displacement of the waterline point for
    q = 1 (A. K. Chopra, Dynamics of Structures, 12.3; masses belong to these shapes).
    """
    omega = 2.0 * math.pi * np.asarray(frequency, np.float64)
    m = np.asarray(mass, np.float64)
    return LinearMotion(
        np.diag(m), np.diag(2.0 * np.asarray(ratio) * omega * m), np.diag(omega**2 * m), np.asarray(shape).T
    )


def _is_of_a_structure(name: str, matrix: Array, n: int) -> None:
    """ValueError if a matrix is none of n masses, dampers or springs."""
    if n == 0 or matrix.shape != (n, n) or not np.isfinite(matrix).all():
        raise ValueError(f"{name} is {matrix.tolist()}; give {n} x {n} finite numbers, one row per degree of freedom")
    largest = float(np.abs(matrix).max())
    if np.abs(matrix - matrix.T).max() > 1e-9 * largest:
        raise ValueError(f"{name} is not symmetric: {matrix.tolist()}; a structure's matrices are")
    values = np.linalg.eigvalsh(0.5 * (matrix + matrix.T))
    if name == "mass" and values[0] <= 0.0:
        raise ValueError(f"mass is not positive: {matrix.tolist()}; every degree of freedom needs a mass > 0")
    if values[0] < -1e-9 * largest:
        raise ValueError(f"{name} is negative in some direction: {matrix.tolist()}; it must not be")
