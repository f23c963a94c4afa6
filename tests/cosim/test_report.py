"""The HTML page of a run: complete, self-contained, and right about the shares at the peak."""

import dataclasses

import numpy as np
import pytest

from cosim.analysis.peaks import shares_at_peak
from cosim.analysis.run_data import RunData
from cosim.scenario.loading import load_scenario
from cosim.show.figures import ENERGY
from cosim.show.report import content, write_report
from cosim.simulation import run_scenario
from coupling.budget import TERMS
from coupling.energy import STORES
from coupling.interface import Event

METADATA = {
    "averaging_s": "0",
    "scenario": "case",
    "title": "A <case>",
    "version": "1",
    "seed": "0",
    "duration_ns": "200000000",
    "window_ns": "50000000",
    "overrides": "[]",
}


@pytest.fixture
def run():
    load = np.zeros((4, 3, 3))
    load[:, 0, 0], load[:, 1, 0], load[:, 2, 2] = [1e6, 2e6, 6e6, 0.0], [0.0, 1e6, 2e6, 3e6], 1e6
    names = (
        "sheet_mass",
        "rubble_mass",
        "crushed_mass",
        "cleared_mass",
        "drift_work",
        "energy_residual",
        "sheet_elastic",
        "sheet_foundation",
        "sheet_kinetic",
        "damping_loss",
        "scheme_loss",
        "fracture_loss",
        "contact_crushing_loss",
        "side_push_loss",
    )
    event = Event(120_000_000, "split", (5e6, 0.0, 4e6), 3, (0.0, 0.0, 0.0), "it splits")
    return RunData(
        "run.mcap",
        METADATA,
        50_000_000 * np.arange(1, 5),
        load,
        (event,),
        {n: np.linspace(0.0, 1e5, 4) for n in names},
        {"scenario.toml": "[scenario]"},
    )


def test_shares_at_the_peak_add_up(run):
    found = shares_at_peak(run)
    fx, fz = found["fx"], found["fz"]
    assert fx["time"] == pytest.approx(0.15)
    assert fx["value"] == pytest.approx(8e6)
    assert (fx["phases"]["breaking"], fx["shares"]["breaking"]) == pytest.approx((6e6, 0.75))
    assert fz["shares"]["sliding"] == pytest.approx(1.0)
    for row in found.values():
        assert sum(row["shares"].values()) == pytest.approx(1.0, rel=1e-12)
        assert sum(row["phases"].values()) == pytest.approx(row["value"], rel=1e-12)


def test_shares_of_the_resultant_lie_along_it(run):
    f = shares_at_peak(run)["f"]
    assert f["value"] == pytest.approx(np.hypot(8e6, 1e6), rel=1e-12)
    assert f["phases"]["breaking"] == pytest.approx(6e6 * 8.0 / np.hypot(8.0, 1.0), rel=1e-12)


def test_the_budget_stands_at_the_peaks_before_a_failure_and_in_a_figure(run):
    terms = {f"{axis}_{name}": np.zeros(4) for axis in ("fx", "fz") for name in (*TERMS, "residual")}
    terms["fz_flooded_rubble"] += 1e6
    terms["fx_held"] += run.component("fx") - 8.0
    terms["fx_residual"] += 8.0
    broken = Event(120_000_000, "circumferential", (5e6, 0.0, 4e6), 3, (0.0, 0.0, 0.0), "", 12.0, 100.0)
    shown = content(dataclasses.replace(run, budget=terms, events=(broken, broken)))
    assert len(shown["figures"]) == 4
    assert shown["bound"]["fx"] == pytest.approx(1e-6)
    table = {(r["when"], r["component"]): r for r in shown["budget"]}
    assert len(table) == len(shown["budget"]) == 8  # two peaks, one failure, the mean; each with Fx and Fz
    assert table["peak of Fx", "Fx"]["terms"]["held"] == pytest.approx(8e6, abs=10.0)
    assert table["before failure", "Fx"]["time"] == "0.10"
    assert table["before failure", "Fx"]["total"] == pytest.approx(3e6)
    assert table["mean", "Fz"]["terms"]["flooded rubble"] == pytest.approx(1e6)


def test_the_page_is_self_contained(run, tmp_path):
    out = tmp_path / "report.html"
    write_report(run, out)
    page = out.read_text("utf-8")
    assert page.count("data:image/png;base64,") == 3
    assert "http" not in page
    assert "A &lt;case&gt;" in page
    assert "it splits" in page


def test_every_term_of_the_energy_has_its_place_in_the_figure():
    """All terms that a run can have, once each: the stack then ends at the work of the drift."""
    drawn = [name for _, names in ENERGY.values() for name in names]
    run = run_scenario(
        load_scenario("van_vliet_2018_floe_55m_centre", ["sheet.nodes=[20, 20]", "scenario.duration='1 s'"])
    )
    terms = {n for n in run.ledger if n in STORES or n.endswith("_loss")}
    assert set(drawn) == terms
    assert len(drawn) == len(terms)


def test_a_run_without_energy_books_has_no_energy_figure(run):
    without = RunData(
        run.name,
        run.metadata,
        run.t_ns,
        run.load,
        run.events,
        {k: v for k, v in run.ledger.items() if k.endswith("mass")},
        run.texts,
    )
    assert [f["title"] for f in content(without)["figures"]] == [
        "Load on the structure by phase",
        "Ice that has left the sheet",
    ]
