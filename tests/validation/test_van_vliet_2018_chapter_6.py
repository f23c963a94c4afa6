"""Basin floes of van Vliet (2018), chapter 6, breaking phase: loads and patterns of the thesis's own simulations."""

from pathlib import Path

import numpy as np
import pytest

from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from coupling.crushing import CONTACTS, CrushingContact

SCENARIOS = Path(__file__).parents[2] / "scenarios"


def breaking(case, until, *more):
    options = ["rubble.enabled=false", f"scenario.duration='{until} s'", *more]
    return run_scenario(load_scenario(SCENARIOS / f"van_vliet_2018_{case}", options))


def first(result, kind):
    return next(e for e in result.events if e.kind == kind)


@pytest.mark.parametrize(
    ("case", "fx", "fz", "time"),
    [
        ("floe_55m_centre", 3.2e6, 2.7e6, 19.75),  # section 6.4, Figure 6-24; the time is an independent calculation's
        ("floe_34x68m", 2.7e6, 2.3e6, 18.5),  # section 6.5, Figure 6-30
    ],
)
def test_small_floes_split(case, fx, fz, time):
    split = first(breaking(case, 22), "split")
    assert split.force[0] == pytest.approx(fx, rel=0.05)
    assert split.force[2] == pytest.approx(fz, rel=0.05)
    assert split.t_ns / 1e9 == pytest.approx(time, rel=0.03)


def test_the_large_floe_cracks_along_its_centre_first():
    """Section 6.3: a long crack in the middle, long before the circumferential failure."""
    result = breaking("floe_165m", 16)
    crack = first(result, "cell_failure")
    assert crack.t_ns / 1e9 == pytest.approx(13.0, rel=0.05)
    assert abs(crack.position[1]) < 1.5
    assert not [e for e in result.events if e.kind in ("split", "circumferential")]


@pytest.mark.slow
def test_the_large_floe_breaks_around_the_structure():
    """Section 6.3: 5.4 MN and 4.6 MN at the circumferential failure, Figure 6-10."""
    failure = first(breaking("floe_165m", 28), "circumferential")
    assert failure.force[0] == pytest.approx(5.4e6, rel=0.07)
    assert failure.force[2] == pytest.approx(4.6e6, rel=0.07)


@pytest.mark.slow
def test_hard_contact_breaks_the_large_floe_early():
    """Section 6.3.2: 2000 kPa gives 4.8 MN and 4.0 MN after a much shorter build-up, Figure 6-17."""
    failure = first(breaking("floe_165m", 9, "contact.strength='2000 kPa'"), "circumferential")
    assert failure.force[0] == pytest.approx(4.8e6, rel=0.10)
    assert failure.force[2] == pytest.approx(4.0e6, rel=0.10)
    assert failure.t_ns / 1e9 < 25.5 / 3


@pytest.mark.slow
def test_the_corner_of_the_small_floe_breaks_off():
    """Section 6.4: 3.3 MN and 2.8 MN at 20.7 s, Figure 6-23."""
    failure = first(breaking("floe_55m_corner", 24), "split")
    assert failure.force[0] == pytest.approx(3.3e6, rel=0.05)
    assert failure.force[2] == pytest.approx(2.8e6, rel=0.05)
    assert failure.t_ns / 1e9 == pytest.approx(20.7, rel=0.05)


class AtMiddle(CrushingContact):
    """A crushing contact as if the force acted at middle thickness."""

    def _keep(self, crushed, height):
        super()._keep(crushed, np.zeros_like(height))


@pytest.mark.slow
def test_the_height_of_a_crushing_contact_raises_the_load_of_the_large_floe(monkeypatch):
    """4 MPa: 5.64 / 4.63 MN at 5.2 s at its true height, 4.57 / 3.75 MN at 4.5 s at middle thickness.

    80 x 80 nodes: 5.54 and 4.65 MN (Fx). Equilibria of the cracked floe under the same distribution of forces, scaled
    until a cell in intact ice fails, give 4.6 MN for z = 0, 5.1 for 0.6 m, 5.5 for 1.25 m and 5.6 for 1.38 m, the
    height of the force at failure.
    """
    options = ["contact.model=crushing", "contact.strength='4 MPa'"]
    true = first(breaking("floe_165m", 6, *options), "circumferential")
    monkeypatch.setitem(CONTACTS, "crushing", AtMiddle)
    middle = first(breaking("floe_165m", 6, *options), "circumferential")
    for event, fx, fz, time in ((true, 5.64e6, 4.63e6, 5.20), (middle, 4.57e6, 3.75e6, 4.54)):
        assert event.force[0] == pytest.approx(fx, rel=0.02)
        assert event.force[2] == pytest.approx(fz, rel=0.02)
        assert event.t_ns / 1e9 == pytest.approx(time, rel=0.02)
