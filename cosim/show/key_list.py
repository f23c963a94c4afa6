"""The keys of a scenario for people and as JSON."""

from __future__ import annotations

import textwrap
from typing import Any

from cosim.scenario.keys import Key, default_of, example_of, kinds_of, range_of, words_of
from cosim.show.console import print_line, stdout


def key_json(key: Key) -> dict[str, Any]:
    """One key: ``default`` is null where it follows from other keys."""
    field = key.field
    return {
        "key": key.name,
        "meaning": key.about,
        "unit": key.unit.si if key.unit else None,
        "range": range_of(field) or None,
        "choices": words_of(field) or None,
        "required": field.is_required(),
        "default": default_of(field) or None,
        "example": example_of(field),
    }


def print_keys(keys: list[Key]) -> None:
    """Key, what may be written, range, default; below it the meaning."""
    width = min(stdout.width, 100)
    for key in keys:
        default = default_of(key.field)
        told = "required" if default is None else f"default {default}" if default else "optional"
        kinds = [f"for example {example_of(key.field)}"] if key.unit else [" or ".join(kinds_of(key.field))]
        parts = [*([f"[{key.unit.si}]"] if key.unit else []), *kinds, range_of(key.field), told]
        print_line(f"{key.name}: {', '.join(part for part in parts if part)}")
        for line in textwrap.wrap(key.about, width - 4):
            print_line(f"    {line}")
