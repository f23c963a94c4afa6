"""Setting objects back to an earlier moment.

An attribute is remembered by reference, which costs nothing: states, factorisations and low-rank updates are replaced
when they change and never written to. The few attributes that are written to in place (masks, lists, books) are copied.
"""

from __future__ import annotations

from copy import copy
from typing import Any

Memory = list[tuple[Any, dict[str, Any], tuple[str, ...]]]  #: objects, their attributes, names of those copied


def remember(thing: object, *written: str) -> Memory:
    """All attributes of an object now; ``written`` names those that are written to in place."""
    return [(thing, {**vars(thing), **{name: copy(getattr(thing, name)) for name in written}}, written)]


def recall(memory: Memory) -> None:
    """Sets the objects back, as often as one likes: what is written to in place is copied again."""
    for thing, values, written in memory:
        own: dict[str, Any] = thing.__dict__
        own.clear()
        own.update(values)
        own.update({name: copy(values[name]) for name in written})
