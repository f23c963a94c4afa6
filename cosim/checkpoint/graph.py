"""Objects as plain data: what holds what, in numbers, texts and pieces of memory.

Every object that is met for the first time becomes a node; what is met again is the same node again, so that what two
objects share they still share when they are read back. A value is a number, a text, None, ``[n]`` for node n, or ``{}``
for what is given: code (functions, methods, classes) is never kept, who reads brings it along.
"""

from __future__ import annotations

import types
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import partial
from typing import Any

import numpy as np

from cosim.checkpoint.arrays import Memory, written

Value = Any  #: see above
GIVEN: dict[str, Any] = {}
CODE = (types.FunctionType, types.BuiltinFunctionType, types.MethodType, types.ModuleType, type, partial, np.ufunc)
PACKAGES = ("cosim", "coupling", "lattice", "rubble")  #: whose classes may tell what of them is kept
HEAP = 1 << 9  #: flag of a class that is written in Python


class UnknownKindError(TypeError):
    """An object that cannot be kept; the message tells its class, and the way to it."""


@dataclass
class Graph:
    """Nodes, the first of which is the root, and memory."""

    nodes: list[list[Any]] = field(default_factory=list)
    memory: Memory = field(default_factory=Memory)


def graph_of(root: object) -> Graph:
    """All that can be reached from ``root``; UnknownKindError where something cannot be kept."""
    walk = _Walk()
    walk.value(root, "")
    return walk.graph


def attributes(thing: Any) -> dict[str, Any]:
    """Of an object, those in slots included, in their order."""
    slots = (name for cls in reversed(type(thing).__mro__) for name in getattr(cls, "__slots__", ()))
    held = {name: getattr(thing, name) for name in slots if hasattr(thing, name) and not name.startswith("__")}
    return {**held, **getattr(thing, "__dict__", {})}


def own_state(cls: type) -> bool:
    """Whether instances tell themselves what of them is kept; those of dataclasses with slots tell their fields."""
    own: Any = cls.__getstate__
    return own is not object.__getstate__ and own.__module__ != "dataclasses"


def is_ours(module: str) -> bool:
    """Whether a module is one of this project."""
    return module.split(".")[0] in PACKAGES


def name_of(cls: type) -> str:
    """By which a class is found again."""
    return f"{cls.__module__}:{cls.__qualname__}"


class _Walk:
    def __init__(self) -> None:
        self.graph = Graph()
        self._number: dict[int, int] = {}
        self._met: list[object] = []  # kept, so that no other object takes over their identity

    def value(self, thing: Any, way: str) -> Value:
        """A thing as a value; ``way`` leads to it from the root."""
        if thing is None or type(thing) in (bool, int, float, str):
            return thing
        if isinstance(thing, CODE):
            return GIVEN
        if id(thing) not in self._number:
            self._number[id(thing)] = len(self.graph.nodes)
            self._met.append(thing)
            node: list[Any] = []
            self.graph.nodes.append(node)
            node.extend(self._node(thing, way))
        return [self._number[id(thing)]]

    def _node(self, thing: Any, way: str) -> Iterator[Any]:
        cls = type(thing)
        try:
            if cls is np.ndarray:
                yield from ("array", self.graph.memory.look(thing))
            elif isinstance(thing, np.generic):
                yield from ("number", written(thing.dtype), thing.tobytes().hex())
            elif cls is bytes:
                yield from ("bytes", thing.hex())
            elif isinstance(thing, Enum):
                yield from ("enum", name_of(cls), thing.name)
            else:
                yield from self._holder(thing, cls, way)
        except ValueError as error:
            raise UnknownKindError(f"{error} at {way.lstrip('.')}") from None

    def _holder(self, thing: Any, cls: type, way: str) -> Iterator[Any]:
        """Of something that holds other things."""
        if cls is dict:
            keys = [self.value(key, f"{way}[key]") for key in thing]
            values = [self.value(value, f"{way}[{key!r}]") for key, value in thing.items()]
            yield from ("dict", [list(pair) for pair in zip(keys, values, strict=True)])
        elif cls in (list, tuple):
            yield from (cls.__name__, self._items(thing, way))
        elif issubclass(cls, tuple) and hasattr(cls, "_fields"):
            yield from ("row", name_of(cls), self._items(thing, way))
        elif all(c.__flags__ & HEAP for c in cls.__mro__[:-1]) and (not own_state(cls) or is_ours(cls.__module__)):
            kept = thing.__getstate__() if own_state(cls) else attributes(thing)
            yield from ("object", name_of(cls), {k: self.value(v, f"{way}.{k}") for k, v in kept.items()})
        else:
            raise ValueError(f"an object of {name_of(cls)}")

    def _items(self, items: Iterable[Any], way: str) -> list[Value]:
        return [self.value(item, f"{way}[{k}]") for k, item in enumerate(items)]
