"""Scenarios as a list: what each says of itself. The rest of a file is not looked at, so that no solver is loaded."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.errors import InputError
from cosim.scenario.errors import ScenarioError
from cosim.scenario.files import read_file
from cosim.scenario.finding import find_scenarios
from cosim.scenario.units import Unit, to_si


def listing() -> list[dict[str, Any]]:
    """``name``, ``title``, ``description``, ``duration`` as written; ``fault`` says why a file cannot be read."""
    return [_entry(folder) for folder in find_scenarios()]


def in_seconds(row: dict[str, Any]) -> dict[str, Any]:
    """The same row with ``duration_s`` in place of what is written."""
    bare = {key: value for key, value in row.items() if key != "duration"}
    try:
        seconds = None if row["fault"] else to_si(row["duration"], Unit("s", "60 s"))
    except PydanticCustomError as error:
        return bare | {"duration_s": None, "fault": f"{row['name']}: scenario.duration: {error.message()}"}
    return bare | {"duration_s": seconds}


def _entry(folder: Path) -> dict[str, Any]:
    file = folder / "scenario.toml"
    keys = ("title", "description", "duration")
    row: dict[str, Any] = {"name": folder.name, "title": None, "description": "", "duration": None, "fault": None}
    try:
        table = read_file(file).table.get("scenario")
        if not isinstance(table, dict):
            raise ScenarioError(f"{file}: scenario is missing; add the section [scenario]")
        for key in ("title", "duration"):
            if not isinstance(table.get(key), str):
                raise ScenarioError(f"{file}: scenario.{key} is missing or no text; add it")
    except (InputError, OSError) as error:
        return row | {"fault": str(error)}
    return row | {key: table[key] for key in keys if key in table}
