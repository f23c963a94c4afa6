"""What is wrong with a scenario, in one line: file, key, value, remedy."""

from __future__ import annotations

from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from cosim.errors import InputError
from cosim.nearest import nearest
from cosim.scenario.units import Unit

EXAMPLES = {
    "nodes": "[60, 60]",
    "back": '"held"',
    "kind": '"cone"',
    "title": '"..."',
    "friction": "0.1",
    "poisson_ratio": "0.3333333333333333",
}


class ScenarioError(InputError):
    """A scenario that cannot run. The message is one line that names file, key, value and what to do."""


def explain(
    error: ValidationError, model: type[BaseModel], file: str, raw: dict[str, Any], overridden: set[str]
) -> str:
    """One line for the first fault of a validation; says how many more there are."""
    faults = error.errors(include_url=False)
    first = faults[0]
    location = [str(part) for part in first["loc"] if not isinstance(part, int)]
    context: dict[str, Any] = first.get("ctx", {})
    if first["type"] == "check":
        location += str(context["key"]).split(".")
    key = ".".join(location)
    origin = "--set" if key in overridden else file
    more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
    return " ".join(f"{origin}: {key}{_remedy(first, location, model, raw)}{more}".split())


def _remedy(first: Any, location: list[str], model: type[BaseModel], raw: dict[str, Any]) -> str:
    value = _lookup(raw, location)
    shown = "" if value is None else f" = {value!r}"
    match first["type"]:
        case "extra_forbidden":
            return f": unknown key; {_nearest(model, location)}"
        case "missing":
            return f" is missing; add {_example(model, location)}"
        case "check" | "quantity" | "name":
            return f"{shown}: {first['msg']}"
        case "literal_error":
            return f"{shown}: use one of {first['ctx']['expected']}"
    return f"{shown}: {_lower(first['msg'])}"


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]


def _lookup(raw: Any, location: list[str]) -> Any:
    for part in location:
        if not isinstance(raw, dict) or part not in raw:
            return None
        raw = raw[part]
    return raw


def _sub_model(annotation: Any) -> type[BaseModel] | None:
    """The section class of a field, also if it is optional."""
    candidates = (annotation, *get_args(annotation))
    return next((c for c in candidates if isinstance(c, type) and issubclass(c, BaseModel)), None)


def _section(model: type[BaseModel], location: list[str]) -> type[BaseModel]:
    for part in location:
        field = model.model_fields.get(part)
        sub = _sub_model(field.annotation) if field else None
        if sub is None:
            break
        model = sub
    return model


def _keys(model: type[BaseModel], prefix: str = "") -> list[str]:
    """All keys of a scenario file with their sections."""
    keys: list[str] = []
    for name, field in model.model_fields.items():
        sub = _sub_model(field.annotation)
        keys += _keys(sub, f"{prefix}{name}.") if sub else [f"{prefix}{name}"]
    return keys


def _nearest(model: type[BaseModel], location: list[str]) -> str:
    """The known key that is meant most likely: the same one of another section, a near one of this section."""
    known = list(_section(model, location[:-1]).model_fields)
    elsewhere = [key for key in _keys(model) if key.split(".")[-1] == location[-1]]
    if elsewhere:
        return f"did you mean {elsewhere[0]}?"
    near = nearest(location[-1], known)
    if near:
        return f"did you mean {'.'.join([*location[:-1], near])}?"
    return f"known here: {', '.join(known)}"


def _example(model: type[BaseModel], location: list[str]) -> str:
    """The line that a user may add for a missing key."""
    field = _section(model, location[:-1]).model_fields[location[-1]]
    if _sub_model(field.annotation):
        return f"the section [{'.'.join(location)}]"
    unit = next((m for m in field.metadata if isinstance(m, Unit)), None)
    if unit is not None:
        return f"{location[-1]} = {unit.written}"
    return f"{location[-1]} = {EXAMPLES.get(location[-1], '...')}"
