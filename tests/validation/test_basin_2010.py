"""The basin campaign behind van Vliet (2018), chapter 6: one set of parameters for all floes, balances, loads."""

import numpy as np
import pytest

from cosim.build import build
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario
from coupling.budget import AXES, TERMS
from coupling.energy import LOAD_WORK, SOURCES, STORES, residual_of
from lattice.tops import NAMES
from rubble.round import depth_at

CASES = ["basin_2010_floe_165m", "basin_2010_floe_34x68m", "basin_2010_floe_55m_centre", "basin_2010_floe_55m_corner"]
PARTS = ("sheet", "rubble", "crushed", "cleared")
COMMON = ("ice", "water", "structure", "contact", "drift", "fracture", "coupling")


#: shares that are measured: a run stops itself at 1e-12 of the mass, 1e-9 of a momentum and 1e-2 of the energy
MASS, MOMENTUM, ENERGY = 1e-14, 1e-12, 1e-4
#: residual of the force budget of a window: exact to rounding in steps of the implicit engine; the explicit one sees
#: water and weight every 5 ms (measured: 0.3 % along x and z, 0.1 % along z at 2 ms)
OPEN, CLOSING = {"fx": 1e-9, "fz": 1e-9}, {"fx": 5e-3, "fz": 5e-3}
#: implicit engine, cells that carry nothing when they have failed
OPEN_CRACKS = (
    "fracture.cracks='open'",
    "water.tops='dry'",
    "fracture.longest_step='50 ms'",
    "ice.tensile_strength='967 kPa'",
    "ice.flexural_strength='967 kPa'",
)


class Seen:
    """Observer: load, budget and balances of every window."""

    def __init__(self):
        self.load, self.budget, self.ledger = [], [], []

    def on_start(self, info):
        pass

    def on_frame(self, frame):
        self.load.append(frame.load.sum(axis=0))
        self.budget.append(frame.budget)
        self.ledger.append(frame.ledger)

    def on_close(self):
        pass


def run(case, *overrides):
    seen = Seen()
    return run_scenario(load_scenario(case, overrides), [seen]), seen


def ice_is_kept(ledger, initial):
    """Sheet, rubble, crushed and cleared ice are what was there [kg]."""
    return abs(sum(ledger[f"{part}_mass"] for part in PARTS) - initial) < MASS * initial


def energy_is_kept(terms):
    """What the drift puts in is stored or lost [J]."""
    return abs(residual_of(terms)) < ENERGY * terms["drift_work"]


def budget_is_kept(loads, budgets, axis, force, flipped=None):
    """The terms that carry the load, each formed on its own, sum to what the contacts exert, in every window [N]."""
    load = np.array(loads)[:, {"fx": 0, "fz": 2}[axis]]
    terms = {name: np.array([b[f"{axis}_{name}"] for b in budgets]) for name in carriers(budgets[-1])}
    total = sum(-term if name == flipped else term for name, term in terms.items())
    return np.abs(total - load).max() < force[axis] * np.abs(load).max()


def carriers(budget):
    """Terms of every run, then those of the water on flooded tops where they flood, and of water that flows."""
    return (*TERMS, *(name for name in (*NAMES, "current") if f"fz_{name}" in budget))


