"""Arguments that several commands share."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

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
SeriesSetOption = Annotated[
    list[str] | None, typer.Option("--set", metavar="A.B=V", help="a key of series.toml, for example fx.unit=kN")
]
JsonOption = Annotated[bool, typer.Option("--json", help="one JSON object on standard output")]
ForceOption = Annotated[bool, typer.Option("--force", help="write over a recording that exists")]
QuietOption = Annotated[bool, typer.Option("-q", "--quiet", help="warnings, errors and the result only")]
VerboseOption = Annotated[bool, typer.Option("-v", "--verbose", help="every event of a run, and what was chosen")]
LogOption = Annotated[Path | None, typer.Option("--log-file", help="append what is said to this file, all of it")]

_TALK = {"quiet": (QuietOption, False), "verbose": (VerboseOption, False), "log_file": (LogOption, None)}


def talking(command: Callable[..., None]) -> Callable[..., None]:
    """Gives a command ``-q``, ``-v`` and ``--log-file``; it gets them as ``talk``, a `cosim.show.talk.Talk`."""

    @functools.wraps(command)
    def wrapped(**given: Any) -> None:
        from cosim.errors import InputError
        from cosim.show.talk import QUIET, USUAL, VERBOSE, Talk

        quiet, verbose, log = (given.pop(name) for name in _TALK)
        if quiet and verbose:
            raise InputError("-q and -v exclude each other; give one of them")
        with Talk(QUIET if quiet else VERBOSE if verbose else USUAL, log) as talk:
            command(**given, talk=talk)

    own = inspect.signature(command, eval_str=True)
    more = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)
        for name, (kind, default) in _TALK.items()
    ]
    shown = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for name, p in own.parameters.items() if name != "talk"]
    wrapped.__signature__ = own.replace(parameters=[*shown, *more])  # type: ignore[attr-defined]
    wrapped.__annotations__ = {p.name: p.annotation for p in (*shown, *more)}
    return wrapped
