"""Criteria of chapters 4 and 5 at loads whose answer is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lattice.criteria.mohr import circle, circle_of_connections
from lattice.criteria.table import CRITERIA
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.stiffness import hrennikoff
from lattice.strain import CellState
from lattice.unit_cell import cell_in_bending, cell_in_stress

ICE = Ice(
    E=5e9,
    nu=1.0 / 3.0,
    h=1.2,
    rho_i=900.0,
    rho_w=1025.0,
    sigma_t=0.6e6,
    sigma_f=0.9e6,
    sigma_c=5e6,
    beam_test=BeamTest(length=9.0, width=3.0, failure_load=0.2e6, factor=0.8),
    sigma_spall=-28e6,
    sigma_f_upward=0.7e6,
    sigma_f_downward=1.1e6,
    sigma_shear=0.7e6,
    K_IC=2e5,
)
SPRINGS = hrennikoff(ICE)


def use(criterion: str, state: CellState) -> float:
    return float(CRITERIA[criterion].judge(state, ICE)[0])


def stress(xx: float, yy: float, alpha: float = 0.4) -> CellState:
    return cell_in_stress(ICE, SPRINGS, np.array([xx, yy]), alpha, 2.0)


def bending(xx: float, yy: float = 0.0, alpha: float = 0.4) -> CellState:
    return cell_in_bending(ICE, SPRINGS, np.array([xx, yy]), alpha, 2.0)


@pytest.mark.parametrize(
    ("criterion", "state", "expected"),
    [
        ("tension", stress(0.6e6, 0.0), 1.0),
        ("tension", stress(-5e6, 0.0), 1.0),
        ("compression", stress(-5e6, 0.0), 1.0),
        ("spalling", stress(-14e6, -14e6), 1.0),
        ("spalling", stress(-20e6, -8e6), 1.0),
        ("spalling", stress(1e6, 1e6), -1 / 14),
        ("bending-top", bending(0.9e6), 1.0),
        ("bending-bottom", bending(-0.9e6), 1.0),
        ("downward-bending", bending(1.1e6), 1.0),
        ("upward-bending", bending(-0.7e6), 1.0),
        ("combined-tension", bending(0.9e6), 1.0),
        ("combined-tension", bending(-0.9e6), 1.0),
        ("combined-tension", stress(0.6e6, 0.0), 1.0),
        ("combined-compression", stress(-5e6, 0.0), 1.0),
        ("principal-stress", stress(0.6e6, 0.0), 1.0),
        ("principal-stress", stress(0.6e6, -5e6), 1.0),
        ("principal-stress", bending(0.9e6, 0.5e6), 1.0),
        ("principal-stress", bending(-0.9e6), 1.0),
    ],
)
def test_a_uniaxial_or_equal_load_fails_at_its_strength(criterion: str, state: CellState, expected: float) -> None:
    assert use(criterion, state) == pytest.approx(expected, rel=1e-3)  # the constants of (4.4) have three digits


def test_the_weak_side_of_bending_is_the_one_in_tension() -> None:
    """Compression of the other face counts with the compressive strength and is far from failing."""
    assert use("bending-bottom", bending(0.9e6)) < 0.5 < use("bending-top", bending(0.9e6))
    assert use("upward-bending", bending(0.7e6)) < 0.5


def test_confinement_helps_against_shear_faulting_and_not_against_spalling() -> None:
    assert use("compression", stress(-5e6, -1e6)) < use("compression", stress(-5e6, 0.0))
    assert use("spalling", stress(-5e6, -1e6)) > use("spalling", stress(-5e6, 0.0))


def test_averages_over_connections_are_the_circle_in_a_uniform_state() -> None:
    for state in (stress(1e6, -2e6, 0.7), bending(1e6, 0.3e6, 1.1)):
        for part, uniform in (
            (state.membrane, circle(state.strains)),
            (state.bending, circle(state.strains.bending_only(), 1.0)),
        ):
            for ours, mean in zip(circle_of_connections(part), uniform, strict=True):
                assert ours == pytest.approx(mean, rel=1e-9, abs=1e-18)


def test_the_crack_tip_limits_scale_with_the_cell() -> None:
    """(4.23): stress at the tip sqrt(2 / (pi d)) K_IC; (4.31): the beam's stress over sqrt(d / w)."""
    for d in (0.5, 2.0):
        tension = cell_in_stress(ICE, SPRINGS, np.array([np.sqrt(2.0 / (np.pi * d)) * 2e5, 0.0]), 0.0, d)
        assert use("crack-tip-splitting", tension) == pytest.approx(1.0, rel=1e-9)
        beam = 6.0 * 0.2e6 * 9.0 / (3.0 * 1.2**2) * 0.4 * ((3.0 / d) ** 0.5 + (2.0 - d / 3.0) ** -0.5)
        bent = cell_in_bending(ICE, SPRINGS, np.array([beam, 0.0]), 0.0, d)
        assert use("crack-tip-bending", bent) == pytest.approx(1.0, rel=1e-9)


def test_shear_is_measured_in_the_springs_between_particles() -> None:
    """A sheet that slides by gamma d over each cell without turning: G gamma against the shear strength."""
    grid, gamma = Grid(3, 3, 2.0), 1e-4
    q = np.zeros((grid.nodes, 3))
    q[:, 0] = gamma * grid.xy[:, 0]
    G = ICE.E / (2.0 * (1.0 + ICE.nu))
    state = CellState.of(grid, np.zeros((9, 2)), q)
    assert use("out-of-plane-shear", state) == pytest.approx(G * gamma / 0.7e6, rel=1e-9)


def test_a_cell_too_coarse_for_the_beam_test_is_refused() -> None:
    with pytest.raises(ValueError, match="refine the mesh"):
        use("crack-tip-bending", replace(bending(1e6), d=6.0))
