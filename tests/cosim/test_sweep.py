"""Variants side by side: which ones, that their numbers do not depend on the pool, and that a failure stops nothing."""

import csv
import json
import os
import subprocess
import sys

import pytest

from cosim.errors import FailedError, InputError
from cosim.show.tornado import tornado
from cosim.study import sweep as sweeping
from cosim.study.command import show
from cosim.study.sweep import sweep, with_ratios
from cosim.study.table import Table
from cosim.study.variants import Axis, Variant, parse_axis, variants

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


def test_one_at_a_time_and_grid():
    axes = [Axis("a.x", ("1", "2")), Axis("b.y", ("3",))]
    assert [v.name for v in variants(axes, grid=False)] == ["base", "a.x = 1", "a.x = 2", "b.y = 3"]
    assert [v.overrides for v in variants(axes, grid=True)] == [(), ("a.x=1", "b.y=3"), ("a.x=2", "b.y=3")]
    with pytest.raises(InputError, match="twice"):
        variants([axes[0], axes[0]], grid=True)


def fake(scenario, overrides, variant):
    """A task without solver; the value says what happens."""
    value = dict(variant.changes).get("a.x", "1")
    if value == "die":
        os._exit(9)
    if value == "fail":
        return {"error": "it failed"}
    return {f"{c}_peak": float(value) * k for k, c in enumerate(("fx", "fz", "f"), 1)}


def test_a_failure_and_a_dead_process_stop_nothing():
    seen = []
    chosen = variants([Axis("a.x", ("2", "fail", "die", "3"))], grid=False)
    rows = sweep("x", (), chosen, 2, lambda row, ended: seen.append(row["variant"]), fake)
    assert [row.get("fx_peak") for row in rows] == [1.0, 2.0, None, None, 3.0]
    assert sorted(seen) == sorted(v.name for v in chosen)
    assert rows[2]["error"] == "it failed"
    assert "process died" in rows[3]["error"]
    assert rows[4]["error"] is None
    assert [row["fz_ratio"] for row in rows] == [1.0, 2.0, None, None, 3.0]


def test_ratios_without_a_base_are_none():
    rows = with_ratios([{"error": "no"}, {"fx_peak": 1.0}], {"error": "no"})
    assert rows[1]["fx_ratio"] is None
    assert rows[1]["error"] is None


@pytest.fixture(scope="module")
def content():
    """A sweep over two workers."""
    chosen = variants([Axis("contact.strength", ("1 MPa",)), Axis("sheet.nodes", ("[14,14]", "[12,13]"))], grid=False)
    rows = sweep(CASE, TINY, chosen, 2, lambda row, ended: None)
    return {"scenario": "s", "keys": ["contact.strength", "sheet.nodes"], "variants": rows}


def test_numbers_do_not_depend_on_the_pool(content):
    """Two workers, one after the other in one process, and this process: the same bits but for the cost."""
    chosen = [Variant(), Variant((("contact.strength", "1 MPa"),))]
    one = sweep(CASE, TINY, chosen, 1, lambda row, ended: None)
    here = [{"variant": v.name, **dict(v.changes), **sweeping.run_variant(CASE, TINY, v)} for v in chosen]
    with_ratios(here, here[0])
    for a, b, c in zip(content["variants"], one, here, strict=False):
        bare = [{k: v for k, v in row.items() if k != "wall_s"} for row in (a, b, c)]
        assert bare[0] == bare[1] == bare[2]
    assert one[1]["fx_ratio"] > 2.0


def test_the_table_holds_the_failed_variant_with_its_error(content, tmp_path):
    out = tmp_path / "t.csv"
    with Table(out) as table:
        table.write(content["keys"], content["variants"])
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
    monkeypatch.setattr("cosim.study.command.print_line", lines.append)
    why = [{"not_trustworthy": "it is at its end"}, {"not_trustworthy": ""}, {"not_trustworthy": ""}, {}]
    show({**content, "variants": [row | t for row, t in zip(content["variants"], why, strict=True)]})
    assert lines[0] == "not trustworthy: base: because it is at its end"
    assert [line.split(":")[0] for line in lines] == ["not trustworthy", "failed"]
