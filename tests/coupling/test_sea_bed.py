"""A run over a sea bed: grounded rubble is a term of the budget, and nothing is lost on the bed."""

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.budget import force_budget

#: the campaign's floe on a coarse mesh, over a pile that reaches down to the bed
CASE = ["sheet.nodes=[26,26]", "rubble.initial_volume='800 m^3'", "water.depth='7 m'", "drift.velocity='0.5 m/s'"]


def test_only_who_has_a_bed_has_the_term():
    rubble = {"flooded_rubble": (0.0, 2.0), "sea_bed": (-1.0, 3.0)}
    found = force_budget(np.array([0.0, 0.0, 5.0]), {"drag": (1.0, 0.0)}, rubble)
    assert (found["fx_sea_bed"], found["fz_sea_bed"]) == (-1.0, 3.0)
    assert (found["fx_residual"], found["fz_residual"]) == (0.0, 0.0)
    assert "fz_sea_bed" not in force_budget(np.zeros(3), {"drag": (1.0, 0.0)})


@pytest.mark.slow
def test_drift_presses_a_pile_on_the_bed():
    """The budget closes as well as it does without a bed, and not without the term of the bed."""
    scheduler = build(load_scenario("basin_2010_floe_165m", CASE))
    frames = [scheduler.macro_step() for _ in range(60)]
    on_bed = np.array([f.budget["fz_sea_bed"] for f in frames])
    residual = np.array([f.budget["fz_residual"] for f in frames])
    assert on_bed.min() >= 0.0  # it pulls at nothing
    assert on_bed.max() > 1e5
    assert np.abs(residual).max() < 0.2 * on_bed.max()
    assert scheduler.ledger.mass_error < 1e-12
    assert scheduler.ledger.energy.relative < 1e-3
    assert scheduler.ledger.energy.terms["friction_bed_loss"] > 0.0
    assert frames[-1].load[:, 2].sum() > 0.0
