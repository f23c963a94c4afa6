"""The parameters of a run as a table: value as it ran, and where it is from, as the comments of its file say."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from math import degrees
from typing import Any

from cosim.analysis.run_data import RunData
from cosim.scenario.text import value_text

DEFAULT, SET = "default of the program", "set by the user of this run"
_SECTION = re.compile(r"\s*\[([\w.]+)\]\s*(?:#.*)?")
#: a key, a value in which a hash inside quotes is none, and its comment
_LINE = re.compile(r"""\s*(\w+)\s*=\s*((?:"[^"]*"|'[^']*'|[^"'#])*)(?:#\s*(.*))?""")
#: an angle in the unit of the program, and a number with more digits than a reader wants
_ANGLE, _LONG = re.compile(r"(-?[\d.e+-]+) rad"), re.compile(r"-?\d+\.\d{7,}(?:e[+-]?\d+)?")


def parameters(run: RunData) -> list[tuple[str, str, str]]:
    """Key, value and source of every parameter, in the order of the file; empty without a scenario."""
    ran = tomllib.loads(run.texts.get("scenario.toml", ""))
    written = dict(sources(run.texts.get("scenario.as-written.toml", "")))
    changed = {text.partition("=")[0].strip() for text in run.overrides}
    rows = []
    for key, value in _leaves(ran):
        source = SET if key in changed else written.get(key, DEFAULT)
        rows.append((key, told(value), source))
    return rows


def told(value: Any) -> str:
    """A value for a reader: no more than six digits, angles in degrees; the recording holds the exact one."""
    text = value_text(value).strip('"')
    if (angle := _ANGLE.fullmatch(text)) is not None:
        return f"{degrees(float(angle[1])):g} deg"
    return _LONG.sub(lambda number: f"{float(number[0]):g}", text) if not isinstance(value, int) else text


def sources(text: str) -> Iterator[tuple[str, str]]:
    """Key and comment of every line of a scenario; of a key that stands there twice, the later one counts."""
    section = ""
    for line in text.splitlines():
        if found := _SECTION.fullmatch(line):
            section = found[1]
        elif (found := _LINE.fullmatch(line)) and section:
            yield f"{section}.{found[1]}", found[3] or ""


def _leaves(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value
