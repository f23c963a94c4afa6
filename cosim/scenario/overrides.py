"""Values that a user sets over those of a file: ``a.b=v``."""

from __future__ import annotations

import tomllib
from typing import Any

from cosim.scenario.errors import ScenarioError


def apply(raw: dict[str, Any], item: str) -> str:
    """Set one ``a.b=v`` in the parsed file; returns the key. ``v`` is read as TOML, else taken as a string."""
    key, equals, text = item.partition("=")
    parts = key.strip().split(".")
    if not equals or len(parts) < 2 or not all(parts):
        raise ScenarioError(f"--set {item}: not of the form section.key=value; for example --set ice.thickness='2 m'")
    try:
        value = tomllib.loads(f"v = {text}")["v"]
    except tomllib.TOMLDecodeError:
        value = text.strip()
    table = raw
    for part in parts[:-1]:
        table = table.setdefault(part, {})
        if not isinstance(table, dict):
            raise ScenarioError(f"--set {item}: {part} is a value and not a section; remove the last part of the key")
    table[parts[-1]] = value
    return ".".join(parts)
