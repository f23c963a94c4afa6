"""van Vliet (2018), chapter 2: Table 2-2, Figures 2-9 to 2-11, 2-15 to 2-22."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.verify.case import CaseResult
from cosim.verify.cases import run
from cosim.verify.eigenfrequencies import CONTINUUM, LATTICE
from lattice import continuum, spectrum
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.spectrum import Plate
from lattice.statics import all_around
from lattice.stiffness import hrennikoff


def quantity(result: CaseResult, name: str) -> np.ndarray:
    return np.array(next(q.value for q in result.quantities if q.name.startswith(name)))


def test_table_2_2_all_sixty_lattice_values_to_six_decimals() -> None:
    (result,) = run("eigenfrequencies")
    assert result.passed
    for (nx, ny), printed in LATTICE.items():
        assert np.array_equal(np.round(quantity(result, f"lattice {nx}x{ny}"), 6), printed)


def test_table_2_2_continuum_with_g_of_9_80() -> None:
    """Nineteen values to six decimals; mode 19 is 6.39983547 Hz, printed 6.399836."""
    (result,) = run("eigenfrequencies", {"nodes": [19, 31]})
    off = np.abs(quantity(result, "continuum, g = 9.80") - CONTINUUM)
    assert np.flatnonzero(off > 5e-7).tolist() == [18]
    assert off.max() < 6e-7


def test_table_2_2_rejects_wrong_readings() -> None:
    """g = 9.81 in the continuum column, and the other stiffness set in the lattice column, are seen at once."""
    ice = Ice(E=3e9, nu=0.3, h=1.5, rho_i=900.0, rho_w=1025.0)
    assert np.abs(continuum.eigenfrequencies(ice, 60.0, 100.0, 20) - CONTINUUM)[0] > 1e-4
    other = Plate.build(Grid.rectangle(60.0, 100.0, 19, 31), ice, hrennikoff(ice), all_around("simple"))
    assert np.abs(spectrum.eigenfrequencies(other, 20) - LATTICE[(19, 31)]).max() > 1e-3


def test_figure_2_15_static_deflection() -> None:
    assert run("static-deflection")[0].passed


def test_figures_2_9_to_2_11_dispersion() -> None:
    (result,) = run("dispersion", quick=True)
    assert result.passed
    lattice, exact = quantity(result, "lattice, d = 10 m"), quantity(result, "continuum, d = 10 m")
    assert lattice[0, -1] > 1.5 * exact[0, -1]  # Figure 2-9 d: cells of 10 m are far off at short waves


@pytest.fixture(scope="module")
def response() -> CaseResult:
    return run("frequency-response", quick=True)[0]


def test_figures_2_16_to_2_22_frequency_response(response: CaseResult) -> None:
    failed = [(q.name, q.value) for q in response.quantities if q.passed is False]
    assert not failed
    assert sum(q.passed is True for q in response.quantities) == 6


def test_error_of_the_response_falls_at_second_order(response: CaseResult) -> None:
    order = quantity(response, "order of convergence 19x31 to 61x101")
    assert np.all((order > 1.85) & (order < 2.15))


def test_figure_2_16_mode_2_has_no_deflection_at_the_load() -> None:
    """Below Figure 2-15: the load lies on the node line of mode 2, which therefore does not resonate."""
    (result,) = run("frequency-response", {"nodes": [19, 31], "f_max": 1.1, "c": [0.02], "alpha": [1e-3]}, quick=True)
    w = quantity(result, "amplitude continuum, w")[:, 0]
    f = quantity(result, "frequency")
    assert w[np.abs(f - 0.981).argmin()] < 1.0 < w[np.abs(f - 0.655).argmin()]
