"""Design formulas against the log of IceFloe (test GLA), the thesis's cone and limits."""

from dataclasses import replace
from math import log, radians

import pytest

from cosim.baselines.case import BaselineError, Case
from cosim.baselines.croasdale import croasdale
from cosim.baselines.nevel import nevel
from cosim.baselines.ralston import Y_JOHANSEN, Y_TRESCA, ralston_johansen, ralston_tresca

#: OpenFAST, modules/icefloe, tests GLA_*: ISO (type 6) and IEC (type 7) flexural failure
GLA = Case(
    h=1.0,
    w=5.0,
    a=radians(60),
    mu=0.15,
    sigma_f=7e5,
    E=8e9,
    nu=0.3,
    rho_i=916.2,
    rho_w=999.8,
    g=9.81,
    h_r=3.0,
    e=0.3,
    th=radians(40),
    ph=radians(45),
    c=0.0,
    mu_i=0.05,
    h_R=2.5,
    D_T=1.5,
    breaking="upward",
)
#: van Vliet (2018), Table 6-1; rubble assumed
THESIS = Case(
    h=3.0,
    w=30.0,
    a=radians(45),
    mu=0.1,
    sigma_f=750e3,
    E=8.7e9,
    nu=1 / 3,
    rho_i=846.0,
    rho_w=1006.0,
    g=9.81,
    h_r=6.0,
    e=0.3,
    th=radians(30),
    ph=radians(45),
    c=0.0,
    mu_i=0.1,
    h_R=3.0,
    D_T=18.0,
)
SIX = 1e-6  #: six digits, with half a unit of the last


@pytest.mark.parametrize(
    ("g", "terms", "total"),
    [
        (9.81, {"H_P": 2241.97, "H_L": 209677.8, "H_T": 42608.9, "H_R": 408262.3, "H_B": 1844140.1}, 2659967.6),
        (9.80665, {"H_P": 2241.21, "H_L": 209606.2, "H_T": 42594.3, "H_R": 408122.9, "H_B": 1844122.9}, 2659695.4),
    ],
)
def test_croasdale_term_by_term(g, terms, total):
    found = croasdale(replace(GLA, g=g))
    for name, value in terms.items():
        assert found.terms[name] == pytest.approx(value, rel=3e-6), name
    assert found.fx == pytest.approx(total, rel=SIX)
    assert found.fz == pytest.approx(-total / found.between["xi"], rel=SIX)


def test_croasdale_beside_the_log_of_icefloe():
    found = croasdale(GLA)
    log = {"H_P": 2242.0, "H_L": 2.09678e5, "H_T": 42609.0, "H_R": 4.08262e5, "H_B": 1.84414e6}
    for name, value in log.items():
        assert found.terms[name] == pytest.approx(value, rel=1.5e-5), name
    assert found.fx == pytest.approx(2.65997e6, rel=2e-6)
    assert found.between["L_c"] == pytest.approx(16.531844, rel=SIX)
    assert found.between["l_c"] == pytest.approx(45.790690, rel=SIX)
    assert found.between["xi"] == pytest.approx(2.5426509, rel=SIX)


@pytest.mark.parametrize(
    ("h_r", "H_R", "H_L", "F_H", "F_V"),
    [
        (0.0, 0.0, 0.0, 11.2, 9.1),
        (6.0, 1.53, 0.35, 13.1, 10.8),
        (10.0, 2.61, 0.98, 15.0, 12.2),
        (15.0, 4.04, 2.21, 17.8, 14.5),
    ],
)
def test_croasdale_downward_at_the_thesis_cone(h_r, H_R, H_L, F_H, F_V):
    found = croasdale(replace(THESIS, h_r=h_r))
    assert [found.terms[k] / 1e6 for k in ("H_B", "H_R", "H_L", "H_T")] == pytest.approx(
        [10.07, H_R, H_L, 0.71], abs=6e-3
    )
    assert (found.fx / 1e6, found.fz / 1e6) == pytest.approx((F_H, F_V), abs=0.06)
    assert (found.between["L_c"], found.between["l_c"]) == pytest.approx((38.65, 125.36), abs=6e-3)


def test_the_same_slope_breaks_upwards_at_a_higher_load():
    assert croasdale(replace(THESIS, breaking="upward")).fx == pytest.approx(24.7e6, abs=0.05e6)


def test_ice_as_wide_as_the_slope_has_no_ends():
    found = croasdale(replace(GLA, wide=True))
    assert found.between["l_c"] == 5.0
    assert found.terms["H_B"] == pytest.approx(1844140.1 * 5.0 / 45.790690, rel=SIX)


