"""The list of cases of the campaign: a TOML file with a table ``[[case]]`` for each.

``name`` and ``scenario`` are needed, and ``claim``: what the case shows, in a line. ``duration`` and ``set`` (texts
``a.b=v``) go over the scenario, ``seeds`` is the number of runs, ``reference`` another file of features beside the
scenario, ``features`` those of them that the table shows (default: all). TOML is read strictly.
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from cosim.errors import InputError
from cosim.nearest import hint
from cosim.scenario.files import read_toml

CAMPAIGN = Path(__file__).with_name("cases.toml")  #: the project's own list


class Case(BaseModel):
    """One line of the campaign."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    name: str = Field(pattern=r"^[a-z0-9][a-z0-9._-]{0,60}$")  #: of its table's file too
    scenario: str = Field(min_length=1)
    claim: str = Field(min_length=1, max_length=300)
    duration: str = ""  #: simulated time; empty: the scenario's
    set: tuple[str, ...] = Field((), strict=False)
    seeds: int = Field(1, ge=1, le=10_000)
    reference: str = Field("", pattern=r"^[^/\\]*$")  #: file beside the scenario; empty: its reference.toml
    features: tuple[str, ...] = Field((), strict=False)

    @property
    def overrides(self) -> tuple[str, ...]:
        """What goes over the scenario, as the command line takes it."""
        return (*self.set, f"scenario.duration='{self.duration}'") if self.duration else self.set

    def command(self, folder: Path) -> str:
        """The command that shows the claim."""
        return f"cosim evidence --only {self.name} -o {shlex.quote(str(folder))}"


@dataclass(frozen=True)
class Cases:
    """A list of cases, and the file that holds it."""

    file: Path
    all: tuple[Case, ...]

    def chosen(self, names: Sequence[str]) -> tuple[Case, ...]:
        """Those of these names in the order of the list; all without names. InputError for a name that it lacks."""
        known = [case.name for case in self.all]
        for name in names:
            if name not in known:
                raise InputError(f"--only {name}: no such case in {self.file.name}; {hint(name, known)}")
        return tuple(case for case in self.all if not names or case.name in names)


def read_cases(file: Path | None = None) -> Cases:
    """The project's list, or another one."""
    file = CAMPAIGN if file is None else file
    table = read_toml(file, InputError)[1]
    if unknown := [key for key in table if key != "case"]:
        raise InputError(f"{file}: unknown key {unknown[0]!r}; {hint(unknown[0], ('case',))}")
    entries = table.get("case")
    if not isinstance(entries, list) or not entries:
        raise InputError(f"{file}: no cases; add at least one [[case]] with name, scenario and claim")
    cases = tuple(_case(entry, k, file) for k, entry in enumerate(entries, 1))
    names = [case.name for case in cases]
    if twice := [name for name in names if names.count(name) > 1]:
        raise InputError(f"{file}: case {twice[0]} stands there twice; give each its own name")
    return Cases(file, cases)


def _case(entry: Any, number: int, file: Path) -> Case:
    name = entry.get("name", number) if isinstance(entry, dict) else number
    try:
        return Case.model_validate(entry)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"])
        more = f"; {hint(key, tuple(Case.model_fields))}" if first["type"] == "extra_forbidden" else ""
        raise InputError(f"{file}: case {name}: {key or 'table'}: {first['msg'].lower()}{more}") from None
