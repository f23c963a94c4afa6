"""van Vliet (2018), chapter 4: envelopes, Resolute splitting test, cantilever beams of Tables 4-2 to 4-4."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cosim.verify.case import CaseResult
from cosim.verify.cases import run
from lattice.criteria.laws import bending_top, tension
from lattice.edge_crack import normalised_load
from lattice.ice import Ice
from lattice.specimens import EdgeCrack, cantilever, factor_f
from lattice.stiffness import hrennikoff
from lattice.unit_cell import cell_in_bending, cell_in_stress


def quantity(result: CaseResult, name: str) -> np.ndarray:
    return np.array(next(q.value for q in result.quantities if q.name.startswith(name)))


def failures(result: CaseResult) -> list[tuple[str, object]]:
    return [(q.name, q.value) for q in result.quantities if q.passed is False]


def test_figures_4_2_4_6_and_4_8_envelopes() -> None:
    (result,) = run("envelope", quick=True)
    assert failures(result) == []


def test_an_envelope_that_depends_on_the_orientation_is_seen() -> None:
    """The wrong twin: without its shear and torsional springs (3.14), (3.17) the cell at nu = 0.2 is anisotropic."""
    ice = Ice(E=5e9, nu=0.2, h=1.0, rho_i=900.0, rho_w=1025.0, sigma_t=0.6e6, sigma_f=0.6e6, sigma_c=5e6)
    full = hrennikoff(ice)
    wrong = replace(full, K_s_axi=0.0, G_t_axi=0.0)
    for load, criterion in ((cell_in_stress, tension), (cell_in_bending, bending_top)):
        spread = {}
        for name, springs in (("full", full), ("wrong", wrong)):
            use = [criterion(load(ice, springs, np.array([6e5, 0.0]), a), ice)[0] for a in (0.0, 0.785)]
            spread[name] = abs(use[1] / use[0] - 1.0)
        assert spread["full"] < 1e-10
        assert spread["wrong"] > 1e-2


@pytest.fixture(scope="module")
def splitting() -> CaseResult:
    return run("splitting", quick=True)[0]


def test_table_4_1_and_figure_4_14_resolute_test(splitting: CaseResult) -> None:
    assert failures(splitting) == []
    assert quantity(splitting, "start of the crack") == pytest.approx(1186.0, rel=0.005)
    assert quantity(splitting, "CMOD at the start") == pytest.approx(722e-6, rel=0.05)
    assert quantity(splitting, "CTOD at the start") == pytest.approx(19e-6, rel=0.05)


def test_figure_4_13_against_lefm(splitting: CaseResult) -> None:
    """Within 1 % for a/L of 0.2 to 0.7 with 60 cells; half the cells are further off at the short crack."""
    lefm = normalised_load(np.array([0.1]), 80)[0]
    coarse, fine = (quantity(splitting, f"normalised load, lattice, {n} cells")[0] for n in (30, 60))
    assert abs(coarse / lefm - 1.0) > abs(fine / lefm - 1.0)


def test_a_crack_that_leaves_the_plate_is_refused() -> None:
    with pytest.raises(ValueError, match=r"crack of 62 cells \(31 m\) does not end inside the plate"):
        run("splitting", {"a": 31.0})


def test_poisson_s_ratio_of_0_33_moves_the_start(splitting: CaseResult) -> None:
    """Why 1/3: the shear springs of nu = 0.33 resist the turning of the halves."""
    (other,) = run("splitting", {"nu": 0.33}, quick=True)
    assert quantity(other, "start of the crack") > 1.1 * quantity(splitting, "start of the crack")


@pytest.fixture(scope="module")
def beam() -> CaseResult:
    return run("cantilever", quick=True)[0]


def test_tables_4_2_to_4_4_and_figure_4_18(beam: CaseResult) -> None:
    assert failures(beam) == []


def test_table_4_3_trends(beam: CaseResult) -> None:
    """f rises with thickness and with a narrower beam, and hardly depends on length and modulus."""
    f = {
        name: float(quantity(beam, f"factor f, {name}"))
        for name in ("base case", "1.5 x length", "2 x thickness", "2 x Young's modulus", "0.5 x width")
    }
    assert f["0.5 x width"] > f["2 x thickness"] > f["base case"]
    assert f["1.5 x length"] == pytest.approx(f["base case"], rel=0.02)
    assert f["2 x Young's modulus"] == pytest.approx(f["base case"], rel=0.02)


def test_the_criterion_beside_a_crack_hardly_depends_on_the_mesh() -> None:
    """(4.31): the edge strain itself grows by 25 % from 4 to 8 cells, f by 4 %. The wrong twin is the edge strain."""
    ice = Ice(E=1.3e9, nu=1.0 / 3.0, h=0.39, rho_i=920.0, rho_w=1025.0)
    f = [factor_f(ice, 2.30, 0.46, cells) for cells in (4, 8)]
    shape = [0.5 * (cells**0.5 + (2.0 - 1.0 / cells) ** -0.5) for cells in (4, 8)]
    assert f[1] == pytest.approx(f[0], rel=0.05)
    assert f[1] * shape[1] > 1.2 * f[0] * shape[0]


def test_specimens_that_do_not_fit_are_refused() -> None:
    ice = Ice(E=1.3e9, nu=1.0 / 3.0, h=0.39, rho_i=920.0, rho_w=1025.0)
    with pytest.raises(ValueError, match="does not fit"):
        cantilever(ice, 2.3, 0.46, 4, side=2.0)
    with pytest.raises(ValueError, match="at least 3"):
        cantilever(ice, 2.3, 0.46, 2)
    with pytest.raises(ValueError, match="use 1 to 9 cells"):
        EdgeCrack(ice, 10.0, 10, 0)
