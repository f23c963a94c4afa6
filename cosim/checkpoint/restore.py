"""Plain data become objects again, over a twin: what the scenario builds, with the state that was kept.

Data bring no code: a class is one of this project that is loaded already, or that of the twin at the same place, and
what was code is the twin's at that place. An object that can change takes on its state where it is in the twin, so that
whoever holds it there (a function, a method) holds it still; each only once, since what the twin shares the state need
not share.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import is_dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cosim.checkpoint.arrays import read, seen
from cosim.checkpoint.graph import attributes, is_ours, name_of, own_state

MISSING = object()  #: no twin at this place


class StrangeError(ValueError):
    """Data that are no state of this twin."""


class Restore:
    """Reads the nodes of a `graph.Graph`."""

    def __init__(self, nodes: Sequence[Sequence[Any]], pieces: Sequence[NDArray[np.uint8]]) -> None:
        self._nodes, self._pieces = nodes, pieces
        self._made: dict[int, Any] = {}
        self._taken: set[int] = set()  # twins that are something already
        self._twins: list[object] = []

    def root(self, twin: object) -> Any:
        """The object at the root. StrangeError where data and twin do not fit each other."""
        try:
            return self._value([0], twin)
        except StrangeError:
            raise
        except (ValueError, TypeError, KeyError, IndexError, AttributeError, RecursionError, OverflowError) as error:
            raise StrangeError(f"{type(error).__name__}: {error}") from None

    def _value(self, value: Any, twin: Any) -> Any:
        if isinstance(value, dict):
            if twin is MISSING:
                raise StrangeError("a function that the scenario does not build")
            return twin
        if not isinstance(value, list):
            return value
        (number,) = value
        if number not in self._made:
            kind, *rest = self._nodes[number]
            make = getattr(self, f"_{kind}") if kind in KINDS else None
            if make is None:
                raise StrangeError(f"a node of kind {kind!r}")
            made = make(number, twin, *rest)
            self._made[number] = made
        return self._made[number]

    def _array(self, _number: int, _twin: Any, look: Sequence[Any]) -> Any:
        return seen(self._pieces, look)

    def _number(self, _number: int, _twin: Any, dtype: Any, content: str) -> Any:
        return np.frombuffer(bytes.fromhex(content), read(dtype))[0]

    def _bytes(self, _number: int, _twin: Any, content: str) -> Any:
        return bytes.fromhex(content)

    def _enum(self, _number: int, twin: Any, name: str, member: str) -> Any:
        cls = _class(name, twin)
        if not issubclass(cls, Enum):
            raise StrangeError(f"{name} is none")
        return cls[member]

    def _dict(self, number: int, twin: Any, pairs: Sequence[Sequence[Any]]) -> Any:
        old = dict(twin) if type(twin) is dict else {}
        new = self._made[number] = twin if self._takes(twin, dict) else {}
        new.clear()
        for key, value in pairs:
            name = self._value(key, MISSING)
            new[name] = self._value(value, old.get(name, MISSING))
        return new

    def _list(self, number: int, twin: Any, items: Sequence[Any]) -> Any:
        old = list(twin) if type(twin) is list else []
        new = self._made[number] = twin if self._takes(twin, list) else []
        new[:] = self._items(items, old)
        return new

    def _tuple(self, _number: int, twin: Any, items: Sequence[Any]) -> Any:
        return tuple(self._items(items, twin if type(twin) is tuple else ()))

    def _row(self, _number: int, twin: Any, name: str, items: Sequence[Any]) -> Any:
        cls = _class(name, twin)
        if not (issubclass(cls, tuple) and hasattr(cls, "_fields") and len(cls._fields) == len(items)):
            raise StrangeError(f"{name} has no {len(items)} fields")
        return tuple.__new__(cls, self._items(items, twin if type(twin) is cls else ()))

    def _items(self, items: Sequence[Any], old: Sequence[Any]) -> list[Any]:
        return [self._value(item, old[k] if k < len(old) else MISSING) for k, item in enumerate(items)]

    def _object(self, number: int, twin: Any, name: str, kept: dict[str, Any]) -> Any:
        cls = _class(name, twin)
        if issubclass(cls, tuple | type | BaseException):
            raise StrangeError(f"{name} is no object with attributes")
        old = attributes(twin) if type(twin) is cls else {}
        frozen = is_dataclass(cls) and cls.__dataclass_params__.frozen  # type: ignore[attr-defined]
        here = not frozen and self._takes(twin, cls)
        new = self._made[number] = twin if here else object.__new__(cls)
        state = {key: self._value(value, old.get(key, MISSING)) for key, value in kept.items()}
        if own_state(cls) and hasattr(new, "__setstate__"):
            new.__setstate__(state)
            return new
        if here and not own_state(cls):
            vars(new).clear() if hasattr(new, "__dict__") else None
        for key, value in state.items():
            object.__setattr__(new, key, value)
        return new

    def _takes(self, twin: Any, cls: type) -> bool:
        """Whether the twin itself becomes the object."""
        if type(twin) is not cls or id(twin) in self._taken:
            return False
        self._taken.add(id(twin))
        self._twins.append(twin)
        return True


KINDS = ("array", "number", "bytes", "enum", "dict", "list", "tuple", "row", "object")


def _class(name: str, twin: Any) -> type:
    """A class by its name: that of the twin, or one of this project that is loaded. Nothing is imported for it."""
    if name == name_of(type(twin)):
        return type(twin)
    module, _, path = name.partition(":")
    found: Any = sys.modules.get(module) if is_ours(module) else None
    for part in path.split("."):
        found = None if found is None or part.startswith("__") else vars(found).get(part)
    if not isinstance(found, type) or name_of(found) != name:
        raise StrangeError(f"a class {name!r}, which is none of this project")
    return found
