"""What the ice gives beside its strengths: stiffness of the plate, and the limit beside a crack."""

import dataclasses
import math

import pytest

from lattice.ice import BeamTest, Ice

TEST = BeamTest(length=18.0, width=6.0, failure_load=375e3, factor=0.75)  # thesis 6.1, full scale
ICE = Ice(E=8.7e9, nu=0.3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_f=0.75e6, beam_test=TEST)


@pytest.mark.parametrize(
    ("ratio", "shape"),
    [
        (0.25, 0.5 * (2.0 + 1.75**-0.5)),  # 1.37796...
        (0.5, 0.5 * (2.0**0.5 + 1.5**-0.5)),
        (1.0, 1.0),  # both terms are 1
        (1.5, 0.5 * (1.5**-0.5 + 2.0**0.5)),  # from here on the second term is the larger
        (1.75, 0.5 * (1.75**-0.5 + 2.0)),
    ],
)
def test_the_limit_beside_a_crack(ratio, shape):
    """(4.31): 6 F L / (w h^2) = 0.75 MPa, times (d/w)^-1/2 and (2 - d/w)^-1/2, halved, and f = 0.75."""
    assert ICE.stress_beside_crack(6.0 * ratio) == pytest.approx(0.75e6 * 0.75 * shape, rel=1e-12)


def test_the_limit_beside_a_crack_is_least_at_the_width_of_the_beam():
    """The two terms change places at d = w: the limit is the same at 1.5 w as at w / 2."""
    assert ICE.stress_beside_crack(9.0) == pytest.approx(ICE.stress_beside_crack(3.0), rel=1e-12)
    assert ICE.stress_beside_crack(9.0) > 1.1 * ICE.stress_beside_crack(6.0)


@pytest.mark.parametrize("d", [12.0, 12.1])
def test_the_limit_ends_at_twice_the_width(d):
    with pytest.raises(ValueError, match="refine the mesh"):
        ICE.stress_beside_crack(d)


def test_stiffness_of_the_plate_on_water():
    """D = 8.7e9 27 / (12 0.91), l_c = (D / (1006 9.81))^1/4, freeboard 3 (160 / 1006)."""
    assert pytest.approx(8.7e9 * 27.0 / 10.92, rel=1e-12) == ICE.D
    assert ICE.k_f == 1006.0 * 9.81
    assert ICE.l_c == pytest.approx(math.sqrt(math.sqrt(8.7e9 * 27.0 / 10.92 / 9868.86)), rel=1e-12)
    assert ICE.freeboard == pytest.approx(480.0 / 1006.0, rel=1e-12)
    assert ICE.shear_stiffness == pytest.approx(5.0 / 5.7 * 8.7e9 / 2.6 * 3.0, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"nu": 0.34}, "use 0 to 1/3"),
        ({"nu": -0.01}, "use 0 to 1/3"),
        ({"h": 0.0}, "h = 0 must be greater than 0"),
        ({"sigma_t": -1.0}, "sigma_t = -1 must be greater than 0"),
        ({"rho_i": float("nan")}, "rho_i = nan must be"),
        ({"sigma_spall": 0.0}, "must be negative"),
    ],
)
def test_ice_that_cannot_be_is_refused(change, words):
    with pytest.raises(ValueError, match=words):
        dataclasses.replace(ICE, **change)


@pytest.mark.parametrize("nu", [0.0, 1.0 / 3.0])
def test_the_ends_of_poisson_s_ratio_are_allowed(nu):
    assert dataclasses.replace(ICE, nu=nu).nu == nu
