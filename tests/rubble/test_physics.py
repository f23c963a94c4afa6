"""What the rubble is made of: derived values by hand, and every value that cannot be is refused."""

from math import inf, nan

import pytest

from rubble.physics import RubblePhysics

NAMES = ("rho_i", "g", "mu_ice_ice", "restitution", "form_drag", "skin_drag", "added_mass", "thickness", "filling_time")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("value", [-0.1, inf, nan])
def test_a_value_is_a_number_from_zero_on(name, value):
    with pytest.raises(ValueError, match=rf"rubble\.{name} is {value}; it must be a number >= 0"):
        RubblePhysics(**{name: value})


@pytest.mark.parametrize("name", ["contact_strength"])
def test_strength_may_be_without_bound(name):
    assert getattr(RubblePhysics(**{name: inf}), name) == inf
    for value, words in ((-1.0, ">= 0"), (nan, ">= 0"), (0.0, "must be > 0")):
        with pytest.raises(ValueError, match=words):
            RubblePhysics(**{name: value})


@pytest.mark.parametrize("current", [(inf, 0.0), (0.0, nan)])
def test_a_current_is_finite(current):
    with pytest.raises(ValueError, match="two finite velocities"):
        RubblePhysics(current=current)


def test_derived_values():
    p = RubblePhysics(rho_i=846.0, rho_w=1006.0, g=9.8, thickness=3.0, filling_time=4.0, backfill="filling")
    assert p.afloat == pytest.approx(9.8 * (3.0 - 3.0 * 846.0 / 1006.0) / 2.0, rel=1e-12)
    assert p.slop == pytest.approx(0.015, rel=1e-12)
    assert p.filling_rate == 0.25
    assert RubblePhysics(backfill="full").filling_rate == RubblePhysics(backfill="none").filling_rate == 0.0
