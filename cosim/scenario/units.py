"""Quantities at the edge: a string with a unit becomes an SI float, and nothing else does.

Inside the program every number is SI, so this is the only file that knows other units. Scenario files say
``thickness = "3 m"`` or ``"300 cm"``; a bare ``3`` is refused, because a reader cannot tell what it means.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from types import GenericAlias
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator
from pydantic_core import PydanticCustomError


@dataclass(frozen=True, slots=True)
class Unit:
    """What a field is measured in: its SI unit and an example that a message can show."""

    si: str  #: unit of the stored float
    example: str  #: a value that a user may write
    listed: str = ""  #: for a key that holds several of them: TOML that a user may write

    @property
    def written(self) -> str:
        """TOML of an example."""
        return self.listed or f'"{self.example}"'


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(cache_folder=None)


def to_si(value: object, unit: Unit) -> float:
    """``"8.7 GPa"`` -> 8.7e9. Floats come from defaults and derived values only, never from a file."""
    if isinstance(value, bool) or not isinstance(value, str):
        shown = f"{value} {unit.si}" if isinstance(value, int | float) and not isinstance(value, bool) else unit.example
        raise _fault(f'a quantity needs its unit: write it as a string, for example "{shown}"')
    quantity = _parse(value, unit)
    try:
        magnitude = float(quantity.m_as(unit.si))
    except Exception:
        raise _fault(f'wrong unit, this quantity is measured in {unit.si}: for example "{unit.example}"') from None
    if not math.isfinite(magnitude):
        raise _fault(f'not a finite number; for example "{unit.example}"')
    return magnitude


def _parse(text: str, unit: Unit) -> Any:
    """The pint quantity of a text; a text without unit, or with an unknown one, is refused."""
    remedy = f'write number and unit, for example "{unit.example}"'
    if not re.match(r"\s*[-+]?\.?(\d|nan|inf)", text):
        raise _fault(f"not a quantity; {remedy}")
    try:
        quantity = _registry().Quantity(text)
        has_unit = bool(quantity._units)
    except Exception as error:
        name = type(error).__name__
        problem = "unknown unit" if name == "UndefinedUnitError" else "not a quantity"
        raise _fault(f"{problem}; {remedy}") from None
    if not has_unit:
        raise _fault(f'a quantity needs its unit; for example "{unit.example}"')
    return quantity


def _fault(text: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{text}", {"text": text})


def _at_least_zero(value: float) -> float:
    if value < 0:
        raise _fault("must not be negative")
    return value


def _above_zero(value: float) -> float:
    if value <= 0:
        raise _fault("must be greater than zero")
    return value


def _any_sign(value: float) -> float:
    return value


def _list_of(unit: Unit, *kinds: Any) -> Any:
    """A list of ``kinds``, of any number where the second is an ellipsis; read as a tuple."""

    def as_tuple(value: object) -> object:
        if not isinstance(value, list | tuple) or (... not in kinds and len(value) != len(kinds)):
            count = "several" if ... in kinds else f"{len(kinds)}"
            raise _fault(f"write {count} values in brackets, for example {unit.written}")
        return tuple(value)

    return Annotated[GenericAlias(tuple, kinds), unit, BeforeValidator(as_tuple)]


def _quantity(si: str, example: str, check: Callable[[float], float]) -> Any:
    unit = Unit(si, example)
    return Annotated[float, unit, AfterValidator(check), BeforeValidator(lambda value: to_si(value, unit))]


# Types of the fields of a scenario: SI floats, read from strings with unit.
Length = _quantity("m", "3 m", _above_zero)
Toughness = _quantity("Pa*m^0.5", "110 kPa*m^0.5", _above_zero)
Time = _quantity("s", "50 ms", _above_zero)
TimeOrZero = _quantity("s", "1 ms", _at_least_zero)
Velocity = _quantity("m/s", "0.1 m/s", _above_zero)
Acceleration = _quantity("m/s^2", "9.81 m/s^2", _above_zero)
Density = _quantity("kg/m^3", "917 kg/m^3", _above_zero)
Stress = _quantity("Pa", "750 kPa", _above_zero)
Force = _quantity("N", "375 kN", _above_zero)
Angle = _quantity("rad", "45 deg", _above_zero)
AngleOrZero = _quantity("rad", "30 deg", _at_least_zero)
StressOrZero = _quantity("Pa", "0 kPa", _at_least_zero)
LengthOrZero = _quantity("m", "19 m", _at_least_zero)
EnergyPerAreaOrZero = _quantity("J/m^2", "15 J/m^2", _at_least_zero)
VolumeOrZero = _quantity("m^3", "3000 m^3", _at_least_zero)
_AnyVelocity = _quantity("m/s", "0.1 m/s", _any_sign)
_Height = _quantity("m", "-6 m", _any_sign)
PlanVelocity = _list_of(Unit("m/s", "0.1 m/s", '["0.1 m/s", "0 m/s"]'), _AnyVelocity, _AnyVelocity)
_Point = _list_of(Unit("m", "-6 m", '["-6 m", "9 m"]'), _Height, LengthOrZero)
ProfilePoints = _list_of(Unit("m", "-6 m", '[["-6 m", "9 m"], ["5 m", "20 m"]]'), _Point, ...)
