"""Rigid motion costs nothing, and a mirrored load gives a mirrored answer: every set, support and criterion.

Each property has a wrong twin that the same check must reject.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp

from lattice.assembly import assemble, in_plane_springs, out_of_plane_springs
from lattice.criteria.laws import tension
from lattice.criteria.table import CRITERIA
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.statics import (
    SUPPORTS,
    held_in_plane,
    held_out_of_plane,
    in_plane_stiffness,
    out_of_plane_stiffness,
    solve,
)
from lattice.stiffness import STIFFNESS_SETS
from lattice.strain import CellState, Connections

GRID = Grid(6, 7, 2.0)
SETS = sorted(STIFFNESS_SETS)
RATIOS = (1.0 / 3.0, 0.3, 0.2)


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


def rigid_in_plane() -> dict[str, np.ndarray]:
    x, y = GRID.xy.T
    one, zero = np.ones(GRID.nodes), np.zeros(GRID.nodes)
    return {
        "along x": np.column_stack((one, zero)),
        "along y": np.column_stack((zero, one)),
        "turn": np.column_stack((-y, x)),
    }


def rigid_out_of_plane() -> dict[str, np.ndarray]:
    """Heave and two tilts; a tilt w = x turns phi_x = -1, because the shear (2.3) is dw/dx + phi_x."""
    x, y = GRID.xy.T
    one, zero = np.ones(GRID.nodes), np.zeros(GRID.nodes)
    return {
        "heave": np.column_stack((one, zero, zero)),
        "tilt along x": np.column_stack((x, -one, zero)),
        "tilt along y": np.column_stack((y, zero, -one)),
    }


def energy(rows: np.ndarray, motion: np.ndarray) -> float:
    """Spring energy of a motion over that of random motion of the same size [-]."""
    K = assemble(GRID, rows)
    rough = np.random.default_rng(3).standard_normal(motion.size) * np.abs(motion).max()
    return float(motion.ravel() @ (K @ motion.ravel()) / (rough @ (K @ rough)))


@pytest.mark.parametrize("nu", RATIOS)
@pytest.mark.parametrize("name", SETS)
def test_rigid_motion_out_of_plane_costs_no_energy(name: str, nu: float) -> None:
    rows = out_of_plane_springs(STIFFNESS_SETS[name](ice(nu)), GRID.d)
    for motion in rigid_out_of_plane().values():
        assert abs(energy(rows, motion)) < 1e-12


@pytest.mark.parametrize("name", SETS)
def test_springs_that_shear_the_wrong_way_are_rejected(name: str) -> None:
    wrong = out_of_plane_springs(STIFFNESS_SETS[name](ice()), GRID.d)
    wrong[:, [1, 2, 4, 5, 7, 8, 10, 11]] *= -1.0  # dw/dx - phi_x
    assert energy(wrong, rigid_out_of_plane()["tilt along x"]) > 1e-3


@pytest.mark.parametrize("nu", RATIOS)
@pytest.mark.parametrize("name", SETS)
def test_rigid_motion_in_plane_costs_no_energy_except_a_turn_below_one_third(name: str, nu: float) -> None:
    """For nu < 1/3 the in-plane shear springs (3.10), (3.21) resist a rigid turn of the sheet: stated, not hidden."""
    springs = STIFFNESS_SETS[name](ice(nu))
    cost = {motion: energy(in_plane_springs(springs), u) for motion, u in rigid_in_plane().items()}
    assert abs(cost["along x"]) < 1e-12
    assert abs(cost["along y"]) < 1e-12
    if nu == 1.0 / 3.0:
        assert abs(cost["turn"]) < 1e-12
    else:
        assert cost["turn"] > 1e-6


@pytest.mark.parametrize("support", sorted(SUPPORTS))
def test_supports_leave_exactly_the_rigid_motions_they_should(support: str) -> None:
    K = assemble(GRID, out_of_plane_springs(STIFFNESS_SETS["hrennikoff"](ice()), GRID.d)).toarray()
    free = np.setdiff1d(np.arange(len(K)), held_out_of_plane(GRID, {"x-": support}))
    values = np.linalg.eigvalsh(K[np.ix_(free, free)])
    assert np.sum(values < 1e-9 * values[-1]) == {"free": 3, "held": 3, "simple": 1, "clamped": 0}[support]


@pytest.mark.parametrize("criterion", sorted(CRITERIA))
def test_no_cell_fails_by_moving_rigidly(criterion: str) -> None:
    for u in rigid_in_plane().values():
        for q in rigid_out_of_plane().values():
            state = CellState.of(GRID, 1e-2 * u, 1e-2 * q)
            assert np.abs(CRITERIA[criterion].judge(state, ice())).max() < 1e-9


def test_strain_that_keeps_the_rotation_is_rejected() -> None:
    turn = 1e-2 * rigid_in_plane()["turn"][GRID.cell_nodes]
    wrong = Connections.of(turn, GRID.d)
    assert np.hypot(wrong.s12.mean(axis=1), wrong.s21.mean(axis=1)).min() > 1e-3
    objective = CellState.of(GRID, 1e-2 * rigid_in_plane()["turn"], np.zeros((GRID.nodes, 3)))
    assert np.abs(tension(objective, ice())).max() < 1e-9


def mirror(grid: Grid, field: np.ndarray) -> np.ndarray:
    """Field (nodes, 2 or 3) of the sheet seen in a mirror along y: y components change sign."""
    out = field.reshape(grid.nx, grid.ny, -1)[:, ::-1].copy()
    out[..., -1] *= -1.0
    return out.reshape(grid.nodes, -1)


def answer(K, held: np.ndarray) -> tuple[np.ndarray, np.ndarray]:  # type: ignore[no-untyped-def]
    """Displacement under a load off the axis, and that under the mirrored load."""
    load = np.zeros((GRID.nodes, 3))
    load[GRID.node(3, 1)] = -1e6, 2e5, 3e5
    one = solve(K, load.ravel(), held).reshape(-1, 3)
    other = solve(K, mirror(GRID, load).ravel(), held).reshape(-1, 3)
    return one, other


@pytest.mark.parametrize("support", sorted(SUPPORTS))
@pytest.mark.parametrize("name", SETS)
def test_a_mirrored_load_gives_a_mirrored_deflection(name: str, support: str) -> None:
    K = out_of_plane_stiffness(GRID, ice(0.25), STIFFNESS_SETS[name](ice(0.25)))
    one, other = answer(K, held_out_of_plane(GRID, {"x-": support}))
    assert np.abs(mirror(GRID, one) - other).max() < 1e-10 * np.abs(one).max()


@pytest.mark.parametrize("support", ["clamped", "held"])
@pytest.mark.parametrize("name", SETS)
def test_a_mirrored_load_gives_a_mirrored_displacement_in_plane(name: str, support: str) -> None:
    K = in_plane_stiffness(GRID, STIFFNESS_SETS[name](ice(0.25)))
    load, held = np.zeros((GRID.nodes, 2)), held_in_plane(GRID, {"x-": support})
    load[GRID.node(4, 1)] = 1e6, -3e6
    one, other = (solve(K, f.ravel(), held).reshape(-1, 2) for f in (load, mirror(GRID, load)))
    assert np.abs(mirror(GRID, one) - other).max() < 1e-10 * np.abs(one).max()


@pytest.mark.parametrize("criterion", sorted(CRITERIA))
def test_mirrored_strain_gives_mirrored_utilisation(criterion: str) -> None:
    rng = np.random.default_rng(5)
    u, q = 1e-4 * rng.standard_normal((GRID.nodes, 2)), 1e-4 * rng.standard_normal((GRID.nodes, 3))
    shape = GRID.nx - 1, GRID.ny - 1
    one = CRITERIA[criterion].judge(CellState.of(GRID, u, q), ice()).reshape(shape)
    other = CRITERIA[criterion].judge(CellState.of(GRID, mirror(GRID, u), mirror(GRID, q)), ice()).reshape(shape)
    assert np.abs(one[:, ::-1] - other).max() < 1e-10 * np.abs(one).max()


def test_a_cell_with_one_diagonal_is_rejected() -> None:
    rows = out_of_plane_springs(STIFFNESS_SETS["hrennikoff"](ice()), GRID.d)
    K = (assemble(GRID, rows[:-1]) + 1e3 * sp.identity(3 * GRID.nodes)).tocsc()
    one, other = answer(K, held_out_of_plane(GRID, {"x-": "clamped"}))
    assert np.abs(mirror(GRID, one) - other).max() > 1e-3 * np.abs(one).max()
