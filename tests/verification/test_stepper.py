"""The explicit stepper: its critical step is the true one, and it is of second order."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from lattice.assembly import out_of_plane_mass
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.statics import out_of_plane_stiffness
from lattice.stepper import Stepper, critical_step
from lattice.stiffness import hrennikoff

ICE = Ice(E=3e9, nu=1.0 / 3.0, h=1.5, rho_i=900.0, rho_w=1025.0)
GRID = Grid(6, 5, 2.0)
K = out_of_plane_stiffness(GRID, ICE, hrennikoff(ICE)).tocsr()
M = out_of_plane_mass(GRID, ICE)


def growth(C: sp.csr_matrix, dt: float) -> float:
    """Size after 2000 steps over the size at the start, past the stepper's own guard."""
    stepper = Stepper(K, C, M, 0.5 * critical_step(K, C, M))
    stepper.dt = dt
    stepper.q = np.random.default_rng(2).standard_normal(len(M))
    before = np.abs(stepper.q).max()
    stepper.run(2000, lambda t: np.zeros(len(M)))
    return float(np.abs(stepper.q).max() / before)


@pytest.mark.parametrize("alpha", [0.0, 1e-4, 1e-3])
def test_the_critical_step_separates_bounded_from_growing(alpha: float) -> None:
    C = (alpha * K).tocsr()
    limit = critical_step(K, C, M)
    assert growth(C, 0.999 * limit) < 100.0
    assert not growth(C, 1.01 * limit) < 1e6


def test_damping_shortens_the_step_as_for_a_single_mode() -> None:
    omega = 2.0 / critical_step(K, 0.0 * K, M)
    for alpha in (1e-4, 1e-3):
        xi = 0.5 * alpha * omega
        single = 2.0 * (np.sqrt(1.0 + xi**2) - xi) / omega
        assert critical_step(K, alpha * K, M) == pytest.approx(single, rel=1e-6)


def test_an_unstable_step_is_refused_in_one_line() -> None:
    with pytest.raises(ValueError, match="is not stable: use at most") as error:
        Stepper(K, (0.0 * K).tocsr(), M, 1.01 * critical_step(K, 0.0 * K, M))
    assert "\n" not in str(error.value)


def modal(damping: float, force: np.ndarray, T: float) -> np.ndarray:
    """Exact displacement at T under the load t * force from rest, with C = damping M, mode by mode."""
    omega2, modes = np.linalg.eigh(K.toarray() / np.sqrt(np.outer(M, M)))
    a, b = modes.T @ (force / np.sqrt(M)), 0.5 * damping
    damped = np.sqrt(omega2 - b * b)
    x0, v0 = damping * a / omega2**2, -a / omega2  # minus the particular solution a t / omega^2 - damping a / omega^4
    free = np.exp(-b * T) * (x0 * np.cos(damped * T) + (v0 + b * x0) / damped * np.sin(damped * T))
    return np.asarray(modes @ (a * T / omega2 - damping * a / omega2**2 + free)) / np.sqrt(M)


@pytest.mark.parametrize(("damping", "order"), [(0.0, 2.0), (0.8, 1.0)])
def test_order_of_the_stepper(damping: float, order: float) -> None:
    """Second order; the damping force, taken half a step late, adds an error of first order in dt x damping."""
    C, none = sp.diags(damping * M).tocsr(), np.zeros(len(M))
    force = np.zeros(len(M))
    force[::3] = np.exp(-((GRID.xy[:, 0] - 4.0) ** 2) / 20.0)
    T = 400.0 * critical_step(K, C, M)
    exact, errors = modal(damping, force, T), []
    for steps in (1600, 3200):
        stepper = Stepper(K, C, M, T / steps)
        stepper.start(none, none, none)
        stepper.run(steps, lambda t: t * force)
        errors.append(np.abs(stepper.q - exact).max() / np.abs(exact).max())
    assert errors[1] < 1e-3
    assert order - 0.3 < np.log2(errors[0] / errors[1]) < order + 0.3
