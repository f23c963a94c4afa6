"""Arguments that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

ScenarioArgument = Annotated[str, typer.Argument(help="scenario folder, TOML file, or name from `cosim list`")]
RunArgument = Annotated[Path, typer.Argument(help="recording (.mcap)")]
SetOption = Annotated[list[str] | None, typer.Option("--set", metavar="A.B=V", help="override a value of the scenario")]
JsonOption = Annotated[bool, typer.Option("--json", help="one JSON object on standard output")]
ForceOption = Annotated[bool, typer.Option("--force", help="write over a recording or table that exists")]
