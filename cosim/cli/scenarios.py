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
    """The scenarios that are found here and in the project; of two of one name the one here."""
    from cosim.scenario.listing import in_seconds, listing
    from cosim.show.scenario_table import print_scenarios

    rows = listing()
    print_json({"scenarios": [in_seconds(row) for row in rows]}) if as_json else print_scenarios(rows)
