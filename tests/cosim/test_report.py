"""The HTML page of a run: complete, self-contained, and right about the shares at the peak."""

import numpy as np
import pytest

from cosim.report import content, shares_at_peak, write_report
from cosim.run_data import RunData
from coupling.interface import Event

METADATA = {"scenario": "case", "title": "A <case>", "version": "1", "seed": "0", "duration_ns": "200000000",
            "window_ns": "50000000", "overrides": "[]"}


@pytest.fixture
def run():
    load = np.zeros((4, 3, 3))
    load[:, 0, 0], load[:, 1, 0], load[:, 2, 2] = [1e6, 2e6, 6e6, 0.0], [0.0, 1e6, 2e6, 3e6], 1e6
    names = ("sheet_mass", "rubble_mass", "crushed_mass", "cleared_mass", "contact_work", "rubble_work",
             "elastic_energy", "foundation_energy", "kinetic_energy", "damping_loss", "scheme_loss", "fracture_loss",
             "handed_over_energy")
    event = Event(120_000_000, "split", (5e6, 0.0, 4e6), 3, (0.0, 0.0, 0.0), "it splits")
    return RunData("run.mcap", METADATA, 50_000_000 * np.arange(1, 5), load, (event,),
                   {n: np.linspace(0.0, 1e5, 4) for n in names}, {"scenario.toml": "[scenario]"})


def test_shares_at_the_peak_add_up(run):
    fx, fz = shares_at_peak(run)
    assert fx["time"] == pytest.approx(0.15)
    assert fx["peak"] == pytest.approx(8.0)
    assert fx["phases"]["breaking"] == pytest.approx((6.0, 0.75))
    assert sum(share for _, share in fx["phases"].values()) == pytest.approx(1.0)
    assert fz["phases"]["sliding"][1] == pytest.approx(1.0)


def test_the_page_is_self_contained(run, tmp_path):
    out = tmp_path / "report.html"
    write_report(run, out)
    page = out.read_text("utf-8")
    assert page.count("data:image/png;base64,") == 3
    assert "http" not in page
    assert "A &lt;case&gt;" in page
    assert "it splits" in page


def test_a_run_without_energy_books_has_no_energy_figure(run):
    without = RunData(run.name, run.metadata, run.t_ns, run.load, run.events,
                      {k: v for k, v in run.ledger.items() if k.endswith("mass")}, run.texts)
    assert [f["title"] for f in content(without)["figures"]] == ["Load on the structure by phase",
                                                                 "Ice that has left the sheet"]
