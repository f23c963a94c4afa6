"""Commands on scenarios that simulate nothing: baseline, list."""

from __future__ import annotations

from cosim.cli.options import JsonOption, ScenarioArgument, SetOption
from cosim.cli.output import print_json


def baseline(scenario: ScenarioArgument, overrides: SetOption = None, as_json: JsonOption = False) -> None:
    """Design formulas for the ice and the structure of a scenario: Croasdale, Ralston, Nevel."""
    from cosim.baselines.methods import design_loads
    from cosim.scenario.loading import load_scenario
    from cosim.show.baseline_tables import print_baseline

    loaded = load_scenario(scenario, overrides or ())
    found = design_loads(loaded.model)
    print_json(found) if as_json else print_baseline(loaded.title, found)


def list_scenarios(as_json: JsonOption = False) -> None:
    """The scenarios that are found here and in the project."""
    from cosim.scenario.finding import find_scenarios
    from cosim.scenario.loading import load_scenario
    from cosim.show.tables import print_scenarios

    found = [load_scenario(folder) for folder in find_scenarios()]
    rows = [
        {
            "name": s.name,
            "title": s.title,
            "description": s.model.scenario.description,
            "duration_s": s.duration_ns / 1e9,
        }
        for s in found
    ]
    print_json({"scenarios": rows}) if as_json else print_scenarios(rows)
