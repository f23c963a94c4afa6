"""Scenarios: a TOML file, read strictly, becomes a frozen `Scenario` with SI floats.

Nothing is silently repaired. Whatever is wrong is one `ScenarioError` with one line: file, key, value, what to do.

    >>> scenario = load_scenario("scenarios/van_vliet_2018_floe_165m", ["coupling.window=20 ms"])
    >>> scenario.ice.thickness, scenario.window_ns
    (3.0, 20000000)
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from pydantic import ValidationError

from cosim.scenario.errors import ScenarioError, Source
from cosim.scenario.faults import faults_of
from cosim.scenario.files import read_file
from cosim.scenario.finding import locate
from cosim.scenario.judge import lattice
from cosim.scenario.model import ScenarioModel
from cosim.scenario.overrides import apply
from cosim.scenario.scenario import Scenario


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read a scenario folder, a TOML file, or a shipped scenario by name; ``overrides`` are ``a.b=v`` texts."""
    file = locate(path)
    read = read_file(file)
    overrides = tuple(overrides)
    overridden = {apply(read.table, item) for item in overrides}
    try:
        model = ScenarioModel.model_validate(read.table)
    except ValidationError:
        raise ScenarioError(*faults_of(read.table, Source(str(file), read.files, overridden))) from None
    name = file.parent.name if file.name == "scenario.toml" else file.stem
    return Scenario(
        name,
        read.text,
        read.table,
        model,
        overrides,
        file.parent,
        tuple(f"{doubt.key}: {doubt.text}" for doubt in lattice(model)),
    )
