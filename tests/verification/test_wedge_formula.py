"""(6.2)-(6.5) by closed integrals: the reference of the wedge is itself checked, term by term."""

import numpy as np
import pytest

from cosim.verify.wedge import PARAMETERS, TABLE, formula

RHO_I, RHO_W, G, H, L = 846.0, 1006.0, 9.81, 3.0, 10.0
DRAFT = RHO_I / RHO_W * H
THETA = np.pi / 2


def lever(phi):
    """Arm of the force along the slope, with friction, at 45 degrees [m]."""
    a = np.pi / 4
    return L * (np.cos(a - phi) - 0.1 * np.sin(a - phi))


@pytest.mark.parametrize("degrees", [5.0, 20.0, 40.0])
def test_moments_of_weight_and_water(degrees):
    """Width (L - x) theta: its first moment is theta L^3 / 6 and its second theta L^4 / 12."""
    phi = np.radians(degrees)
    first, second = THETA * L**3 / 6.0, THETA * L**4 / 12.0
    up = RHO_W * G * (DRAFT * first + np.sin(phi) * second)
    down = RHO_I * G * H * np.cos(phi) * first
    assert formula(PARAMETERS, L, phi, "none") == pytest.approx((up - down) / lever(phi), rel=1e-9)


@pytest.mark.parametrize("degrees", [20.0, 40.0])
def test_backfill_presses_where_the_wedge_lies_below_the_water(degrees):
    """Water on top from x_0 = draft / sin phi on: integral of (x sin phi - draft) (L - x) x."""
    phi = np.radians(degrees)
    x = np.polynomial.Polynomial([0.0, 1.0])
    moment = ((x * np.sin(phi) - DRAFT) * (L - x) * x).integ()
    water = RHO_W * G * THETA * (moment(L) - moment(min(DRAFT / np.sin(phi), L)))
    less = formula(PARAMETERS, L, phi, "none") - formula(PARAMETERS, L, phi, "full")
    assert less == pytest.approx(water / lever(phi), rel=1e-4, abs=1.0)
    assert (less > 0.0) == (L * np.sin(phi) > DRAFT)


@pytest.mark.parametrize("case", TABLE)
def test_the_table_is_that_of_the_formula(case):
    found = [formula(PARAMETERS, case[0], np.radians(d), case[1]) / 1e6 for d in PARAMETERS["degrees"]]
    assert found == pytest.approx(TABLE[case], rel=2e-3)
