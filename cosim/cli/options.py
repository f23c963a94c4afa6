"""Arguments that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def scenario_names(begin: str) -> list[str]:
    """What a shell offers for a scenario."""
    from cosim.scenario.finding import find_scenarios

    return [folder.name for folder in find_scenarios() if folder.name.startswith(begin)]


ScenarioArgument = Annotated[
    str,
    typer.Argument(help="scenario folder, TOML file, or name from `cosim list`", autocompletion=scenario_names),
]
RunArgument = Annotated[Path, typer.Argument(help="recording (.mcap)")]
SetOption = Annotated[list[str] | None, typer.Option("--set", metavar="A.B=V", help="override a value of the scenario")]
JsonOption = Annotated[bool, typer.Option("--json", help="one JSON object on standard output")]
ForceOption = Annotated[bool, typer.Option("--force", help="write over a recording that exists")]
