"""A scenario back to TOML: what ran, with overrides applied and every default written out."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from pydantic import BaseModel

from cosim.scenario.units import Unit


def complete(raw: dict[str, Any], model: BaseModel) -> dict[str, Any]:
    """``raw`` as the user wrote it (units kept), with the defaults of ``model`` added. None is left out."""
    table: dict[str, Any] = {}
    for name, info in type(model).model_fields.items():
        value = getattr(model, name)
        if isinstance(value, BaseModel):
            table[name] = complete(raw.get(name, {}), value)
        elif name in raw:
            table[name] = raw[name]
        elif value is not None:
            table[name] = _with_unit(value, info.metadata)
    return table


def _with_unit(value: Any, metadata: Sequence[Any]) -> Any:
    unit = next((m for m in metadata if isinstance(m, Unit)), None)
    return value if unit is None else f"{value!r} {unit.si}"


def to_toml(table: dict[str, Any], prefix: str = "") -> str:
    """Tables of strings, numbers, booleans and lists as TOML. Values before sub-tables, in the given order."""
    lines = [f"{key} = {value_text(value)}" for key, value in table.items() if not isinstance(value, dict)]
    if prefix and lines:
        lines.insert(0, f"[{prefix}]")
    text = "\n".join(lines) + ("\n\n" if lines else "")
    for key, value in table.items():
        if isinstance(value, dict):
            text += to_toml(value, f"{prefix}.{key}" if prefix else key)
    return text


def value_text(value: Any) -> str:
    """One value as TOML."""
    if isinstance(value, list | tuple):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)
