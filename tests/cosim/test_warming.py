"""Kernels compiled ahead: what a scenario needs, the marks that remember it, the command."""

import json
import os
import subprocess
import sys

import pytest

from cosim import warming
from cosim.scenario.loading import load_scenario
from cosim.show.talk import QUIET, Talk
from cosim.warming import PARTS, Compiled, compile_ahead, missing, parts_of


@pytest.mark.parametrize(
    ("overrides", "parts"),
    [
        (("fracture.cracks=open",), ["rubble", "open", "pieces"]),
        (("fracture.cracks=closing",), ["rubble", "closing", "pieces"]),
        (("fracture.cracks=closing", "rubble.enabled=false"), ["closing"]),
        (("fracture.propagation=dynamic", "rubble.enabled=false"), ["explicit"]),
    ],
)
def test_a_scenario_needs_its_parts(overrides, parts):
    assert parts_of(load_scenario("first_cone", overrides)) == parts


@pytest.fixture
def folders(tmp_path, monkeypatch):
    """New folders of kernels, with nothing in them."""
    for package in (warming.of_lattice, warming.of_rubble, warming.of_coupling):
        folder = tmp_path / package.__name__
        folder.mkdir()
        monkeypatch.setattr(package, "FOLDER", folder)
    monkeypatch.setenv(warming.SWITCH, "1")
    monkeypatch.setattr(os, "cpu_count", lambda: 2)


def fake(monkeypatch):
    """Processes that compile nothing; gives what was asked of them."""
    asked = []

    def compile_parts(parts, processes, done):
        asked.append((list(parts), processes))
        for part in parts:
            for file in warming._marks(part):
                file.touch()
            done(Compiled(part, 3, 1.0))

    monkeypatch.setattr(warming, "compile_parts", compile_parts)
    return asked


def test_what_is_compiled_is_not_compiled_again_until_a_package_changes(folders, tmp_path, monkeypatch):
    asked, scenario = fake(monkeypatch), load_scenario("first_cone")
    assert missing(list(PARTS)) == list(PARTS)
    compile_ahead(scenario, Talk(QUIET))
    compile_ahead(scenario, Talk(QUIET))
    assert asked == [(parts_of(scenario), 2)]
    other = tmp_path / "other"
    other.mkdir()
    monkeypatch.setattr(warming.of_coupling, "FOLDER", other)
    assert missing(parts_of(scenario)) == parts_of(scenario)


@pytest.mark.parametrize("why", ["one part", "one processor", "switched off", "no place"])
def test_a_run_compiles_as_it_goes_where_there_is_nothing_to_win(folders, monkeypatch, why):
    asked = fake(monkeypatch)
    scenario = load_scenario("first_cone", ["rubble.enabled=false"] if why == "one part" else [])
    if why == "one processor":
        monkeypatch.setattr(os, "cpu_count", lambda: 1)
    if why == "switched off":
        monkeypatch.setenv(warming.SWITCH, "0")
    if why == "no place":
        monkeypatch.setattr(warming.of_rubble, "FOLDER", None)
    compile_ahead(scenario, Talk(QUIET))
    assert asked == []


def test_the_command_tells_how_many_and_how_long(cosim, folders, monkeypatch):
    fake(monkeypatch)
    code, out, err = cosim("warm", "--json")
    told = json.loads(out)
    assert (code, told["kernels"], list(told["parts"])) == (0, 3 * len(PARTS), list(PARTS))
    assert f"1 of {len(PARTS)}, rubble: 3 kernels compiled, 1 s" in err
    code, _, err = cosim("warm")
    assert (code, err.strip()) == (0, "all kernels are compiled")


PART = """
from cosim.warming import compile_part, missing
done = compile_part("open")
print(done.part, missing(["open"]))
"""


def test_a_part_runs_and_leaves_its_marks():
    done = subprocess.run([sys.executable, "-c", PART], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["open", "[]"]


AHEAD = """
from cosim.warming import compile_part
from rubble.banks import find_banks
from rubble.bending import judge_all
from rubble.sides import find_sides
from rubble.stepping import advance_substeps
def compiled():
    return [len(kernel.signatures) for kernel in (find_sides, find_banks, judge_all, advance_substeps)]
compile_part("pieces")
print(compiled())
compile_part("rubble")
print(compiled())
"""


def test_a_pile_of_nothing_compiles_what_piles_come_to_last_and_for_the_same_arguments():
    done = subprocess.run([sys.executable, "-c", AHEAD], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == ["[1, 1, 1, 0]", "[1, 1, 1, 1]"]