def check_balances(ledger, seen, initial, force=CLOSING):
    """Mass, momentum of each hand-over, energy and force close; with the sign of a large term turned they do not."""
    assert all(ice_is_kept(window, initial) for window in seen.ledger)
    assert not ice_is_kept({**seen.ledger[-1], "crushed_mass": -seen.ledger[-1]["crushed_mass"]}, initial)
    assert max(ledger["momentum_error"], ledger["angular_momentum_error"]) < MOMENTUM
    terms = {n: v for n, v in seen.ledger[-1].items() if n in (*STORES, *SOURCES) or n.endswith(("_loss", LOAD_WORK))}
    assert energy_is_kept(terms)
    large = [name for name, value in terms.items() if abs(value) > 5.0 * ENERGY * terms["drift_work"]]
    assert len(large) >= 15
    assert not [name for name in large if energy_is_kept({**terms, name: -terms[name]})]
    for axis in AXES:
        assert budget_is_kept(seen.load, seen.budget, axis, force)
        largest = np.abs(seen.load).max(axis=0)[{"fx": 0, "fz": 2}[axis]]
        least = max(1e3, 2.0 * force[axis] * largest)
        at_work = [
            name for name in carriers(seen.budget[-1]) if max(abs(b[f"{axis}_{name}"]) for b in seen.budget) > least
        ]
        assert len(at_work) >= 2
        assert not [name for name in at_work if budget_is_kept(seen.load, seen.budget, axis, force, flipped=name)]


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
    result, seen = run("basin_2010_floe_34x68m", "sheet.nodes=[16,31]", "scenario.duration='33 s'")
    assert any(e.kind == "circumferential" for e in result.events)
    assert result.blocks > 0
    check_balances(result.ledger, seen, result.ledger["initial_mass"])


def test_with_open_cracks_the_forces_close_to_rounding():
    overrides = ("sheet.nodes=[16,31]", "scenario.duration='30 s'", *OPEN_CRACKS)
    result, seen = run("basin_2010_floe_34x68m", *overrides)
    assert any(e.kind == "circumferential" for e in result.events)
    check_balances(result.ledger, seen, result.ledger["initial_mass"], OPEN)


@pytest.fixture(scope="module")
def halved():
    """60 s of the 34 m x 68 m floe with open cracks in windows of 50 and of 25 ms; what the first one saw."""
    (result, seen), (again, _) = (
        run("basin_2010_floe_34x68m", "scenario.duration='60 s'", f"coupling.window='{w}'", *OPEN_CRACKS)
        for w in ("50 ms", "25 ms")
    )
    return result, again, seen


def mean_fx(result, until):
    """Mean load along the drift until a time [s]."""
    return np.mean([load.sum(axis=0)[0] for t, load in result.loads if t <= until * 1e9])


@pytest.mark.slow
def test_with_open_cracks_the_floe_of_34_x_68_m_loads_the_cone_with_8_mn(halved):
    """Section 6.5: about 8 MN. Half the window moves the peak by less than 5 %, the mean of the first 20 s by 2 %."""
    result, again, seen = halved
    check_balances(result.ledger, seen, result.ledger["initial_mass"], OPEN)
    peak, peak_again = (r.to_json()["peaks"]["fx"]["value"] for r in (result, again))
    assert peak == pytest.approx(8e6, rel=0.2)
    assert peak_again == pytest.approx(peak, rel=0.05)
    assert mean_fx(again, 20.0) == pytest.approx(mean_fx(result, 20.0), rel=0.02)


@pytest.mark.slow
@pytest.mark.xfail(strict=True, reason="steps of 50 ms damp the waves of a break, which split the floe 0.19 s later")
def test_with_open_cracks_half_the_window_moves_the_mean_of_a_minute_by_less_than_2_percent(halved):
    """By -8.5 %; in ice of 2.96 to 3.04 m by -8.5 to 8.4 %, by -4.4 % on average; until 20 s by 0.3 %.

    Windows of 25 and of 10 ms have both splits, 0.19 s after the breaks at 22.9 and 24.8 s.
    """
    result, again, _ = halved
    assert mean_fx(again, 60.0) == pytest.approx(mean_fx(result, 60.0), rel=0.02)


@pytest.mark.slow
def test_cells_that_have_come_loose_take_no_energy_from_the_cone():
    """Cells of 0.38 h swing at the edge from 17 s on; with the force at the start of a sub-step they gain 1.3 MJ."""
    result, seen = run("basin_2010_floe_34x68m", "scenario.duration='40 s'")
    crushing = np.array([window["contact_crushing_loss"] for window in seen.ledger])
    assert crushing[-1] > 0.5e6
    assert (np.maximum.accumulate(crushing) - crushing).max() < 0.01 * result.ledger["drift_work"]


