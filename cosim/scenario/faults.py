"""All faults of a scenario at once.

A key that cannot be read hides nothing: it is replaced by its default or its example, so that the others are read, and
a rule that has looked at such a value is not believed.
"""

from __future__ import annotations

import copy
import types
from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from cosim.scenario.errors import Source, describe, key_path
from cosim.scenario.keys import example_value, field_of, model_of
from cosim.scenario.model import WITHOUT_RULES, ScenarioModel
from cosim.scenario.rules.table import RULES
from cosim.scenario.section import Section

ROUNDS = 6  #: of replacing; a section, its keys, and what stands in them


def faults_of(raw: dict[str, Any], source: Source) -> list[str]:
    """One line for each fault of a parsed file, in the order of the keys and then of the rules."""
    table, replaced, lines = copy.deepcopy(raw), set[str](), list[str]()
    for _ in range(ROUNDS):
        try:
            model = ScenarioModel.model_validate(table, context=WITHOUT_RULES)
        except ValidationError as error:
            faults = {".".join(key_path(e, ScenarioModel)): e for e in reversed(error.errors(include_url=False))}
            for key, fault in reversed(faults.items()):
                if not _inside(key, replaced):
                    lines.append(describe(fault, ScenarioModel, raw, source))
                _replace(table, key.split("."), fault["type"])
            replaced |= set(faults)
            continue
        lines += [describe(fault, ScenarioModel, raw, source) for fault in _broken(model, replaced)]
        break
    return list(dict.fromkeys(lines))


def _inside(key: str, places: set[str]) -> bool:
    """Whether a key is one of these, or lies in a section that is."""
    return any(key == place or key.startswith(f"{place}.") for place in places)


def _replace(table: dict[str, Any], path: list[str], kind: str) -> None:
    """Puts a value in the place that can be read: none, an empty section, the example."""
    for part in path[:-1]:
        table = table[part]
    field = field_of(ScenarioModel, path) if len(path) > 1 else ScenarioModel.model_fields.get(path[0])
    if kind == "extra_forbidden" or field is None or not field.is_required():
        del table[path[-1]]
    elif model_of(field.annotation) is not None:
        table[path[-1]] = {}
    else:
        table[path[-1]] = example_value(field)


def _broken(model: ScenarioModel, replaced: set[str]) -> Iterator[dict[str, Any]]:
    """What the rules find, but for those that have looked at a value that is not the user's."""
    for rule in RULES:
        seen: set[str] = set()
        found = list(rule(Watched(model, seen)))
        if any(_inside(key, replaced) for key in seen):
            continue
        for fault in found:
            yield {"type": fault.type, "loc": (), "msg": fault.message(), "ctx": fault.context}


class Watched:
    """A section that notes which of its keys are read."""

    def __init__(self, section: Section, seen: set[str], prefix: str = "") -> None:
        self._section, self._seen, self._prefix = section, seen, prefix

    def __getattr__(self, name: str) -> Any:
        own = getattr(type(self._section), name, None)
        if isinstance(own, property):
            return own.fget(self)  # type: ignore[misc]
        if isinstance(own, types.FunctionType):
            return types.MethodType(own, self)
        value = getattr(self._section, name)
        if isinstance(value, Section):
            return Watched(value, self._seen, f"{self._prefix}{name}.")
        self._seen.add(self._prefix + name)
        return value
