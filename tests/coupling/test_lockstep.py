"""Sheet and rubble in lockstep: what one gives the other takes, at once, and rest is rest."""

from __future__ import annotations

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.sheet_port.meeting import Meeting

#: the campaign's floe on a coarse mesh, with a pile under it; without the water's inertia nodes give way most easily
CASE = ["sheet.nodes=[26,26]", "rubble.initial_volume='800 m^3'", "scenario.duration='1 s'", "water.added_mass=0"]


def run(seconds, *overrides):
    """Frames of so many seconds, and the scheduler."""
    scheduler = build(load_scenario("basin_2010_floe_165m", [*CASE, *overrides]))
    frames = [scheduler.macro_step() for _ in range(round(seconds / 0.05))]
    return scheduler, frames


def drift(s):
    return abs(s.ledger.energy.terms["drift_work"])


@pytest.fixture(scope="module")
def pressed():
    """Two seconds of the drift."""
    return run(2.0)


def test_forces_are_taken_in_the_window_in_which_they_are_given(pressed):
    """Staggering, the force that the sheet had less the one that the rubble gave, is rounding."""
    _, frames = pressed
    for f in frames:
        given = np.array([f.budget[f"{axis}_flooded_rubble"] for axis in ("fx", "fz")])
        assert abs(f.budget["fx_staggering"]) < 1e-9 * max(np.abs(given).max(), 1e3)
        assert abs(f.budget["fz_staggering"]) < 1e-9 * max(np.abs(given).max(), 1e3)


def test_power_that_is_given_is_taken(pressed):
    """Power that the rubble believes to give less what the sheet receives, against the work of the drift."""
    s, _ = pressed
    assert abs(s.power.loss) < 0.15 * drift(s)
    assert s.ledger.energy.relative < 1e-4
    assert s.ledger.energy.terms["interface_loss"] == 0.0


def test_an_impact_is_what_is_given_less_what_is_received(pressed):
    """Nothing that the sheet is pressed by makes energy, and the rubble's own account differs by the interface."""
    s, _ = pressed
    terms = s.ledger.energy.terms
    assert terms["impact_sheet_loss"] > -1e-2 * drift(s)
    assert terms["friction_sheet_loss"] >= 0.0


def test_without_what_the_lattice_does_in_a_sub_step_the_sheet_creeps_into_the_pile(monkeypatch, pressed):
    """Twin: nodes that know their velocity alone; what presses on the edge then moves it in every sub-step.

    What the rubble gives then is more than what the sheet receives, and the pile has less of it.
    """
    usual = Meeting.nodes

    def twin(self, nodes):
        out = usual(self, nodes)
        out[:, 5:8] = 0.0
        return out

    monkeypatch.setattr(Meeting, "nodes", twin)
    creeping, _ = run(2.0)
    right, wrong = (s.ledger.energy.terms for s in (pressed[0], creeping))
    assert wrong["impact_sheet_loss"] > 3.0 * abs(right["impact_sheet_loss"])
    assert wrong["rubble_potential"] < 0.9 * right["rubble_potential"]


def test_a_lockstep_needs_the_explicit_engine():
    from cosim.scenario.errors import InputError

    with pytest.raises(InputError, match=r"lockstep needs fracture\.cracks"):
        load_scenario("first_cone", ["coupling.scheme=lockstep"])
