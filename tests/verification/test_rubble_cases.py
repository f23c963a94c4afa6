"""Cases of `cosim verify` on the rubble: every claim on a short version, the full ones when slow tests run."""

import pytest

from cosim.verify import cases

CASES = ("wedge", "float", "slope", "terminal-velocity", "momentum", "pile", "pusher", "cone")


def missed(result):
    return [(q.name, q.value, q.reference) for q in result.quantities if q.passed is False]


@pytest.mark.parametrize("case", CASES)
def test_the_layer_meets_its_references(case):
    result = cases.run(case, quick=True)[0]
    assert not missed(result)
    assert sum(q.reference is not None for q in result.quantities) >= 2


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_the_layer_meets_its_references_in_full(case):
    assert not missed(cases.run(case)[0])


@pytest.mark.parametrize(
    "settings", [{"slope": 60.0, "mu": 0.3, "L0": [15.0]}, {"slope": 50.0, "mu": 0.0, "L0": [8.0]}]
)
def test_wedge_for_other_slopes_and_frictions(settings):
    result = cases.run("wedge", settings, quick=True)[0]
    assert not missed(result)
    assert all(len(q.value) == 5 for q in result.quantities)


def test_a_wrong_friction_is_found_by_the_wedge(monkeypatch):
    """The reference with the friction's sign reversed must not pass."""
    wedge = cases.CASES["wedge"]
    exact = wedge.formula
    monkeypatch.setattr(wedge, "formula", lambda p, *a: exact({**p, "mu": -p["mu"]}, *a))
    assert missed(cases.run("wedge", {"L0": [10.0]}, quick=True)[0])


def test_a_real_wedge_has_no_reference_but_values():
    result = cases.run("wedge", {"geometry": "block", "L0": [10.0]}, quick=True)[0]
    assert all(q.reference is None and min(q.value) > 0.0 for q in result.quantities)
    dry, flooded = result.quantities
    assert dry.value[-1] > 5.0 * flooded.value[-1]


@pytest.mark.parametrize(("turned", "mu"), [(30.0, 1.0), (-20.0, 0.1), (10.0, 0.0)])
def test_oblique_impacts_that_stick_and_slide(turned, mu):
    assert not missed(cases.run("momentum", {"turned": turned, "mu": mu, "offset": -0.2}, quick=True)[0])


@pytest.mark.parametrize(
    ("case", "settings", "words"),
    [
        ("wedge", {"geometry": "cube"}, "plate"),
        ("float", {"rho_i": 1100.0}, "rho_i < rho_w"),
        ("float", {"length": 1.0}, "turns over"),
        ("pusher", {"force": -1.0}, "force > 0"),
        ("cone", {"y": [0.9]}, "0.85"),
        ("momentum", {"e": 2.0}, "e <= 1"),
        ("terminal-velocity", {"rho": [1006.0]}, "other than the water"),
    ],
)
def test_parameters_that_make_no_sense_get_one_line(case, settings, words):
    with pytest.raises(ValueError, match=words) as error:
        cases.run(case, settings, quick=True)
    assert "\n" not in str(error.value)