def deepest(layer):
    """Largest depth of a corner of a piece in the cone [m]."""
    x, y, z = layer.corners.T
    return max((depth_at(layer.runner.body, *at)[0] for at in zip(np.hypot(x, y), z, strict=True)), default=0.0)


@pytest.mark.slow
def test_the_first_encounter_of_the_165_m_floe_with_cracks_that_close():
    """Section 6.3: 19 MN (x), 17.5 MN (z), 10 to 18 s after touch. At least 14 and 11.5 MN after 8 to 14 s."""
    result, _ = run("basin_2010_floe_165m", "scenario.duration='16 s'")
    peaks = result.to_json()["peaks"]
    assert 14e6 < peaks["fx"]["value"] < 1.1 * 19e6
    assert 11.5e6 < peaks["fz"]["value"] < 1.1 * 17.5e6
    assert 8.0 < peaks["fx"]["time"] < 14.0
    after = [load.sum(axis=0)[0] for t, load in result.loads if 0 < t / 1e9 - peaks["fx"]["time"] < 4.0]
    assert np.mean(after) > 0.5 * peaks["fx"]["value"]  # it does not fall to zero
    assert abs(result.ledger["energy_residual"]) < ENERGY


@pytest.fixture(scope="module")
def five_minutes():
    """300 s of the 165 m floe with open cracks: the scheduler, what was seen, the deepest corner each second [m]."""
    scheduler, seen, depth = build(load_scenario("basin_2010_floe_165m", OPEN_CRACKS)), Seen(), []
    while scheduler.t_ns < 300_000_000_000:
        seen.on_frame(scheduler.macro_step())
        if scheduler.t_ns % 1_000_000_000 == 0:
            depth.append(deepest(scheduler.rubble.layer))
    return scheduler, seen, np.array(depth)


@pytest.mark.slow
def test_with_open_cracks_the_165_m_floe_with_its_rubble_runs_for_five_minutes(five_minutes):
    """Balances close, and no corner of a piece stands deeper in the cone than a hundredth of the thickness."""
    scheduler, seen, depth = five_minutes
    assert depth.max() < 0.01 * scheduler.rubble.physics.thickness
    assert 2e6 < np.mean(seen.load, axis=0)[0] < 10e6  # 2 to 10 MN between the peaks in the basin, section 6.3.1
    ledger = scheduler.ledger
    errors = {"momentum_error": ledger.momentum_error, "angular_momentum_error": ledger.angular_momentum_error}
    check_balances(errors, seen, ledger.initial_mass, OPEN)


@pytest.mark.slow
@pytest.mark.xfail(
    strict=True, reason="two pieces stand on end between the sheet and the shaft under the cone and crush"
)
def test_with_open_cracks_no_window_carries_more_than_the_basin_ever_saw(five_minutes):
    """24 MN in the basin; 39 MN here. The pieces were seen in the build before: 35 MN, above 12 MN for 14 s."""
    _, seen, _ = five_minutes
    assert np.abs(seen.load).max() < 30e6


@pytest.mark.parametrize("propagation", ["quasi-static", "dynamic"])
def test_what_a_contact_brings_to_held_nodes_is_not_lost(propagation):
    """A plane as wide as the sheet presses on the corners of its held sides too, which pass the force on at once."""
    sheet = (
        "sheet.sides='held'",
        "sheet.nodes=[31, 3]",
        f"fracture.propagation='{propagation}'",
        "fracture.cracks='open'",
    )
    result, seen = run("upward_plane", *sheet, "scenario.duration='0.5 s'")
    push = max(abs(load[0]) for load in seen.load)
    assert push > 0.0
    assert result.ledger["energy_residual"] < 1e-6
    residual = np.array([b["fx_residual"] for b in seen.budget])
    assert np.abs(residual).max() < (1e-6 if propagation == "quasi-static" else 1e-3) * push
