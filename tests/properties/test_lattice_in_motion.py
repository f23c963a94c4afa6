"""A lattice in motion keeps its momentum and its energy: every stiffness set, support and criterion.

Each property has a wrong twin that the same check must reject.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from lattice.assembly import assemble, in_plane_mass, in_plane_springs, out_of_plane_mass, out_of_plane_springs
from lattice.criteria.table import CRITERIA
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.statics import SUPPORTS, all_around, held_in_plane, held_out_of_plane, out_of_plane_stiffness
from lattice.stepper import Stepper, critical_step
from lattice.stiffness import STIFFNESS_SETS
from lattice.strain import CellState

GRID = Grid(6, 7, 2.0)
SETS = sorted(STIFFNESS_SETS)
STEPS = 400


def ice(nu: float = 1.0 / 3.0) -> Ice:
    return Ice(
        E=3e9,
        nu=nu,
        h=1.5,
        rho_i=900.0,
        rho_w=1025.0,
        sigma_t=0.5e6,
        sigma_f=0.7e6,
        sigma_c=3e6,
        beam_test=BeamTest(length=9.0, width=3.0, failure_load=0.2e6, factor=0.8),
        sigma_spall=-20e6,
        sigma_f_upward=0.6e6,
        sigma_f_downward=0.8e6,
        sigma_shear=0.7e6,
        K_IC=2e5,
    )


def rough(n: int) -> np.ndarray:
    return 1e-3 * np.random.default_rng(7).standard_normal(n)


def momenta(mass: np.ndarray, velocity: np.ndarray, in_plane: bool) -> np.ndarray:
    """Two linear momenta and the angular one about the vertical; out of plane one linear, two about horizontal axes.

    The momentum belonging to a rigid motion is the sum of mass x velocity x that motion.
    """
    x, y = GRID.xy.T
    one, zero = np.ones(GRID.nodes), np.zeros(GRID.nodes)
    motions = [(one, zero), (zero, one), (-y, x)] if in_plane else [(one, zero, zero), (x, -one, zero), (y, zero, -one)]
    fields = [np.column_stack(m).ravel() for m in motions]
    return np.array([f @ (mass * velocity) for f in fields])


def largest_momenta(mass: np.ndarray, velocity: np.ndarray, in_plane: bool) -> np.ndarray:
    """What the momenta would be if no parts cancelled: their scale."""
    x, y = np.abs(GRID.xy.T) + 1.0
    per_node = np.abs(mass * velocity).reshape(GRID.nodes, -1).sum(axis=1)
    return np.array([per_node.sum(), per_node.sum() if in_plane else x @ per_node, y @ per_node])


def change_of_momenta(K: sp.spmatrix, mass: np.ndarray, in_plane: bool, alpha: float = 0.0) -> np.ndarray:
    C = alpha * K
    stepper = Stepper(K.tocsr(), C.tocsr(), mass, 0.9 * critical_step(K, C, mass))
    stepper.start(rough(len(mass)), 10.0 * rough(len(mass)), np.zeros(len(mass)))
    before, scale = momenta(mass, stepper.v, in_plane), largest_momenta(mass, stepper.v, in_plane)
    stepper.run(STEPS, lambda t: np.zeros(len(mass)))
    return np.abs(momenta(mass, stepper.v, in_plane) - before) / scale


@pytest.mark.parametrize("alpha", [0.0, 1e-4])
@pytest.mark.parametrize("name", SETS)
def test_a_free_plate_keeps_its_momentum_out_of_plane(name: str, alpha: float) -> None:
    """Without water; material damping acts between nodes and takes no momentum."""
    K = assemble(GRID, out_of_plane_springs(STIFFNESS_SETS[name](ice(0.25)), GRID.d))
    assert change_of_momenta(K, out_of_plane_mass(GRID, ice()), False, alpha).max() < 1e-9


@pytest.mark.parametrize("nu", [1.0 / 3.0, 0.25])
@pytest.mark.parametrize("name", SETS)
def test_a_free_plate_keeps_its_momentum_in_plane(name: str, nu: float) -> None:
    """Below nu = 1/3 the shear springs resist a turn, and the angular momentum is not conserved: stated."""
    K = assemble(GRID, in_plane_springs(STIFFNESS_SETS[name](ice(nu))))
    change = change_of_momenta(K, in_plane_mass(GRID, ice()), True)
    assert change[:2].max() < 1e-9
    assert change[2] < 1e-9 if nu == 1.0 / 3.0 else change[2] > 1e-6


@pytest.mark.parametrize("support", sorted(SUPPORTS))
def test_a_supported_plate_gives_its_momentum_to_the_support(support: str) -> None:
    """Momentum of the plate plus impulse of the reactions (force and moment of each held node) stays what it was."""
    K = assemble(GRID, out_of_plane_springs(STIFFNESS_SETS["hrennikoff"](ice()), GRID.d)).tocsr()
    mass, held = out_of_plane_mass(GRID, ice()), held_out_of_plane(GRID, {"x-": support})
    free = np.setdiff1d(np.arange(len(mass)), held)
    stepper = Stepper(K[free][:, free], 0.0 * K[free][:, free], mass[free], 1e-5)
    stepper.start(rough(len(free)), 10.0 * rough(len(free)), np.zeros(len(free)))
    velocity, impulse, q = np.zeros(len(mass)), np.zeros(len(mass)), np.zeros(len(mass))
    velocity[free] = stepper.v
    before, scale = momenta(mass, velocity, False), largest_momenta(mass, velocity, False)
    for _ in range(100):
        q[free] = stepper.q
        impulse[held] += stepper.dt * (K @ q)[held]
        stepper.run(1, lambda t: np.zeros(len(free)))
    velocity[free] = stepper.v
    after = momenta(mass, velocity, False)
    given = momenta(np.ones(len(mass)), impulse, False)
    assert (np.abs(after - given - before) / scale).max() < 1e-9
    if len(held):
        assert (np.abs(after - before) / scale).max() > 1e-6  # the wrong twin: without the reactions


def test_a_spring_that_pulls_one_end_only_is_rejected() -> None:
    K = assemble(GRID, in_plane_springs(STIFFNESS_SETS["hrennikoff"](ice()))).tolil()
    K[2 * GRID.node(2, 2), 2 * GRID.node(3, 2)] *= 0.9  # action without reaction
    assert change_of_momenta(K.tocsc(), in_plane_mass(GRID, ice()), True).max() > 1e-6


@pytest.mark.parametrize("criterion", sorted(CRITERIA))
def test_failure_keeps_momentum_and_adds_no_energy(criterion: str) -> None:
    """The cell that this criterion loads most is taken out of a flying plate, which goes on from where it is."""
    rows, mass = out_of_plane_springs(STIFFNESS_SETS["hrennikoff"](ice()), GRID.d), out_of_plane_mass(GRID, ice())
    K, none = assemble(GRID, rows).tocsr(), np.zeros(len(mass))
    stepper = Stepper(K, 0.0 * K, mass, 0.5 * critical_step(K, 0.0 * K, mass))
    stepper.start(rough(len(mass)), 10.0 * rough(len(mass)), none)
    stepper.run(50, lambda t: none)
    u = 1e-4 * np.random.default_rng(9).standard_normal((GRID.nodes, 2))
    load = CRITERIA[criterion].judge(CellState.of(GRID, u, stepper.q.reshape(-1, 3)), ice())
    momentum, velocity, energy = momenta(mass, stepper.v, False), stepper.velocity(none), stepper.energy(none)
    intact = np.arange(GRID.cells) != np.argmax(load)
    stepper.exchange(assemble(GRID, rows, intact), 0.0 * K)
    left = 0.5 * velocity @ (mass * velocity) + 0.5 * stepper.q @ (stepper.K @ stepper.q)
    assert left <= energy * (1.0 + 1e-12)
    stepper.run(50, lambda t: none)
    change = np.abs(momenta(mass, stepper.v, False) - momentum) / largest_momenta(mass, stepper.v, False)
    assert change.max() < 1e-9


def supported(name: str, support: str) -> tuple[sp.csr_matrix, np.ndarray, np.ndarray]:
    """K, mass and start of a floating plate with one support all around, free degrees of freedom only."""
    K = out_of_plane_stiffness(GRID, ice(0.25), STIFFNESS_SETS[name](ice(0.25)))
    free = np.setdiff1d(np.arange(3 * GRID.nodes), held_out_of_plane(GRID, all_around(support)))
    smooth = np.zeros((GRID.nodes, 3))
    smooth[:, 0] = 1e-2 * np.sin(GRID.xy[:, 0]) * np.cos(0.7 * GRID.xy[:, 1])
    return K[free][:, free].tocsr(), out_of_plane_mass(GRID, ice())[free], smooth.ravel()[free]


def energy_error(K: sp.csr_matrix, mass: np.ndarray, start: np.ndarray, part: float) -> float:
    """Largest relative departure of the energy over a fixed time with ``part`` of the critical step."""
    limit, none = critical_step(K, 0.0 * K, mass), np.zeros(len(mass))
    stepper = Stepper(K, 0.0 * K, mass, part * limit)
    stepper.start(start, none, none)
    first, worst = stepper.energy(none), 0.0
    for _ in range(40):
        stepper.run(round(1.0 / part), lambda t: none)
        worst = max(worst, abs(stepper.energy(none) / first - 1.0))
    return worst


@pytest.mark.parametrize("support", sorted(SUPPORTS))
@pytest.mark.parametrize("name", SETS)
def test_energy_is_kept_to_second_order_in_the_step(name: str, support: str) -> None:
    K, mass, start = supported(name, support)
    errors = [energy_error(K, mass, start, part) for part in (0.1, 0.05)]
    assert errors[0] < 0.01
    assert 1.7 < np.log2(errors[0] / errors[1]) < 2.3


def test_a_step_that_forgets_the_half_is_rejected() -> None:
    """Forward Euler, the same kick with the old velocity in the drift, gains energy."""
    K, mass, q = supported("hrennikoff", "simple")
    dt, v = 0.1 * critical_step(K, 0.0 * K, mass), np.zeros(len(mass))
    first = 0.5 * q @ (K @ q)
    for _ in range(400):
        q, v = q + dt * v, v - dt * (K @ q) / mass
    assert 0.5 * q @ (K @ q) + 0.5 * v @ (mass * v) > 1.05 * first


@pytest.mark.parametrize("support", sorted(SUPPORTS))
def test_in_plane_supports_hold_what_they_say(support: str) -> None:
    held = held_in_plane(GRID, {"y+": support})
    assert len(held) == (2 * GRID.nx if support in ("clamped", "held") else 0)
