"""A run over a sea bed: grounded rubble is a term of the budget, and nothing is lost on the bed."""

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario

#: the campaign's floe on a coarse mesh, over a pile that stands on the bed
CASE = ["sheet.nodes=[26,26]", "rubble.initial_volume='800 m^3'", "water.depth='9 m'", "scenario.duration='1 s'"]


@pytest.fixture(scope="module")
def grounded():
    """Half a second of the drift."""
    scheduler = build(load_scenario("basin_2010_floe_165m", CASE))
    return scheduler, [scheduler.macro_step() for _ in range(10)]


def test_the_bed_is_a_term_of_the_budget(grounded):
    """All terms with it make the load to rounding; a twin without it misses it by what the bed carries."""
    _, frames = grounded
    for f in frames:
        on_bed = f.budget["fz_sea_bed"]
        scale = max(abs(f.budget["fz_flooded_rubble"]), on_bed)
        assert abs(f.budget["fx_residual"]) < 1e-9 * scale
        assert abs(f.budget["fz_residual"]) < 1e-9 * scale
    assert max(f.budget["fz_sea_bed"] for f in frames) > 1e4
    assert min(f.budget["fz_sea_bed"] for f in frames) >= 0.0  # it pulls at nothing


def test_the_force_on_the_bed_is_no_load_on_the_structure(grounded):
    scheduler, frames = grounded
    load = frames[-1].load.sum(axis=0)
    blocks = scheduler.rubble.blocks().load.sum(axis=0)
    np.testing.assert_allclose(scheduler.rubble.load().sum(axis=0), blocks, rtol=1e-12)
    assert np.isfinite(load).all()


def test_nothing_is_lost_on_the_bed(grounded):
    scheduler, _ = grounded
    assert scheduler.rubble.cleared_mass == 0.0
    assert scheduler.ledger.mass_error < 1e-12
    assert scheduler.ledger.energy.relative < 1e-3
    assert scheduler.ledger.energy.terms["friction_bed_loss"] >= 0.0


def test_deep_water_has_no_such_term():
    scheduler = build(load_scenario("basin_2010_floe_165m", ["sheet.nodes=[12,12]", "scenario.duration='1 s'"]))
    assert "fz_sea_bed" not in scheduler.macro_step().budget
