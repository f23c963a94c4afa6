"""Tops of the sheet that flood in whole runs: balances close, windows are repeated, cases of the thesis stay dry."""

from copy import copy

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.build_rubble import filling_rate
from cosim.scenario.loading import load_scenario
from coupling.budget import TERMS
from lattice.tops import ABOVE, BELOW, NAMES

CASE = "van_vliet_2018_floe_55m_centre"
QUICK = ("sheet.nodes=[20, 20]", "drift.velocity='0.4 m/s'", "contact.strength='800 kPa'", "water.tops='flood'")


def case(*overrides):
    return build(load_scenario(CASE, [*QUICK, *overrides]))


@pytest.mark.parametrize("propagation", ["quasi-static", "dynamic"])
def test_energy_and_forces_of_a_run_close_with_tops_under_water(propagation):
    """The twin whose water is not in the balance is off."""
    with threadpool_limits(1):
        s = case(f"fracture.propagation='{propagation}'")
        frames = [s.macro_step() for _ in range(100)]
    wet = np.array([f.budget["fz_water_above"] for f in frames])
    assert wet.min() < -5e4
    residual = np.array([f.budget["fz_residual"] for f in frames])
    load = np.array([f.load[:, 2].sum() for f in frames])
    solved = wet < 0.0  # others may be read off long steps
    assert solved.sum() > 30
    assert np.abs(residual[solved]).max() < (1e-9 if propagation == "quasi-static" else 0.02) * np.abs(load).max()
    sums = [sum(f.budget[f"fz_{name}"] for name in (*TERMS, *NAMES, "residual")) for f in frames]
    np.testing.assert_allclose(sums, load, atol=1e-6 * np.abs(load).max())
    assert s.ledger.energy.relative < 1e-4
    books = s.ledger.energy
    assert abs(books.residual - books.terms["water_above_load_work"]) > 10.0 * abs(books.residual)


@pytest.mark.parametrize("scheme", ["serial-explicit", "serial-implicit"])
def test_windows_with_tops_under_water_are_repeated_bit_by_bit(scheme):
    with threadpool_limits(1):
        s = case(f"coupling.scheme='{scheme}'", "coupling.unconverged='count'")
        while s.macro_step().budget["fz_water_above"] > -5e4:
            pass
        saved, jump, power, t_ns = s.save(), s.jump, copy(s.power), s.t_ns
        assert 0.0 < s.sheet.sheet.tops.flooded.max() < 1.0
        runs = []
        for twin in (0.0, 0.0, 1e-12):
            saved()
            s.t_ns, s.jump, s.power = t_ns, jump, copy(power)
            tops = s.sheet.sheet.tops
            tops.flooded = tops.flooded + twin * (tops.flooded > 0.0)
            frames = [s.macro_step() for _ in range(6)]
            runs.append(b"".join(f.sheet.position.tobytes() + f.load.tobytes() for f in frames))
    assert runs[0] == runs[1]
    assert runs[0] != runs[2]  # a difference would be noticed


def test_a_piece_takes_along_what_its_top_carries():
    with threadpool_limits(1):
        s = case("drift.velocity='0.3 m/s'")
        left = []
        add = s.rubble.add
        s.rubble.add = lambda fragment: (left.append(fragment), add(fragment))[1]
        while not left:
            s.macro_step()
        s.macro_step()
    parts = np.concatenate([f.flooded for f in left])
    assert parts.max() > 0.0
    assert max(b.flooded for b in s.rubble.layer.blocks) > 0.0


def test_a_linear_foundation_is_asked_for():
    thesis, flooding = load_scenario(CASE), load_scenario(CASE, ["water.tops='flood'"])
    assert thesis.water.tops == "dry"
    assert load_scenario("basin_2010_floe_34x68m").water.tops == "flood"
    assert filling_rate(flooding) == pytest.approx(0.2)
    rates = [filling_rate(load_scenario(CASE, [f"rubble.backfill='{b}'"])) for b in ("full", "none")]
    assert rates == [np.inf, 0.0]
    with threadpool_limits(1):
        dry = build(thesis)
        frame = dry.macro_step()
    assert dry.sheet.sheet.tops is None
    assert not any(ABOVE in name or BELOW in name for name in (*frame.budget, *frame.ledger))
