"""Variants side by side: which ones, that their numbers do not depend on the pool, and that a failure stops nothing."""

import csv
import json
import os
import subprocess
import sys

import pytest

from cosim.errors import FailedError, InputError
from cosim.scenario.loading import read_scenario
from cosim.show.sweep_tables import show
from cosim.show.tornado import tornado
from cosim.study.design import Design
from cosim.study.pool import Processes
from cosim.study.sweep import row_of, sweep, with_ratios
from cosim.study.table import CsvTable
from cosim.study.task import Study, run_variant
from cosim.study.variants import Axis, Variant, parse_axis

CASE = "van_vliet_2018_floe_55m_centre"
TINY = ("sheet.nodes=[12, 12]", "scenario.duration='1 s'", "rubble.initial_volume='60 m^3'")


@pytest.mark.parametrize(
    ("text", "key", "values"),
    [
        ("contact.strength=200 kPa,2 MPa", "contact.strength", ("200 kPa", "2 MPa")),
        ("sheet.nodes=[40,40],[60,60]", "sheet.nodes", ("[40,40]", "[60,60]")),
        ("sheet.nodes=[40,40]", "sheet.nodes", ("[40,40]",)),
        ("scenario.title='a,b', 'c'", "scenario.title", ("'a,b'", "'c'")),
        ("ice.beam_test={length='1 m',width='2 m'},x", "ice.beam_test", ("{length='1 m',width='2 m'}", "x")),
    ],
)
def test_values_with_units_lists_and_quotes(text, key, values):
    assert parse_axis(text) == Axis(key, values)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("contact.strength", "not of the form"),
        ("strength=1", "not of the form"),
        ("a.b=1,,2", "an empty value"),
        ("a.b=1,2,1", "twice"),
        ("a.b=[1,2", "not closed"),
        ("a.b=", "an empty value"),
    ],
)
def test_a_wrong_axis_is_one_line(text, says):
    with pytest.raises(InputError, match=says) as error:
        parse_axis(text)
    assert "\n" not in str(error.value)


def fake(study, number, variant):
    """A task without solver; the value says what happens."""
    value = dict(variant.changes).get("a.x", "1")
    if value == "die":
        os._exit(9)
    if value == "fail":
        return {"error": "it failed"}
    return {f"{c}_peak": float(value) * k for k, c in enumerate(("fx", "fz", "f"), 1)}


def test_a_failure_and_a_dead_process_stop_nothing():
    seen = []
    chosen = Design().variants([Axis("a.x", ("2", "fail", "die", "3"))], 0)
    rows = sweep(None, chosen, Processes(2), lambda row: seen.append(row["variant"]), task=fake)
    assert [row.get("fx_peak") for row in rows] == [1.0, 2.0, None, None, 3.0]
    assert sorted(seen) == sorted(v.name for v in chosen)
    assert rows[2]["error"] == "it failed"
    assert "process died" in rows[3]["error"]
    assert rows[4]["error"] is None
    assert [row["fz_ratio"] for row in rows] == [1.0, 2.0, None, None, 3.0]


def test_ratios_are_to_the_base_with_the_same_seed_wherever_it_stands():
    def row(group, seed, peak):
        return {"group": group, "seed": seed, "fx_peak": peak, "error": None}

    rows = with_ratios([row("a", "1", 6.0), row("base", "2", 2.0), row("a", "2", 6.0), row("base", "1", 3.0)])
    assert [r["fx_ratio"] for r in rows] == [2.0, 1.0, 3.0, 1.0]
    rows = with_ratios([{"group": "base", "seed": None, "error": "no"}, row("a", None, 1.0)])
    assert rows[1]["fx_ratio"] is None


@pytest.fixture(scope="module")
def study():
    return Study(read_scenario(CASE), TINY)


@pytest.fixture(scope="module")
def content(study):
    """A sweep over two workers."""
    chosen = Design().variants([Axis("contact.strength", ("1 MPa",)), Axis("sheet.nodes", ("[14,14]", "[12,13]"))], 0)
    rows = sweep(study, chosen, Processes(2), lambda row: None)
    keys = ["contact.strength", "sheet.nodes"]
    return {"scenario": "s", "keys": keys, "failed": 1, "variants": rows, "ensembles": [], "indices": []}


def bare(row):
    return {k: v for k, v in row.items() if k != "wall_s"}


def test_numbers_do_not_depend_on_the_pool(content, study):
    """Two workers, one after the other in one process, and this process: the same bits but for the cost."""
    chosen = [Variant(), Variant((("contact.strength", "1 MPa"),))]
    one = sweep(study, chosen, Processes(1), lambda row: None)
    here = with_ratios([row_of(k, v, run_variant(study, k, v)) for k, v in enumerate(chosen)])
    for a, b, c in zip(content["variants"], one, here, strict=False):
        assert bare(a) == bare(b) == bare(c)
    assert one[1]["fx_ratio"] > 2.0


def test_the_table_holds_the_failed_variant_with_its_error(content, tmp_path):
    out = tmp_path / "t.csv"
    with CsvTable(out, content["keys"]) as table:
        for row in content["variants"]:
            table.add(row)
    with out.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["variant"] for row in rows] == [
        "base",
        "contact.strength = 1 MPa",
        "sheet.nodes = [14,14]",
        "sheet.nodes = [12,13]",
    ]
    assert "cells must be square" in rows[3]["error"]
    assert rows[3]["fx_peak"] == ""
    assert rows[0]["error"] == ""
    assert float(rows[1]["fx_peak"]) == content["variants"][1]["fx_peak"]
    assert float(rows[0]["breaking_fx_peak"]) > 0.0
    assert float(rows[0]["fx_mean"]) > 0.0


def test_the_tornado_is_drawn(content, tmp_path):
    out = tmp_path / "t.png"
    tornado(content, out)
    assert out.read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(FailedError, match="not drawn"):
        tornado({**content, "variants": content["variants"][:1]}, out)


def test_the_command_exits_with_1_and_prints_one_json_object(tmp_path):
    options = [part for item in (*TINY, "scenario.duration='0.1 s'") for part in ("--set", item)]
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "from cosim.cli import main; main()",
            "sweep",
            CASE,
            *options,
            "--vary",
            "rubble.friction_structure=0.2,-1",
            "--json",
            "-o",
            str(tmp_path / "t.csv"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    content = json.loads(done.stdout)
    assert content["failed"] == 1
    assert [row["error"] is None for row in content["variants"]] == [True, True, False]
    assert done.stderr.splitlines()[-1].startswith("cosim: 1 of 3 variants failed")
    assert (tmp_path / "t.csv").is_file()


def test_a_wrong_base_is_refused_before_anything_runs():
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "from cosim.cli import main; main()",
            "sweep",
            CASE,
            "--set",
            "ice.thicknes=1 m",
            "--vary",
            "a.b=1",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "did you mean" in done.stderr


def test_a_variant_that_is_not_trustworthy_is_pointed_out(content, monkeypatch):
    lines = []
    monkeypatch.setattr("cosim.show.sweep_tables.print_line", lines.append)
    why = [{"not_trustworthy": "it is at its end"}, {"not_trustworthy": ""}, {"not_trustworthy": ""}, {}]
    show({**content, "variants": [row | t for row, t in zip(content["variants"], why, strict=True)]})
    assert lines[0] == "not trustworthy: base: because it is at its end"
    assert [line.split(":")[0] for line in lines] == ["not trustworthy", "failed"]