@pytest.mark.parametrize(("g", "total"), [(9.81, 3744751.7), (9.80665, 3744469.9)])
def test_ralston_tresca(g, total):
    found = ralston_tresca(replace(GLA, g=g))
    assert found.fx == pytest.approx(total, rel=SIX)
    if g == 9.81:
        assert (found.terms["H_B"], found.terms["H_R"]) == pytest.approx((3077324.0, 667427.0), rel=SIX)
        assert found.fz == pytest.approx(-1.878499e6, rel=SIX)
        expected = {"g_r": 2.2172497, "G": 0.0802493, "x": 1.7914980, "f": 1.0277648, "W": 255594.0}
        for name, value in expected.items():
            assert found.between[name] == pytest.approx(value, rel=SIX), name
        assert (found.between["E1"], found.between["E2"]) == pytest.approx((2.156515, 1.211056), rel=1.1e-5)


def test_ralston_johansen():
    found = ralston_johansen(GLA)
    assert found.fx == pytest.approx(4.318e6, abs=500.0)
    assert found.terms["A3"] == pytest.approx(ralston_tresca(GLA).terms["H_R"], rel=1e-12)
    down = ralston_johansen(THESIS)
    assert (down.fx / 1e6, down.fz / 1e6) == pytest.approx((18.1, 18.6), abs=0.05)
    assert down.between["lambda"] == pytest.approx(1.846, abs=5e-4)
    up = ralston_tresca(replace(THESIS, breaking="upward"))
    assert (up.fx / 1e6, up.fz / 1e6) == pytest.approx((25.5, -26.7), abs=0.05)


def test_both_forms_have_the_same_vertical_parts():
    """B1 and B2 of the second form are h_v and the ride-up part of the first: independent sources, six digits."""
    a, b = ralston_tresca(GLA), ralston_johansen(GLA)
    ring = GLA.rho_i * GLA.g * GLA.h_R * (GLA.w**2 - GLA.D_T**2)
    assert b.between["B1"] == pytest.approx(a.between["h_v"], rel=SIX)
    assert a.terms["V_R"] == pytest.approx(b.between["B1"] * a.terms["H_R"] + b.between["B2"] * ring, rel=SIX)


def test_lambda_is_where_the_first_form_is_least():
    """1.369 = 1 + 1 / 2.711 and 0.0922 = 1 / (4 . 2.711): with the Johansen criterion it is not the least load."""

    def load(x, Y):
        G = GLA.rho_i * GLA.g * GLA.w**2 / (GLA.sigma_f * GLA.h)
        return (1.0 + Y * x * log(x)) / (3.0 * (x - 1.0)) + (x**2 + x - 2.0) / 12.0 * G

    x = ralston_johansen(GLA).between["lambda"]
    assert load(x, Y_TRESCA) < min(load(1.001 * x, Y_TRESCA), load(0.999 * x, Y_TRESCA))
    assert load(0.999 * x, Y_JOHANSEN) < load(x, Y_JOHANSEN)
    assert x == pytest.approx(1.8944, abs=3e-4)
    standard = ralston_tresca(GLA).between["x"]
    assert load(standard, Y_TRESCA) / load(x, Y_TRESCA) == pytest.approx(1.003, abs=5e-4)


def test_nevel_at_the_thesis_cone():
    found = nevel(THESIS)
    assert found.between["l"] == pytest.approx(37.53, abs=5e-3)
    assert found.fx / found.fz == pytest.approx(1.1 / 0.9, rel=1e-12)
    one = replace(THESIS, w=1e-9, wedges=2)  # 90 deg each, loaded at the tip: 1.05 sigma_f h^2 / 3 each
    assert nevel(one).fz == pytest.approx(2 * 1.05 * 750e3 * 9.0 / 3.0, rel=1e-6)


@pytest.mark.parametrize(
    ("formula", "change", "says"),
    [
        (croasdale, {"mu": 0.6}, "less than 0.577"),
        (croasdale, {"mu": 1.8, "a": radians(30)}, "does not slide"),
        (croasdale, {"th": radians(60)}, "baseline.rubble_slope"),
        (ralston_tresca, {"mu": 0.8}, "1 / g"),
        (ralston_johansen, {"mu": 0.8}, "1 / g"),
        (ralston_tresca, {"D_T": 5.0}, "baseline.top_diameter"),
        (nevel, {"mu": 0.6}, "less than 0.577"),
        (nevel, {"wedges": 1}, "baseline.wedges"),
        (croasdale, {"a": radians(80), "mu": 0.17, "h_r": 0.0}, "in bending"),
    ],
)
def test_limits_are_errors_in_one_line(formula, change, says):
    with pytest.raises(BaselineError, match=says.replace("/", r"\/")) as error:
        formula(replace(GLA, **change))
    assert "\n" not in str(error.value)
