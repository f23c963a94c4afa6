"""The keys of a scenario file, from the models that read it: meaning, unit, range, default, example.

One source for `cosim keys`, for the schema of editors, for messages and for the reference on the site. Meanings are the
comments ``#:`` that stand beside the fields.
"""

from __future__ import annotations

import ast
import inspect
import tomllib
import types
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from math import degrees
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from cosim.scenario.limits import Limits
from cosim.scenario.names import OneOf
from cosim.scenario.units import Unit


@dataclass(frozen=True)
class Key:
    """One key of a scenario file."""

    name: str  #: with its section
    field: FieldInfo
    meaning: str

    @property
    def unit(self) -> Unit | None:
        """What it is measured in; None for what is no quantity."""
        return unit_of(self.field)

    @property
    def about(self) -> str:
        """The meaning without the unit that stands at its end."""
        text = self.meaning.strip()
        return text[: text.rindex("[")].strip() if self.unit and text.endswith("]") and "[" in text else text


def keys_of(model: type[BaseModel]) -> list[Key]:
    """Every key of a file, in its order."""
    found = []
    for name, section in sections(model):
        words = meanings(section)
        for key, field in section.model_fields.items():
            if model_of(field.annotation) is None:
                if not words.get(key):
                    raise ValueError(
                        f"scenario key {name}.{key} has no meaning: write a comment #: beside it in {section}"
                    )
                found.append(Key(f"{name}.{key}", field, words[key]))
    return found


def sections(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, type[BaseModel]]]:
    """Every table of a scenario file: its name and its model."""
    for name, field in model.model_fields.items():
        inner = model_of(field.annotation)
        if inner is not None:
            yield prefix + name, inner
            yield from sections(inner, f"{prefix}{name}.")


def model_of(annotation: Any) -> type[BaseModel] | None:
    """The section class of a field, also if it is optional."""
    for kind in (annotation, *get_args(annotation)):
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            return kind
    return None


@cache
def meanings(model: type[BaseModel]) -> dict[str, str]:
    """The comments ``#:`` at the end of a field's line and on the lines before it, by field."""
    lines = inspect.getsource(model).splitlines()
    tree = ast.parse("\n".join(lines))
    body = tree.body[0]
    assert isinstance(body, ast.ClassDef)
    found = {}
    for item in body.body:
        if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name) and item.end_lineno:
            first = item.lineno - 1
            while lines[first - 1].strip().startswith("#:"):
                first -= 1
            texts = [line.partition("#:")[2] for line in lines[first : item.end_lineno]]
            found[item.target.id] = " ".join(" ".join(texts).split())
    return found


def field_of(model: type[BaseModel], path: list[str]) -> FieldInfo | None:
    """The field that a key names; None if there is none."""
    field: FieldInfo | None = None
    for part in path:
        field = model.model_fields.get(part)
        inner = model_of(field.annotation) if field else None
        if inner is None:
            return field if part == path[-1] else None
        model = inner
    return field


def members(annotation: Any) -> list[Any]:
    """The members of a union, without their annotations."""
    if get_origin(annotation) is Annotated:
        return members(get_args(annotation)[0])
    if get_origin(annotation) in (Union, types.UnionType):
        return [kind for part in get_args(annotation) for kind in members(part)]
    return [annotation]


def constraints(field: FieldInfo) -> list[Any]:
    """What is attached to a field and to the members of its union."""
    inner = [
        m
        for part in (field.annotation, *get_args(field.annotation))
        if get_origin(part) is Annotated
        for m in get_args(part)[1:]
    ]
    return [n for m in (*field.metadata, *inner) for n in getattr(m, "metadata", [m])]


def unit_of(field: FieldInfo) -> Unit | None:
    """Unit of a quantity, with the example of its key."""
    found = constraints(field)
    unit = next((m for m in found if isinstance(m, Unit)), None)
    limits = next((m for m in found if isinstance(m, Limits)), None)
    return unit if unit is None or limits is None else replace(unit, example=limits.example)


def words_of(field: FieldInfo) -> list[str]:
    """The words that may stand there; none for what is no choice."""
    words = [str(w) for kind in members(field.annotation) if get_origin(kind) is Literal for w in get_args(kind)]
    table = next((m for m in constraints(field) if isinstance(m, OneOf)), None)
    return [*words, *(table.table() if table else ())]


def kinds_of(field: FieldInfo) -> list[str]:
    """What may be written where no quantity stands: words as TOML, else what kind of value."""
    words = words_of(field)
    found = [f'"{word}"' for word in words]
    for kind in members(field.annotation):
        if get_origin(kind) is tuple:
            found.append(example_of(field))
        elif kind is bool:
            found += ["true", "false"]
        elif kind in (int, float) or (kind is str and not words):
            found.append({int: "whole number", float: "number", str: "text"}[kind])
    return found


def range_of(field: FieldInfo) -> str:
    """Limits of a value as text; empty without any."""
    found = constraints(field)
    limits = next((m for m in found if isinstance(m, Limits)), None)
    if limits is not None:
        return f"{limits.low} to {limits.high}"
    signs = {"ge": ">=", "gt": ">", "le": "<=", "lt": "<"}
    return " and ".join(f"{signs[name]} {getattr(c, name):g}" for c in found for name in signs if hasattr(c, name))


def default_of(field: FieldInfo) -> str | None:
    """The default as it would be written; empty where there is none or it follows from others, None if required."""
    if field.is_required():
        return None
    if field.default is None or field.default == "":
        return ""
    unit = unit_of(field)
    if unit is not None:
        return f"{degrees(field.default):g} deg" if unit.si == "rad" else f"{field.default:g} {unit.si}"
    default = list(field.default) if isinstance(field.default, tuple) else field.default
    return repr(default).replace("'", '"').replace("True", "true").replace("False", "false")


def example_of(field: FieldInfo) -> str:
    """TOML that may stand there."""
    unit = unit_of(field)
    if unit is not None:
        return unit.written
    examples = [e for e in (field.examples or []) if e is not None]
    words = words_of(field)
    if examples or words:
        shown = examples[0] if examples else words[0]
        return f'"{shown}"' if isinstance(shown, str) else repr(shown)
    return default_of(field) or "..."


def example_value(field: FieldInfo) -> Any:
    """The value of that TOML."""
    return tomllib.loads(f"v = {example_of(field)}")["v"]
