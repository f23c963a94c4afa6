"""The HTML page of a run: complete, self-contained, and right about the shares at the peak."""

import dataclasses
import json
import re

import numpy as np
import pytest

from cosim.analysis.peaks import shares_at_peak
from cosim.analysis.run_data import RunData
from cosim.recording.reader import read_run
from cosim.scenario.loading import load_scenario
from cosim.show.figures import ENERGY
from cosim.show.page.numbers import curve_data, statistics
from cosim.show.page.parameters import sources, told
from cosim.show.report import content, write_report
from cosim.simulation import run_scenario
from coupling.budget import NAMED, TERMS
from coupling.energy import STORES
from coupling.interface import Event

FLOODED = ("water_above", "water_left_below")  #: loads on the sheet

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
        "correction_loss",
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
    fz, fx = shown["budget"]["parts"]
    assert shown["budget"]["unit"] == "MN"
    assert fx["head"] == [
        "Fx [MN]",
        "peak of Fz\n0.05 s",
        "peak of Fx\n0.15 s",
        "before failure\n0.10 s",
        "mean\nall windows",
        "is",
    ]
    rows = {row[0]: row[1:] for row in fx["rows"]}
    assert rows["total"][1:3] == ("8.00", "3.00")
    assert rows["held"][1] == "8.00"
    assert dict((row[0], row[4]) for row in fz["rows"])["flooded rubble"] == "1.00"
    assert all(row[-1] != "" for part in (fz, fx) for row in part["rows"])  # every term is explained


def test_the_page_is_self_contained(run, tmp_path):
    out = tmp_path / "report.html"
    write_report(run, out)
    page = out.read_text("utf-8")
    assert page.count("data:image/svg+xml;base64,") == 3
    assert "http" not in page
    assert "A &lt;case&gt;" in page
    assert "it splits" in page


def test_a_page_tells_what_is_wrong_with_the_reference_in_the_recording(run, tmp_path):
    wrong = '[[feature]]\nname = "peak"\nquantity = "peek_load"\nunit = "N"\nsource = "a paper"'
    page = tmp_path / "page.html"
    write_report(dataclasses.replace(run, texts={"reference.toml": wrong}), page)
    text = page.read_text()
    assert "reference in the recording cannot be used:" in text
    assert "unknown quantity &#39;peek_load&#39;" in text
    assert text.count("<h2") >= 5
    write_report(run, page)
    assert "cannot be used" not in page.read_text()


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


@pytest.fixture(scope="module")
def whole_page(run_file, cosim_module, tmp_path_factory):
    """The page of a recording with pictures, as the command writes it."""
    out = tmp_path_factory.mktemp("page") / "r.html"
    cosim_module("report", run_file, "-o", out)
    return out.read_text("utf-8")


@pytest.fixture(scope="module")
def cosim_module():
    from cosim.cli import main

    def call(*arguments):
        with pytest.raises(SystemExit) as stop:
            main([str(a) for a in arguments])
        assert stop.value.code == 0

    return call


def test_the_page_shows_the_ice_and_stands_alone(whole_page):
    for anchor in ("asked", "answer", "ice", "curves", "statistics", "moments", "formulas", "events", "parameters"):
        assert f'id="{anchor}"' in whole_page, anchor
    assert whole_page.startswith("<!doctype html>")
    assert "http" not in whole_page.split("<h2 id=")[0]
    assert re.findall(r'(?:src|href)="(?!data:|#)', whole_page) == []
    assert "@media print" in whole_page
    titles = re.findall(r"<figcaption>(.*?)</figcaption>", whole_page)
    assert {"Load along the waterline, by place across the drift", "Load on the structure by phase"} <= set(titles)
    assert any("most load by breaking" in title.lower() for title in titles)


def test_parameters_have_their_sources(whole_page):
    rows = dict(
        re.findall(r'<td class="text">([\w.]+)</td><td class="text">(.*?)</td><td class="text quiet">', whole_page)
    )
    assert rows["ice.thickness"] == "3 m"
    assert rows["sheet.nodes"] == "[40, 40]"
    sources = dict(re.findall(r'<td class="text">([\w.]+)</td>.*?<td class="text quiet">(.*?)</td>', whole_page))
    assert "thesis" in sources["ice.thickness"]
    assert sources["sheet.nodes"] == "set by the user of this run"
    assert sources["rubble.added_mass"]


