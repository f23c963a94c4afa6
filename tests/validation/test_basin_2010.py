"""The basin campaign behind van Vliet (2018), chapter 6: one set of parameters for all floes, balances, loads."""

import numpy as np
import pytest

from cosim.build import build
from cosim.run import run_scenario
from cosim.scenario.loading import load_scenario

CASES = ["basin_2010_floe_165m", "basin_2010_floe_34x68m", "basin_2010_floe_55m_centre", "basin_2010_floe_55m_corner"]
COMMON = ("ice", "water", "structure", "contact", "drift", "fracture", "coupling")


class Loads:
    """Observer: load (3, 3) of every window."""

    def __init__(self):
        self.frames = []

    def on_start(self, info):
        pass

    def on_frame(self, frame):
        self.frames.append(frame)

    def on_close(self):
        pass


def run(case, *overrides):
    seen = Loads()
    return run_scenario(load_scenario(case, overrides), [seen]), seen.frames


def check_balances(result, frames):
    assert result.ledger["mass_error"] < 1e-12
    assert result.ledger["momentum_error"] < 1e-9
    assert result.ledger["angular_momentum_error"] < 1e-9
    assert result.ledger["energy_residual"] < 0.01
    for frame in frames:
        total = frame.load.sum(axis=0)
        assert frame.load[0] + frame.load[1] + frame.load[2] == pytest.approx(total, rel=1e-9)
        assert sum(v for k, v in frame.budget.items() if k.startswith("fz_")) == pytest.approx(total[2], abs=1e3)


def test_the_floes_differ_in_the_floe_alone():
    first, *others = [load_scenario(case) for case in CASES]
    for other in others:
        assert all(getattr(other, name) == getattr(first, name) for name in COMMON)
        assert other.rubble.model_copy(update={"initial_volume": first.rubble.initial_volume}) == first.rubble
        assert (other.sheet.back, other.sheet.sides) == (first.sheet.back, first.sheet.sides)


@pytest.mark.parametrize("case", CASES)
def test_every_value_of_the_campaign_has_its_source(case):
    for line in load_scenario(case).text.splitlines():
        if (
            "=" in line
            and not line.startswith("#")
            and line.split(" =")[0] not in ("title", "description", "base", "enabled")
        ):
            assert "#" in line, line


def test_a_coarse_floe_breaks_and_its_balances_close():
    result, frames = run("basin_2010_floe_34x68m", "sheet.nodes=[16,31]", "scenario.duration='30 s'")
    assert any(e.kind == "circumferential" for e in result.events)
    assert result.blocks > 0
    check_balances(result, frames)


@pytest.mark.slow
def test_the_floe_of_34_x_68_m_loads_the_cone_with_8_mn():
    """Section 6.5: about 8 MN. A halved window changes the mean by less than 2 % and the peak by less than 5 %."""
    (result, frames), (halved, _) = (
        run("basin_2010_floe_34x68m", "scenario.duration='60 s'", f"coupling.window='{w}'") for w in ("50 ms", "25 ms")
    )
    check_balances(result, frames)
    peak, again = (r.sustained()["peaks"]["fx"]["value"] for r in (result, halved))
    mean, mean_again = (np.mean([load.sum(axis=0)[0] for _, load in r.loads]) for r in (result, halved))
    assert peak == pytest.approx(8e6, rel=0.2)
    assert again == pytest.approx(peak, rel=0.05)
    assert mean_again == pytest.approx(mean, rel=0.02)


def deepest(layer):
    """Largest depth of a block in the structure [m]."""
    depth = 0.0
    for section in layer.sections.values():
        for block in section.blocks:
            block.shape.cache_bb()
            for hit in section.space.shape_query(block.shape):
                if hit.shape is not None and hit.shape.body is section.space.static_body:
                    depth = max([depth, *(-p.distance for p in hit.contact_point_set.points)])
    return depth


@pytest.mark.slow
def test_the_165_m_floe_with_its_rubble_runs_for_five_minutes():
    """Stable, with balances that close (a broken one stops the run), and no block in the structure beyond the slop."""
    scheduler = build(load_scenario("basin_2010_floe_165m"))
    slop, frames = scheduler.rubble.physics.slop, []
    while scheduler.t_ns < 300_000_000_000:
        frame = scheduler.macro_step()
        if scheduler.t_ns % 1_000_000_000 == 0:
            assert deepest(scheduler.rubble.layer) < slop
        frames.append(frame.load)
    load = np.array(frames).sum(axis=1)
    assert np.isfinite(load).all()
    assert np.abs(load).max() < 30e6
    assert 2e6 < load[:, 0].mean() < 10e6  # 2 to 10 MN between the peaks in the basin, section 6.3.1
    assert scheduler.ledger.mass_error < 1e-12
