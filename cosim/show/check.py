"""What `cosim check` and a run without simulation tell of a scenario that can run."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from cosim.analysis.lights import COARSER
from cosim.scenario.cost import cost_of, too_large
from cosim.scenario.judge import doubts_of, facts_of
from cosim.scenario.scenario import Scenario
from cosim.show.console import print_line
from cosim.show.scale import Scale, scale_of, significant


def judged(scenario: Scenario) -> dict[str, Any]:
    """Title, faults of size, doubts, facts [SI] and cost of a scenario."""
    cost = cost_of(scenario.model)
    refused = too_large(cost)
    return {
        "title": scenario.title,
        "faults": [] if refused is None else [refused],
        "doubts": [asdict(doubt) for doubt in doubts_of(scenario.model)],
        "facts": facts_of(scenario.model, scenario.averaging),
        "cost": asdict(cost),
        "cost_text": cost.text,
    }


def print_check(content: dict[str, Any]) -> None:
    """Facts, cost, and what looks unlikely."""
    print_line(content["title"])
    for line in fact_lines(content["facts"]):
        print_line(line)
    print_line(content["cost_text"])
    for doubt in content["doubts"]:
        print_line(f"doubtful: {doubt['key']}: {doubt['text']}")
    if not content["faults"]:
        count = len(content["doubts"])
        print_line(f"no fault; {f'{count} doubtful' if count else 'nothing doubtful'}")


def fact_lines(facts: dict[str, float]) -> list[str]:
    """What follows from the scenario, in a few lines; with what was chosen where it says nothing."""
    tested = facts.get("beam_cell_m", facts["cell_m"])
    lengths = {name: _length(facts[f"{name}_m"]) for name in ("characteristic_length", "breaking_length", "cell")}
    per_length = significant(facts["nodes_per_characteristic_length"])
    lines = [
        f"characteristic length {lengths['characteristic_length']}, breaking length {lengths['breaking_length']}, "
        f"cells of {lengths['cell']}, {per_length} in a characteristic length",
        f"the ice drifts {_length(facts['drift_in_run_m'])}; window {_time(facts['window_s'])}, sub-step "
        f"{_time(facts['substep_s'])}; peaks are means over {_time(facts['averaging_s'])}",
    ]
    if facts["cell_m"] > COARSER * tested:
        lines.append(
            f"the strength of the layers is that of cells of {_length(tested)}, half as wide as the beam test; these "
            f"are {significant(facts['cell_m'] / tested)} times as wide"
        )
    return lines


def _length(value: float) -> str:
    return scale_of((value,), "m").labelled(value)


def _time(value: float) -> str:
    scale = Scale(1.0, "s", 2) if value >= 1.0 else Scale(1e-3, "ms", 0 if value >= 0.01 else 2)
    return f"{significant(value / scale.size)} {scale.unit}"
