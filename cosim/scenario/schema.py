"""A JSON schema of scenario files for editors, from the models that read them: meanings, units, examples by key.

What it accepts is a little more than what is read: rules that span keys are not in it, and a quantity is only seen to
have a number and a unit.
"""

from __future__ import annotations

import tomllib
from typing import Any, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cosim.scenario.keys import (
    constraints,
    default_of,
    example_of,
    meanings,
    members,
    model_of,
    range_of,
    unit_of,
    words_of,
)

QUANTITY = r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*[^\d\s.,].*$"
NUMBERS = {"ge": "minimum", "gt": "exclusiveMinimum", "le": "maximum", "lt": "exclusiveMaximum"}


def schema_of(model: type[BaseModel]) -> dict[str, Any]:
    """Draft 2020-12. A file with a base need not have every key."""
    properties = {name: _section(field) for name, field in model.model_fields.items()}
    required = [name for name, field in model.model_fields.items() if field.is_required()]
    whole = {
        name: {"required": keys}
        for name, field in model.model_fields.items()
        if (section := model_of(field.annotation))
        and (keys := [key for key, inner in section.model_fields.items() if inner.is_required()])
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Scenario of cosim",
        "type": "object",
        "additionalProperties": False,
        "properties": {
            "base": {"type": "string", "description": "a scenario file whose keys hold where this one has none"},
            **properties,
        },
        "if": {"not": {"required": ["base"]}},
        "then": {"required": required, "properties": whole},
    }


def _section(field: FieldInfo) -> dict[str, Any]:
    model = model_of(field.annotation)
    assert model is not None
    words = meanings(model)
    properties, required = {}, []
    for key, inner in model.model_fields.items():
        section = model_of(inner.annotation)
        properties[key] = _section(inner) if section else _key(inner, words[key])
        if section is not None:
            required = [name for name, deep in section.model_fields.items() if deep.is_required()]
            properties[key]["required"] = required
    about = " ".join((model.__doc__ or "").split())
    return {"type": "object", "description": about, "additionalProperties": False, "properties": properties}


def _key(field: FieldInfo, meaning: str) -> dict[str, Any]:
    limits, default, unit = range_of(field), default_of(field), unit_of(field)
    notes = [meaning, *([limits] if limits and unit else [])]
    entry: dict[str, Any] = {"description": "; ".join(notes), "examples": [_toml(example_of(field))]}
    if default:
        entry["default"] = default if unit else _toml(default)
    return entry | _kind(field)


def _kind(field: FieldInfo) -> dict[str, Any]:
    unit = unit_of(field)
    if unit is not None:
        return {"type": "array"} if unit.listed else {"type": "string", "pattern": QUANTITY}
    kinds: list[dict[str, Any]] = [{"enum": words_of(field)}] if words_of(field) else []
    for kind in members(field.annotation):
        if get_origin(kind) is tuple:
            return {"type": "array"}
        if kind is bool:
            kinds.append({"type": "boolean"})
        elif kind in (int, float):
            bounds = {
                NUMBERS[name]: getattr(c, name) for c in constraints(field) for name in NUMBERS if hasattr(c, name)
            }
            kinds.append({"type": "integer" if kind is int else "number", **bounds})
        elif kind is str and not words_of(field):
            kinds.append({"type": "string"})
    return kinds[0] if len(kinds) == 1 else {"anyOf": kinds}


def _toml(text: str) -> Any:
    return tomllib.loads(f"v = {text}")["v"]
