"""From a field measurement to the strengths of the model in one call, section 4.2.2."""

from __future__ import annotations

import pytest

from lattice.properties import FieldMeasurement, beam_strength, brine_volume, ice_from_field, youngs_modulus

KARULINA = FieldMeasurement(
    thickness=0.39, salinity=2.7, temperature=-1.6, beam_length=2.30, beam_width=0.46, failure_load=943.0
)  # Table 4-2; the load is that of 0.186 MPa in (4.27)


def test_brine_and_modulus_of_the_karulina_test() -> None:
    """2.7 (49.185 / 1.6 + 0.532) = 84.4 ppt, and E = 1.3 GPa of Table 4-2: Vaudrey's relation is in GPa."""
    assert brine_volume(2.7, -1.6) == pytest.approx(84.44, rel=1e-3)
    assert youngs_modulus(brine_volume(2.7, -1.6)) == pytest.approx(1.3e9, rel=0.02)


def test_modulus_of_fresh_ice() -> None:
    assert youngs_modulus(0.0) == pytest.approx(5.316e9)


def test_strengths_without_relief_carry_the_simulated_factor() -> None:
    ice = ice_from_field(KARULINA)
    assert ice.sigma_f == pytest.approx(0.186e6, rel=1e-3)
    assert ice.sigma_c == pytest.approx(5.0 * ice.sigma_f)
    assert ice.beam_test is not None
    assert ice.beam_test.factor == pytest.approx(0.80, rel=0.05)  # Table 4-3
    assert ice.stress_beside_crack(0.115) == pytest.approx(ice.sigma_f * 0.8 * 0.5 * (2.0 + 1.75**-0.5), rel=0.05)


def test_with_stress_relief_there_is_no_concentration_to_transfer() -> None:
    ice = ice_from_field(FieldMeasurement(**{**vars(KARULINA), "stress_relief": True}))
    assert ice.beam_test is None
    assert ice.stress_beside_crack(0.115) == ice.sigma_f


def test_a_measured_modulus_wins() -> None:
    assert ice_from_field(FieldMeasurement(**{**vars(KARULINA), "E": 2.6e9, "stress_relief": True})).E == 2.6e9


def test_beam_stress_of_the_basin() -> None:
    assert beam_strength(375e3, 18.0, 6.0, 3.0) == pytest.approx(750e3)  # section 6.1


@pytest.mark.parametrize(("salinity", "temperature"), [(2.7, -0.2), (2.7, -30.0), (-1.0, -5.0)])
def test_relations_outside_their_range_are_refused(salinity: float, temperature: float) -> None:
    with pytest.raises(ValueError, match=r"hold from -22.9 to -0.5 C|must not be negative"):
        brine_volume(salinity, temperature)


def test_brine_beyond_the_relation_is_refused() -> None:
    with pytest.raises(ValueError, match="148 ppt"):
        youngs_modulus(150.0)
