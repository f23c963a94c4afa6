"""Variants of a scenario: which values are varied, and which runs that makes.

``--vary a.b=v1,v2`` gives a key and its values. They are separated by commas outside brackets and quotes, so that lists
are values too: ``sheet.nodes=[40,40],[60,60]``; a value may carry its unit: ``contact.strength=200 kPa,2 MPa``.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from cosim.errors import InputError

OPEN, CLOSE = "[{(", "]})"


@dataclass(frozen=True)
class Axis:
    """One key and the values that it takes, as text."""

    key: str
    values: tuple[str, ...]


@dataclass(frozen=True)
class Variant:
    """One run: what it changes against the base, as key and value; the base changes nothing."""

    changes: tuple[tuple[str, str], ...] = ()

    @property
    def name(self) -> str:
        """For tables and messages."""
        return ", ".join(f"{key} = {value}" for key, value in self.changes) or "base"

    @property
    def overrides(self) -> tuple[str, ...]:
        """Its changes as the command line takes them, ``a.b=v``."""
        return tuple(f"{key}={value}" for key, value in self.changes)


def parse_axis(text: str) -> Axis:
    """From ``a.b=v1,v2``."""
    key, equals, values = text.partition("=")
    key = key.strip()
    if not equals or "." not in key or not all(key.split(".")):
        raise InputError(
            f"--vary {text}: not of the form section.key=value,value; for example --vary 'ice.thickness=2 m,3 m'"
        )
    found = split_values(values)
    if not all(found):
        raise InputError(f"--vary {text}: an empty value; separate values by one comma each")
    if len(set(found)) < len(found):
        raise InputError(f"--vary {text}: a value stands there twice; give each once")
    return Axis(key, tuple(found))


def split_values(text: str) -> list[str]:
    """Parts of a text between commas outside brackets and quotes, without blanks around them."""
    parts, part, depth, quote = [], "", 0, ""
    for c in text:
        if quote:
            quote = "" if c == quote else quote
        elif c in "'\"":
            quote = c
        else:
            depth += (c in OPEN) - (c in CLOSE)
        if c == "," and depth == 0 and not quote:
            parts.append(part.strip())
            part = ""
        else:
            part += c
    if depth != 0 or quote:
        raise InputError(f"--vary ...={text}: a bracket or a quote is not closed; close it")
    return [*parts, part.strip()]


def variants(axes: Sequence[Axis], grid: bool) -> list[Variant]:
    """The base first; then each value on its own, or every combination of one value of each key."""
    keys = [axis.key for axis in axes]
    if len(set(keys)) < len(keys):
        raise InputError(f"--vary: {max(keys, key=keys.count)} is given twice; put all its values into one --vary")
    choices = [[(axis.key, value) for value in axis.values] for axis in axes]
    if grid:
        return [Variant(), *(Variant(changes) for changes in itertools.product(*choices))]
    return [Variant(), *(Variant((change,)) for choice in choices for change in choice)]
