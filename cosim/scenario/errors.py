"""What is wrong with a scenario, in one line: file, key, value, remedy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from cosim.errors import InputError
from cosim.nearest import nearest
from cosim.scenario.keys import example_of, field_of, model_of, sections

SHOWN = 60  #: characters of a value in a message


class ScenarioError(InputError):
    """A scenario that cannot run. The message is one line that names file, key, value and what to do.

    ``faults`` are all of them, one line each; the message tells the first.
    """

    def __init__(self, *faults: str) -> None:
        more = f" (and {len(faults) - 1} more: `cosim check` tells all)" if len(faults) > 1 else ""
        super().__init__(faults[0] + more)
        self.faults = faults


class Source:
    """Where the values of a scenario stand: which file has which key, and what was set over it."""

    def __init__(self, main: str, files: Mapping[str, str], overridden: set[str]) -> None:
        self._main, self._files, self._overridden = main, files, overridden

    def of(self, key: str) -> str:
        """The file to change, or ``--set``."""
        for head in _heads(key):
            if head in self._overridden:
                return "--set"
            if head in self._files:
                return self._files[head]
        inside = (file for name, file in self._files.items() if name.startswith(f"{key}."))
        return next(inside, self._main)


def _heads(key: str) -> list[str]:
    parts = key.split(".")
    return [".".join(parts[:n]) for n in range(len(parts), 0, -1)]


def key_path(error: Any, model: type[BaseModel]) -> list[str]:
    """The key that an error of a validation is about, as it stands in a file."""
    path: list[str] = []
    for part in error["loc"]:
        if isinstance(part, int):
            break
        path.append(str(part))
        field = field_of(model, path)
        if field is None or model_of(field.annotation) is None:
            break
    if error["type"] == "check":
        path += str(error["ctx"]["key"]).split(".")
    return path


def describe(error: Any, model: type[BaseModel], raw: dict[str, Any], source: Source) -> str:
    """One line for one fault."""
    path = key_path(error, model)
    key = ".".join(path)
    return " ".join(f"{source.of(key)}: {_printable(key)}{_remedy(error, path, model, raw)}".split())


def _remedy(error: Any, path: list[str], model: type[BaseModel], raw: dict[str, Any]) -> str:
    value = _lookup(raw, path)
    shown = "" if value is None else f" = {short(value)}"
    field, context = field_of(model, path), error.get("ctx", {})
    match error["type"]:
        case "extra_forbidden":
            return f": unknown key; {_nearest(model, path)}"
        case "missing":
            return f" is missing; add {_example(model, path)}"
        case "quantity" if "example" in context and field is not None:
            return f"{shown}: {context['text']}; for example {example_of(field)}"
        case "range":
            return f"{shown}: {error['msg']}{_slip(value)}"
        case "check" | "quantity" | "name" | "value":
            return f"{shown}: {error['msg']}"
        case "literal_error":
            return f"{shown}: use one of {error['ctx']['expected']}"
        case "model_type":
            return f"{shown}: is a section; write it as [{'.'.join(path)}] with its keys below"
    return f"{shown}: {_lower(error['msg'])}"


def _slip(value: Any) -> str:
    """What a value outside of its range was meant to be, if a letter says so."""
    if isinstance(value, str) and "mPa" in value:
        return f', did you mean "{value.replace("mPa", "MPa")}"?'
    return ""


def short(value: Any) -> str:
    """A value of a file as it is shown: one line, printable, not too long."""
    if isinstance(value, int) and abs(value) >= 10**40:
        return "a whole number of more than 40 digits"
    text = ascii(value) if not isinstance(value, str) or not value.isprintable() else repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def _printable(text: str) -> str:
    text = text if text.isprintable() else ascii(text)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]


def _lookup(raw: Any, path: list[str]) -> Any:
    for part in path:
        if not isinstance(raw, dict) or part not in raw:
            return None
        raw = raw[part]
    return raw


def _section(model: type[BaseModel], path: list[str]) -> type[BaseModel]:
    for part in path:
        field = model.model_fields.get(part)
        inner = model_of(field.annotation) if field else None
        if inner is None:
            break
        model = inner
    return model


def _keys(model: type[BaseModel]) -> list[str]:
    """All keys of a scenario file with their sections."""
    return [
        f"{name}.{key}"
        for name, section in sections(model)
        for key, field in section.model_fields.items()
        if model_of(field.annotation) is None
    ]


def _nearest(model: type[BaseModel], path: list[str]) -> str:
    """The known key that is meant most likely: the same one of another section, a near one of this section."""
    known = list(_section(model, path[:-1]).model_fields)
    elsewhere = [key for key in _keys(model) if key.split(".")[-1] == path[-1]]
    if elsewhere:
        return f"did you mean {elsewhere[0]}?"
    near = nearest(path[-1][:SHOWN], known)
    if near:
        return f"did you mean {'.'.join([*path[:-1], near])}?"
    return f"known here: {', '.join(known)}"


def _example(model: type[BaseModel], path: list[str]) -> str:
    """The line that a user may add for a missing key."""
    field = _section(model, path[:-1]).model_fields[path[-1]]
    if model_of(field.annotation):
        return f"the section [{'.'.join(path)}]"
    return f"{path[-1]} = {example_of(field)}"
