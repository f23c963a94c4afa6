"""Variants of a scenario: which values are varied.

``--vary a.b=v1,v2`` gives a key and its values. They are separated by commas outside brackets and quotes, so that lists
are values too: ``sheet.nodes=[40,40],[60,60]``; a value may carry its unit: ``contact.strength=200 kPa,2 MPa``.
``--vary a.b=v1..v2`` gives a range, from which a design draws.
"""

from __future__ import annotations

from dataclasses import dataclass

from pydantic_core import PydanticCustomError

from cosim.errors import InputError
from cosim.scenario.keys import field_of, members, unit_of
from cosim.scenario.model import ScenarioModel
from cosim.scenario.units import Unit, to_si

OPEN, CLOSE = "[{(", "]})"
SEED = "scenario.seed"  #: the key that an ensemble varies
BASE = "base"  #: name of the variant that changes nothing, or its seed only


@dataclass(frozen=True)
class Axis:
    """One key and the values that it takes, as text."""

    key: str
    values: tuple[str, ...]


@dataclass(frozen=True)
class Range:
    """One key and the ends between which it lies."""

    key: str
    low: float  #: [SI]
    high: float  #: [SI]
    unit: str  #: SI unit as a scenario writes it; empty for a plain number

    def text(self, value: float) -> str:
        """A value [SI] as a scenario writes it, to the last bit."""
        return f"{value!r} {self.unit}".strip()


@dataclass(frozen=True)
class Variant:
    """One run: what it changes against the base, as key and value; the base changes nothing."""

    changes: tuple[tuple[str, str], ...] = ()

    @property
    def name(self) -> str:
        """For tables and messages."""
        return _name(self.changes)

    @property
    def group(self) -> str:
        """The name without the seed: runs of a group differ in what is random only."""
        return _name(tuple(change for change in self.changes if change[0] != SEED))

    @property
    def seed(self) -> str | None:
        """The seed that it sets."""
        return dict(self.changes).get(SEED)

    @property
    def overrides(self) -> tuple[str, ...]:
        """Its changes as the command line takes them, ``a.b=v``."""
        return tuple(f"{key}={value}" for key, value in self.changes)


def _name(changes: tuple[tuple[str, str], ...]) -> str:
    return ", ".join(f"{key} = {value}" for key, value in changes) or BASE


def parse_axis(text: str) -> Axis | Range:
    """From ``a.b=v1,v2`` or ``a.b=v1..v2``."""
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
    if len(found) == 1 and ".." in found[0]:
        return _range(text, key, *found[0].partition("..")[::2])
    return Axis(key, tuple(found))


def _range(text: str, key: str, low: str, high: str) -> Range:
    """A range of a key that holds a number."""
    field = field_of(ScenarioModel, key.split("."))
    if field is None:
        raise InputError(f"--vary {text}: there is no key {key}; `cosim keys` lists them")
    unit = unit_of(field)
    if unit is None and float not in members(field.annotation):
        raise InputError(f"--vary {text}: {key} is no real number, it has no range; list its values with commas")
    ends = [_number(f"--vary {text}", end.strip(), unit) for end in (low, high)]
    if not ends[0] < ends[1]:
        raise InputError(f"--vary {text}: a range goes from the lower to the higher value; turn it round")
    return Range(key, ends[0], ends[1], unit.si if unit else "")


def _number(where: str, text: str, unit: Unit | None) -> float:
    try:
        return float(text) if unit is None else to_si(text, unit)
    except PydanticCustomError as error:
        raise InputError(f"{where}: {text}: {error.message()}") from None
    except ValueError:
        raise InputError(f"{where}: {text} is no number; for example 0.1..0.3") from None


def si_value(key: str, text: str) -> float | None:
    """A value of a key as number [SI]; None where it is none."""
    field = field_of(ScenarioModel, key.split("."))
    unit = unit_of(field) if field else None
    try:
        return float(text) if unit is None else to_si(text, unit)
    except (ValueError, PydanticCustomError):
        return None


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
