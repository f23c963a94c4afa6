"""The energy of the whole system: its terms, its limit, and wrong signs that it must find."""

import re

import numpy as np
import pytest

from coupling.contact_friction import friction_part
from coupling.energy import LIMIT, STORES, EnergyBalance, residual_of
from coupling.interface import SimulationError
from coupling.structure import cone, plane_slope

SHEET = {
    "drift_work": 0.0,
    "received_work": 0.0,
    "sheet_elastic": 0.0,
    "sheet_foundation": 0.0,
    "sheet_kinetic": 50.0,
    "left_elastic": 0.0,
    "left_foundation": 0.0,
    "left_kinetic": 0.0,
    "damping_loss": 0.0,
}
RUBBLE = {
    "sheet_work": 0.0,
    "rubble_kinetic": 7.0,
    "rubble_potential": 0.0,
    "born_kinetic": 0.0,
    "born_potential": 0.0,
    "drag_loss": 3.0,
}


def closed(**wrong):
    """Books of a window that close, but for what is said."""
    sheet = {
        **SHEET,
        "drift_work": 1000.0,
        "received_work": -200.0,
        "sheet_elastic": 300.0,
        "damping_loss": 250.0,
        "left_elastic": 40.0,
        "left_kinetic": 60.0,
        "sheet_kinetic": 50.0 - 60.0 + 210.0,
    }
    rubble = {
        **RUBBLE,
        "born_kinetic": 55.0,
        "rubble_kinetic": 7.0 + 155.0,
        "drag_loss": 3.0 + 40.0,
        "sheet_work": -140.0,
    }
    return {k: wrong.get(k, v) for k, v in sheet.items()}, {k: wrong.get(k, v) for k, v in rubble.items()}


def opened():
    balance = EnergyBalance()
    balance.open(SHEET, RUBBLE)
    return balance


def test_the_terms_are_changes_since_the_start_and_close():
    balance = opened()
    books = balance.close(50, *closed())
    assert books["sheet_kinetic"] == 150.0
    assert books["interface_loss"] == 60.0
    assert books["handover_kinetic_loss"] == 5.0
    assert books["energy_residual"] == pytest.approx(0.0, abs=1e-9)
    assert balance.floor == 50.0


@pytest.mark.parametrize("name", [n for n, v in {**closed()[0], **closed()[1]}.items() if v != {**SHEET, **RUBBLE}[n]])
def test_a_term_with_the_wrong_sign_stops_the_run(name):
    start, now = {**SHEET, **RUBBLE}[name], {**closed()[0], **closed()[1]}[name]
    with pytest.raises(SimulationError, match="energy balance is off"):
        opened().close(50, *closed(**{name: 2.0 * start - now}))


def test_the_message_names_the_largest_term_the_window_and_the_size():
    balance = opened()
    balance.close(50_000_000, *closed())
    with pytest.raises(SimulationError) as error:
        balance.close(100_000_000, *closed(drag_loss=543.0))
    assert re.search(
        r"t = 0\.100 s.*off by -500 J, 50\.00%.*allowed 1%.*largest change in it: drag_loss \+500 J", str(error.value)
    )


def test_below_the_limit_a_run_goes_on_and_early_the_floor_counts():
    balance = opened()
    balance.close(50, *closed(drag_loss=43.0 + 0.9 * LIMIT * 1000.0))
    assert balance.relative == pytest.approx(0.9 * LIMIT)
    early = opened()
    early.close(50, {**SHEET, "drift_work": 0.1, "damping_loss": 0.5}, RUBBLE)
    assert early.relative == pytest.approx(0.4 / 50.0)


def test_nothing_is_left_over_by_definition():
    """Each term moves the residual by itself."""
    terms = dict.fromkeys([*STORES, "drift_work", "thrust_work", "any_loss"], 0.0)
    for name in terms:
        assert residual_of({**terms, name: 1.0}) == (1.0 if name.endswith("work") else -1.0)


@pytest.mark.parametrize(
    "structure",
    [
        plane_slope(np.radians(50.0), top=5.0, toe_depth=20.0),
        cone(np.radians(45.0), 15.0, 9.0, top=5.0, toe_depth=20.0),
    ],
)
def test_friction_of_a_contact_is_told_from_its_normal_force(structure):
    mu, normal = 0.2, np.array([*(3.0, -4.0), 0.0]) / 5.0
    n = structure.normal(np.array([0.0]), np.array([0.5]))[0]
    n = np.append(np.hypot(n[0], n[1]) * normal[:2], n[2])
    up = (np.array([0.0, 0.0, 1.0]) - n[2] * n) / np.sqrt(1.0 - n[2] ** 2)
    force = 1e5 * (n + mu * up)
    part = friction_part(structure, mu, 1.0, 0.5, np.zeros((1, 3)), force[None])[0]
    np.testing.assert_allclose(part, 1e5 * mu * up, rtol=1e-10)
    assert abs(part @ n) < 1e-6
