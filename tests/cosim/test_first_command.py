"""The README's first command shows the whole tool: ice breaks, turns and slides; and its picture is of that case."""

import re
from pathlib import Path

import pytest

from cosim.scenario.cost import cost_of
from cosim.scenario.loading import load_scenario
from cosim.simulation import run_scenario

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")


@pytest.fixture(scope="module")
def scenario():
    command = re.search(r"^pip install uv && uv run cosim run (\S+) -o run\.mcap", README, re.M)
    return load_scenario(ROOT / command[1])


def test_all_three_phases_load_the_structure(scenario):
    """About 20 s on one core; the kernels' first compiling takes half a minute more."""
    assert cost_of(scenario.model).seconds < 60.0
    result = run_scenario(scenario)
    kinds = {e.kind for e in result.events}
    assert {"cell_failure", "circumferential", "hand_over"} <= kinds
    largest = {phase: peaks.value[0] for phase, peaks in result.by_phase.items()}
    total = result.peaks.value[0]
    assert all(0.2 * total < load < total for load in largest.values()), largest


def test_the_picture_is_that_of_the_case(scenario):
    shown = re.search(r"^!\[.*?\]\((\S+)\)", README, re.M)[1]
    assert (ROOT / shown).parent == scenario.folder
    assert (ROOT / shown).is_file()
    at = float(re.search(r"--screenshot picture\.png --at (\d+)", README)[1])
    assert 0.0 < at <= scenario.duration_ns / 1e9
