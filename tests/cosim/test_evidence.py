"""The campaign: its list, one pool for all its cases, a table that goes on where it was, ratios that can be wrong."""

import json
import os
import pickle
from functools import partial
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from cosim.errors import InputError
from cosim.evidence.campaign import planned, run_campaign
from cosim.evidence.cases import read_cases
from cosim.evidence.table import content_of, markdown, write
from cosim.study.task import RESULTS

TINY = """
[[case]]
name = "a"
scenario = "basin_2010_floe_165m"
claim = "two seeds"
duration = "1 s"
seeds = 2
features = ["first_encounter_fx", "piece_length"]

[[case]]
name = "b"
scenario = "narrow_cone"
claim = "one run | with another reference"
reference = "reference_100mm.toml"
"""
LOADS = {"a": 9.5e6, "b": 54e3}  #: what the stub gives for the first feature: half of 19 MN, twice 27 kN


class Here:
    """Runs tasks in this process, the last one first, as another process would get them."""

    def run(self, tasks, work):
        work = pickle.loads(pickle.dumps(work))
        for number, variant in reversed(tasks):
            yield number, work(number, variant)


def fake(log, study, number, variant):
    """A task without solver, which tells in a file that it ran; seeds of the first case differ by 2 MN."""
    first = "first_encounter_fx" if "first_encounter_fx" in study.reference else "first_load_formula"
    with open(log, "a", encoding="utf-8") as file:
        file.write(f"{first} {number}\n")
    load = LOADS["a"] - 1e6 + 2e6 * number if first == "first_encounter_fx" else LOADS["b"]
    row = dict.fromkeys(RESULTS, 1.0) | {"not_trustworthy": "", "fragments": 1, "blocks": 1}
    return row | {f"feature_{first}": load}


def dies_at_b(study, number, variant):
    if "first_load_formula" in study.reference:
        return {"error": "it failed"}
    return fake(os.devnull, study, number, variant)


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    file = tmp_path_factory.mktemp("list") / "tiny.toml"
    file.write_text(TINY, encoding="utf-8")
    return [planned(case) for case in read_cases(file).all]


def of(content, case, feature):
    found = next(c for c in content["cases"] if c["name"] == case)
    return next(f for f in found["features"] if f["name"] == feature)


def test_all_cases_share_one_pool_and_their_rows_find_their_case(cases, tmp_path):
    log, seen = tmp_path / "log", []
    rows = run_campaign(cases, tmp_path, Here(), lambda the, row: seen.append(the.case.name), partial(fake, log))
    assert sorted(log.read_text().splitlines()) == [
        "first_encounter_fx 0",
        "first_encounter_fx 1",
        "first_load_formula 0",
    ]
    assert sorted(seen) == ["a", "a", "b"]
    content = content_of(cases, rows, tmp_path)
    a, b = of(content, "a", "first_encounter_fx"), of(content, "b", "first_load_formula")
    assert a["n"] == 2
    assert a["measured_ratio"] == pytest.approx(0.5)  # 9.5 of 19 MN (van Vliet 2018, 6.3.2)
    assert a["measured_ratio_p05"] == pytest.approx((8.5 + 0.05 * 2.0) / 19.0)
    assert b["thesis"] == [27e3, 27e3]  # the file that the case names, not the 92 kN of 0.2 m
    assert b["thesis_ratio"] == pytest.approx(2.0)
    assert of(content, "a", "piece_length")["median"] is None
    assert [f["name"] for f in content["cases"][0]["features"]] == ["first_encounter_fx", "piece_length"]


def test_it_goes_on_where_it_was_and_tries_failures_again(cases, tmp_path):
    rows = run_campaign(cases, tmp_path, Here(), lambda *_: None, dies_at_b)
    failed = content_of(cases, rows, tmp_path)["cases"][1]
    assert (failed["runs"], failed["errors"]) == (0, ["it failed"])
    log = tmp_path / "log"
    again = run_campaign(cases, tmp_path, Here(), lambda *_: None, partial(fake, log))
    assert log.read_text().split() == ["first_load_formula", "0"]  # the two seeds of the first case are known
    (tmp_path / "other").mkdir()
    whole = run_campaign(cases, tmp_path / "other", Here(), lambda *_: None, partial(fake, log))
    first, second = (content_of(cases, r, Path("x")) for r in (again, whole))
    assert first == second


def test_the_table_is_written_for_people_and_for_programs(cases, tmp_path):
    rows = run_campaign(cases[:1], tmp_path, Here(), lambda *_: None, partial(fake, os.devnull))
    content = content_of(cases, rows, tmp_path)
    files = write(content, tmp_path)
    text = files[0].read_text(encoding="utf-8")
    assert "| a | first_encounter_fx | 9.5 (8.6 to 10.4) MN | 2 of 2 | 19.0 MN | 0.50 | - | - | good |" in text
    assert "| b | - | not run | 0 of 1 |" in text
    assert json.loads(files[1].read_text(encoding="utf-8")) == content
    table = pq.read_table(files[2]).to_pylist()
    assert [row["measured_ratio"] for row in table if row["feature"] == "first_encounter_fx"] == [pytest.approx(0.5)]
    write(content, tmp_path)  # its own files are written anew, others are not
    files[0].write_text("mine", encoding="utf-8")
    with pytest.raises(InputError, match="not written over"):
        write(content, tmp_path)
    lines = [line for line in markdown(content).splitlines() if line.startswith("|")]
    assert {line.count("|") for line in lines} == {10, 4}  # a bar in a claim adds no cell


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x = 1", "unknown key 'x'"),
        ("", "no cases"),
        ('[[case]]\nname = "A B"\nscenario = "x"\nclaim = "x"', "case A B: name"),
        ('[[case]]\nname = "a"\nscenario = "x"\nclaim = "x"\nseed = 2', "did you mean seeds"),
        ('[[case]]\nname = "a"\nscenario = "x"', "case a: claim: field required"),
        ('[[case]]\nname = "a"\nscenario = "x"\nclaim = "x"\n' * 2, "twice"),
    ],
)
def test_a_wrong_list_is_one_line(text, says, tmp_path):
    (tmp_path / "l.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=says) as error:
        read_cases(tmp_path / "l.toml")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ('features = ["piece_lenght"]', "did you mean piece_length"),
        ("seeds = 3\nset = [\"rubble.initial_volume='0 m^3'\"]", "nothing is random"),
        ("set = [\"ice.thikness='1 m'\"]", "thickness"),
    ],
)
def test_a_wrong_case_is_refused_before_anything_runs(more, says, tmp_path):
    head = '[[case]]\nname = "a"\nscenario = "basin_2010_floe_165m"\nclaim = "x"\n'
    (tmp_path / "l.toml").write_text(head + more, encoding="utf-8")
    with pytest.raises(InputError, match=says):
        planned(read_cases(tmp_path / "l.toml").all[0])


def test_every_case_of_the_project_can_be_planned_and_every_shipped_scenario_with_a_reference_is_in_it():
    known = read_cases()
    found = [planned(case) for case in known.all]
    assert all(the.features for the in found)
    folder = Path(__file__).parents[2] / "scenarios"
    assert {c.scenario for c in known.all} == {file.parent.name for file in folder.glob("*/reference.toml")}
    with pytest.raises(InputError, match="did you mean bridge-pier"):
        known.chosen(["bridge-peer"])
