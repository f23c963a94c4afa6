"""What the rubble knows of a sheet that yields: displacement and velocity after a window, for all sections at once."""

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.interface import SimulationError
from coupling.sheet_port.yielding import oscillator

WINDOW = 0.05
HEAVY = ["sheet.nodes=[30,30]", "rubble.initial_volume='1500 m^3'", "scenario.duration='2 s'"]


@pytest.mark.parametrize(("k", "m"), [(1e6, 9e4), (3e7, 9e4), (2e9, 6e5)])
def test_an_oscillator_is_found_from_its_own_answer(k, m):
    theta = WINDOW * np.sqrt(k / m)
    x, v = (1 - np.cos(theta)) / k, np.sin(theta) * theta / WINDOW / k
    assert theta < np.pi
    assert oscillator(np.array([x]), np.array([v]), WINDOW) == (pytest.approx(k, rel=1e-6), pytest.approx(m, rel=1e-6))


def test_a_free_mass_and_a_motion_that_is_over_are_the_ends():
    x = np.array([1e-9, 1e-9])
    k, m = oscillator(x, np.array([2.1 * 1e-9 / WINDOW, -1e-9]), WINDOW)
    assert m[0] == pytest.approx(WINDOW**2 / 2 / x[0], rel=1e-3)
    assert k[0] * WINDOW**2 < 1e-4 * m[0]
    assert k[1] == pytest.approx(2 / x[1], rel=1e-9)


def test_what_one_section_does_alone_is_softer_in_the_rubble_than_in_the_lattice():
    """The condition of the coupling's stability: eigenvalues of P^-1 G between 0 and 1."""
    sheet = build(load_scenario("scenarios/van_vliet_2018_floe_165m", ["sheet.nodes=[30,30]"])).sheet.sheet
    nodes = sheet.front[8:22] * sheet.grid.ny + np.arange(8, 22)
    together = sheet.answer(nodes)[0]
    alone = np.stack([sheet.answer(nodes[k : k + 1])[0][0] for k in range(len(nodes))])
    assert (alone > 0).all()
    assert (together > alone).all()


def test_heavy_rubble_lies_still_under_a_light_sheet():
    """The lift swung between 0 and 8 MN when the rubble knew the stiffness of single nodes for a part of the window."""
    scheduler = build(load_scenario("scenarios/van_vliet_2018_floe_165m", HEAVY))
    start = scheduler.rubble.forces_on_sheet().force[:, 2].sum()
    lifts = []
    while scheduler.t_ns < 2_000_000_000:
        scheduler.macro_step()
        lifts.append(scheduler.rubble.forces_on_sheet().force[:, 2].sum())
    assert start == pytest.approx(1500 * 160 * 9.81, rel=0.1)
    assert np.array(lifts) == pytest.approx(start, rel=0.1)
    assert scheduler.ledger.mass_error < 1e-14


def test_rubble_that_would_break_the_sheet_at_rest_is_refused():
    with pytest.raises(SimulationError, match=r"utilisation .*initial_volume"):
        build(
            load_scenario(
                "scenarios/van_vliet_2018_floe_165m",
                [*HEAVY, "ice.tensile_strength='200 kPa'", "ice.flexural_strength='200 kPa'"],
            )
        )
