"""Scenarios: a TOML file, read strictly, becomes a frozen `Scenario` with SI floats.

Nothing is silently repaired. Whatever is wrong is one `ScenarioError` with one line: file, key, value, what to do.

    >>> scenario = load_scenario("scenarios/van_vliet_2018_floe_165m", ["coupling.window=20 ms"])
    >>> scenario.ice.thickness, scenario.window_ns
    (3.0, 20000000)
"""

from __future__ import annotations

from collections.abc import Iterable
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from cosim.scenario.errors import ScenarioError, Source
from cosim.scenario.faults import faults_of
from cosim.scenario.files import ReadFile, read_file
from cosim.scenario.finding import locate
from cosim.scenario.judge import lattice
from cosim.scenario.model import ScenarioModel
from cosim.scenario.overrides import apply
from cosim.scenario.scenario import Scenario


@dataclass(frozen=True)
class Written:
    """A scenario as its files tell it, before overrides: all that a process needs that does not see the files."""

    name: str  #: of the folder or file, without path
    file: Path
    read: ReadFile


def read_scenario(path: str | Path) -> Written:
    """Read a scenario folder, a TOML file, or a shipped scenario by name; nothing is checked yet."""
    file = locate(path)
    return Written(file.parent.name if file.name == "scenario.toml" else file.stem, file, read_file(file))


def checked(written: Written, overrides: Iterable[str] = ()) -> Scenario:
    """The scenario with ``overrides``, ``a.b=v`` texts, over what is written."""
    read, overrides, table = written.read, tuple(overrides), deepcopy(written.read.table)
    overridden = {apply(table, item) for item in overrides}
    try:
        model = ScenarioModel.model_validate(table)
    except ValidationError:
        raise ScenarioError(*faults_of(table, Source(str(written.file), read.files, overridden))) from None
    return Scenario(
        written.name,
        read.text,
        table,
        model,
        overrides,
        written.file.parent,
        tuple(f"{doubt.key}: {doubt.text}" for doubt in lattice(model)),
    )


def load_scenario(path: str | Path, overrides: Iterable[str] = ()) -> Scenario:
    """Read and check in one go."""
    return checked(read_scenario(path), overrides)
