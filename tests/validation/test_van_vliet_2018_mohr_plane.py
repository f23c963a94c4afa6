"""Figures 6-12, 6-25, 6-26, 6-31 of van Vliet (2018): strain of all cells of a floe in the plane of Mohr's circle."""

from pathlib import Path

import numpy as np
import pytest

from cosim.verify import mohr_plane
from cosim.verify.cases import run, save_figures
from cosim.verify.mohr_figure import compressive_limit, envelope
from cosim.verify.mohr_record import Record
from lattice.ice import Ice

ICE = Ice(E=8.7e9, nu=1.0 / 3.0, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=0.75e6, sigma_f=0.75e6, sigma_c=4e6)


def circle_of(first, second):
    """Mean and radius times E under the principal stresses [Pa], plane stress."""
    return (1 - ICE.nu) * (first + second) / 2, (1 + ICE.nu) * abs(first - second) / 2


@pytest.fixture(scope="module")
def result():
    return run("mohr-plane", quick=True)[0]


def test_the_split_of_a_coarse_floe_holds_against_the_thesis(result):
    """Section 6.4: 3.2 MN and 2.7 MN; states inside the envelope, failing cells on it, T-C dominant."""
    assert result.passed
    assert sum(q.passed is True for q in result.quantities) == 7
    share = next(q.value for q in result.quantities if "share of the states" in q.name)
    assert sum(share) == pytest.approx(1.0)
    assert share[1] > 0.5


def test_its_figure_is_drawn(result, tmp_path):
    pytest.importorskip("matplotlib")
    paths = save_figures(result, Path(tmp_path))
    assert [p.name for p in paths] == ["mohr-plane_figure_6-26.png"]
    assert paths[0].stat().st_size > 10_000


def test_the_envelope_goes_through_both_uniaxial_strengths():
    """(4.6) with (6.1): tension at sigma_t, compression at sigma_c; there (4.5) meets it."""
    for stress in (ICE.sigma_t, -ICE.sigma_c):
        mean, radius = circle_of(stress, 0.0)
        assert envelope(ICE, np.array(mean), ICE.sigma_t) == pytest.approx(radius, rel=1e-12)
    assert compressive_limit(ICE, np.array(mean)) == pytest.approx(radius, rel=1e-3)  # three digits in (4.4)


@pytest.mark.parametrize(
    ("first", "second", "quadrant"),
    [(2.0, 1.0, 0), (1.0, 0.01, 0), (1.0, -0.01, 1), (0.01, -1.0, 1), (-0.01, -1.0, 2), (-1.0, -1.0, 2)],
)
def test_quadrants_follow_the_signs_of_the_principal_stresses(first, second, quadrant):
    circle = np.array([[*circle_of(first, second), *circle_of(first, second)]])
    assert Record(ICE).quadrants(circle)[quadrant] == 2.0


def test_a_state_outside_the_envelope_is_not_passed():
    assert mohr_plane._below_one("x", 1.0 + 1e-8, "").passed is False
    assert mohr_plane._below_one("x", float("nan"), "").passed is False


def test_an_unknown_floe_is_refused():
    with pytest.raises(ValueError, match="165m, 55m-corner"):
        run("mohr-plane", ["floe=66m"])