def test_curves_that_can_be_enlarged_hold_the_peak(run_file, whole_page):
    data = json.loads(re.search(r'id="data">(.*?)</script>', whole_page)[1])
    run = read_run(run_file)
    size = {"MN": 1e6, "kN": 1e3}[data["unit"]]
    for axis in ("fx", "fz"):
        peak = np.abs(run.lasting.component(axis)).max()
        assert max(map(abs, data["series"][axis]["total"])) * size == pytest.approx(peak, rel=1e-4)
        phases = np.array([data["series"][axis][p] for p in ("breaking", "rotating", "sliding")])
        assert phases.sum(axis=0) == pytest.approx(data["series"][axis]["total"], abs=1e-3)
    assert {e["kind"] for e in data["events"]} == {"split", "circumferential"}
    few = curve_data(run, most=20)
    assert len(few["t"]) == 20
    assert max(map(abs, few["series"]["fx"]["total"])) == max(map(abs, data["series"]["fx"]["total"]))


def test_comments_of_a_scenario_are_its_sources():
    text = '[ice]\nthickness = "3 m"  # Table 1\nnu = 0.3\n[ice.beam_test]\nlength = "1 m"  # a # b\n'
    text += "[ice]\nnu = 0.2 # late"
    assert dict(sources(text)) == {"ice.thickness": "Table 1", "ice.nu": "late", "ice.beam_test.length": "a # b"}


def test_statistics_are_those_of_the_means(run):
    found = statistics(run)
    assert found["head"][0] == "load [MN]"
    fx = next(row for row in found["rows"] if row[0] == "Fx")
    assert float(fx[1]) == pytest.approx(run.lasting.component("fx").mean() / 1e6, abs=0.01)
    assert float(fx[-1]) == pytest.approx(8.0)


def test_loads_that_press_down_have_quantiles_and_room_as_those_that_lift(run):
    """On a slope that looks up Fz < 0: shares of the time are those of its size, and its stacks are seen."""
    from matplotlib.figure import Figure

    from cosim.show import budget_figure

    down = dataclasses.replace(run, load=-run.load)
    for name, up, other in zip(("Fx", "Fy", "Fz"), statistics(run)["rows"], statistics(down)["rows"], strict=False):
        same = [float(text) for text in up[1:2] + up[3:]]
        assert [-float(text) for text in other[1:2] + other[3:]] == pytest.approx(same), name
    total, terms = np.array([-1.0, -4.0, -2.0]), np.array([[0.5, 0.4, 0.6], [-1.5, -4.4, -2.6]])
    for sign in (1.0, -1.0):
        ax = Figure().add_subplot()
        budget_figure._focus(ax, sign * terms, sign * total)
        assert sorted(np.abs(ax.get_ylim())) == pytest.approx([2.0, 4.6])
        assert ax.get_title(loc="right") == ""  # nothing ends outside


def test_terms_of_the_budget_are_told_apart_and_those_that_are_zero_are_not_named(run):
    from matplotlib.figure import Figure

    from cosim.show import budget_figure

    terms = {f"{axis}_{name}": np.zeros(4) for axis in ("fx", "fz") for name in (*TERMS, *FLOODED, "residual")}
    for name in ("inertia", *FLOODED):
        terms[f"fz_{name}"] += 1e5
    figure = Figure()
    budget_figure.draw(figure, dataclasses.replace(run, budget=terms))
    handles, names = figure.axes[0].get_legend_handles_labels()
    assert names == ["inertia", "water above", "water left below", "total"]
    assert len({tuple(patch.get_facecolor()[0]) for patch in handles[:3]}) == 3
    assert len(set(budget_figure.colours_of([*TERMS, *NAMED, *FLOODED]))) == len(TERMS) + len(NAMED) + 2


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("0.6108652381980153 rad", "35 deg"),
        (0.3333333333333333, "0.333333"),
        ("0.5 m", "0.5 m"),
        ([0.5, 1.5000000000000002], "[0.5, 1.5]"),
        (True, "true"),
        ("serial-explicit", "serial-explicit"),
    ],
)
def test_parameters_have_no_false_digits(value, text):
    assert told(value) == text
