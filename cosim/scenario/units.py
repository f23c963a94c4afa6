"""Quantities at the edge: a string with a unit becomes an SI float, and nothing else does.

Inside the program every number is SI, so this is the only file that knows other units. Scenario files say
``thickness = "3 m"`` or ``"300 cm"``; a bare ``3`` is refused, because a reader cannot tell what it means.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
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
    if isinstance(value, int | float) and not isinstance(value, bool):
        shown = f"{value} {'deg' if unit.si == 'rad' else unit.si}"  # nobody means 55 rad
        raise PydanticCustomError("quantity", f'a quantity needs its unit: write it as a string, for example "{shown}"')
    if not isinstance(value, str):
        raise _fault("a quantity needs its unit: write it as a string", unit)
    number, name = split(value, unit)
    try:
        units = _registry().Unit(name)
    except Exception:
        raise _fault("unknown unit; write number and unit", unit) from None
    _is_of_its_kind(units, unit)
    try:
        magnitude = float(_registry().Quantity(number, units).m_as(unit.si))
    except Exception:
        raise _fault(f"wrong unit, this quantity is measured in {unit.si}", unit) from None
    if not math.isfinite(magnitude):
        raise _fault("not a finite number", unit)
    return magnitude


def dimensions(si: str) -> tuple[Fraction, Fraction, Fraction]:
    """Powers of length, time and mass in a unit, in sixths at the finest."""
    powers = _registry().Unit(si).dimensionality
    found = (Fraction(powers.get(f"[{name}]", 0)).limit_denominator(6) for name in ("length", "time", "mass"))
    length, time, mass = found
    return length, time, mass


def si_of(text: str) -> float:
    """A quantity of the program itself in SI, whatever its kind."""
    number, name = split(text, Unit("SI", "1 m"))
    return float(_registry().Quantity(number, name).to_base_units().magnitude)


NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]{1,3})?"
_FACTOR = r"(?:[^\W\d_]+|°)(?:\s?(?:\^|\*\*)\s?-?\d(?:\.\d)?)?"
UNIT = rf"{_FACTOR}(?:(?:\s?[*/·]\s?|\s){_FACTOR}){{0,4}}"
QUANTITY = re.compile(rf"\s*({NUMBER})\s*({UNIT})\s*")
ANGLES = ("degree", "radian", "milliradian", "grade", "turn", "arcminute", "arcsecond")
LONGEST = 80  #: characters of a quantity


def split(text: str, unit: Unit) -> tuple[float, str]:
    """The one number and the one unit of a text; anything else is refused with what is wrong about it."""
    found = QUANTITY.fullmatch(text) if len(text) <= LONGEST else None
    if found is None:
        raise _fault(_what_is_wrong(text), unit)
    return float(found[1]), found[2]


def _what_is_wrong(text: str) -> str:
    """Why a text is no quantity. Nothing of it is computed."""
    plain = text.strip()
    number, rest = re.match(r"([-+]?[\d.,'_\s]*)(.*)", plain[:LONGEST], re.DOTALL).groups()  # type: ignore[union-attr]
    digits = number.strip()
    if len(text) > LONGEST:
        return f"not a quantity, it has {len(text)} characters; write one number and one unit"
    if re.match(r"[-+]?(nan|inf)", plain, re.IGNORECASE):
        return "not a finite number; write number and unit"
    if digits and not rest:
        return "a quantity needs its unit" if re.fullmatch(NUMBER, digits) else "not one number; write number and unit"
    if re.search(r"\d[\s'_]\d", digits) or ("," in digits and "." in digits) or digits.count(",") > 1:
        return "digits are not grouped, and a decimal point is a point"
    if re.fullmatch(r"[-+]?\d+,\d+", digits):
        return f"a comma is no decimal point; write {digits.replace(',', '.')} {rest}"
    if digits and rest.startswith("%"):
        return "% is no unit of a quantity"
    if (digits and rest[:1] in "*/^+-(") or digits.count(".") > 1:
        return "one number is wanted, nothing is computed"
    return "not a quantity; write number and unit"


def _is_of_its_kind(units: Any, unit: Unit) -> None:
    """An angle has a unit of angles, and nothing else has one: to the registry they are plain numbers, as % is."""
    names = [str(name) for name in units._units]
    plain = [name for name in names if not _registry().get_dimensionality(name)]
    if unit.si == "rad":
        if len(names) != 1 or plain != names or names[0] not in ANGLES or str(units) != names[0]:
            raise _fault("not a unit of angles", unit)
    elif plain:
        raise _fault(f"wrong unit, this quantity is measured in {unit.si}", unit)


def _fault(text: str, unit: Unit) -> PydanticCustomError:
    """What is wrong, and the example of this kind of quantity; `cosim.scenario.errors` puts that of the key there."""
    return PydanticCustomError("quantity", "{text}; for example {example}", {"text": text, "example": unit.written})


def _refused(text: str) -> PydanticCustomError:
    return PydanticCustomError("value", "{text}", {"text": text})


def _at_least_zero(value: float) -> float:
    if value < 0:
        raise _refused("must not be negative")
    return value


def _above_zero(value: float) -> float:
    if value <= 0:
        raise _refused("must be greater than zero")
    return value


def _any_sign(value: float) -> float:
    return value


def list_of(unit: Unit, *kinds: Any) -> Any:
    """A list of ``kinds``, of any number where the second is an ellipsis; read as a tuple."""

    def as_tuple(value: object) -> object:
        if not isinstance(value, list | tuple) or (not value if ... in kinds else len(value) != len(kinds)):
            count = "several" if ... in kinds else f"{len(kinds)}"
            raise _fault(f"write {count} values in brackets", unit)
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
AnyVelocity = _quantity("m/s", "0.1 m/s", _any_sign)
Height = _quantity("m", "-6 m", _any_sign)
VelocityOrZero = _quantity("m/s", "0.1 m/s", _at_least_zero)
Mass = _quantity("kg", "1200 t", _above_zero)
Inertia = _quantity("kg*m^2", "4e9 kg*m^2", _above_zero)
TranslationalStiffnessOrZero = _quantity("N/m", "6 MN/m", _at_least_zero)
TranslationalDampingOrZero = _quantity("N*s/m", "50 kN*s/m", _at_least_zero)
RotationalStiffnessOrZero = _quantity("N*m", "20 GN*m", _at_least_zero)
RotationalDampingOrZero = _quantity("N*m*s", "100 MN*m*s", _at_least_zero)
