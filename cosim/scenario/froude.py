"""Froude copies: a scenario at another scale, every quantity with a unit multiplied as its dimension says.

Lengths by lambda, times by lambda^(1/2), masses by lambda^3, at the same density, gravity, Poisson's ratio and friction
(van Vliet 2018, Table A4-1): forces by lambda^3, stresses and E by lambda, toughness by lambda^(3/2), energy per area
by lambda^2. Exact: fractions, and a root of 50 digits where lambda is no square.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from typing import Any

from pydantic import BaseModel

from cosim.scenario.errors import ScenarioError
from cosim.scenario.scenario import Scenario
from cosim.scenario.text import complete, to_toml
from cosim.scenario.units import Unit, dimensions, split

DIGITS = Context(prec=50)
NS = 10**9
#: whole multiples of the first
MULTIPLES = (
    ("rubble", "substep"),
    ("coupling", "window"),
    ("coupling", "shortest_window"),
    ("coupling", "longest_window"),
    ("recording", "every"),
    ("scenario", "duration"),
)


@dataclass(frozen=True)
class Scaled:
    """One quantity: its key, how it was written and is now, and the power of lambda."""

    key: str
    before: str
    after: str
    power: Fraction


@dataclass(frozen=True)
class Copy:
    """A Froude copy as text, with what was done."""

    text: str
    quantities: tuple[Scaled, ...]
    told: tuple[str, ...]


def factor_of(text: str) -> Fraction:
    """``36``, ``0.5`` or ``1/36``: lengths of the copy over those of the case."""
    try:
        factor = Fraction(text.replace(":", "/").strip())
    except (ValueError, ZeroDivisionError):
        raise ScenarioError(f"factor {text!r} is no number; give for example 36 or 1/36") from None
    if not Fraction(1, 10**6) <= factor <= 10**6:
        raise ScenarioError(f"factor {text} is not between 1e-6 and 1e6; give for example 36 or 1/36")
    return factor


def power_of(si: str) -> Fraction:
    """Power of lambda of a quantity: ``L + T/2 + 3 M`` of its dimensions."""
    length, time, mass = dimensions(si)
    return length + time / 2 + 3 * mass


def multiplier(factor: Fraction, power: Fraction) -> Fraction:
    """``factor^power`` for powers in halves."""
    root = Fraction(math.isqrt(factor.numerator), math.isqrt(factor.denominator))
    if root * root != factor:
        root = Fraction((Decimal(factor.numerator) / Decimal(factor.denominator)).sqrt(DIGITS))
    return Fraction(factor ** math.floor(power) * (root if power.denominator == 2 else 1))


def froude_copy(scenario: Scenario, factor: Fraction) -> Copy:
    """The scenario at ``factor`` times its lengths, all defaults written out, as they may have dimensions."""
    done: list[Scaled] = []
    table = _scaled(complete(scenario.raw, scenario.model), scenario.model, factor, "", done)
    told = _whole_nanoseconds(table, scenario, factor)
    if scenario.model.rubble.friction_ice_ice == "rate-dependent":
        told.append("rubble.friction_ice_ice: rate-dependent friction knows a velocity and does not scale")
    motion = scenario.model.structure.motion
    if motion is not None and motion.file:
        told.append(f"structure.motion.file = {motion.file}: what it holds is in SI and is not scaled")
    told += [f"{key} = {name}: what it holds is in SI and is not scaled" for key, name in scenario.named_files]
    head = f"# Froude copy of {scenario.name}: lengths by {factor}, times by its root, masses by its cube.\n\n"
    return Copy(head + to_toml(table), tuple(done), tuple(told))


def _scaled(
    table: dict[str, Any], model: BaseModel, factor: Fraction, prefix: str, done: list[Scaled]
) -> dict[str, Any]:
    out = {}
    for name, value in table.items():
        field, key = type(model).model_fields[name], f"{prefix}{name}"
        inner = getattr(model, name)
        unit = next((m for m in field.metadata if isinstance(m, Unit)), None) or _unit_of(field.annotation)
        if isinstance(inner, BaseModel):
            out[name] = _scaled(value, inner, factor, f"{key}.", done)
        elif unit is None:
            out[name] = value
        else:
            power = power_of(unit.si)
            out[name] = _times(value, unit, multiplier(factor, power))
            done.append(Scaled(key, _shown(value), _shown(out[name]), power))
    return out


def _unit_of(annotation: Any) -> Unit | None:
    """The unit inside an annotation, as of a value that may be left out."""
    for part in (*getattr(annotation, "__metadata__", ()), *getattr(annotation, "__args__", ())):
        found = part if isinstance(part, Unit) else _unit_of(part)
        if found is not None:
            return found
    return None


def _times(value: Any, unit: Unit, by: Fraction) -> Any:
    if isinstance(value, list | tuple):
        return [_times(item, unit, by) for item in value]
    _, name = split(value, unit)
    return f"{_plain(Fraction(value.strip().removesuffix(name).strip()) * by)} {name}"


def _plain(number: Fraction) -> str:
    """A fraction as the shortest decimal that is it, or the nearest double."""
    return str(number.numerator) if number.denominator == 1 else repr(float(number))


def _shown(value: Any) -> str:
    return "[" + ", ".join(map(_shown, value)) + "]" if isinstance(value, list | tuple) else str(value)


def _whole_nanoseconds(table: dict[str, Any], scenario: Scenario, factor: Fraction) -> list[str]:
    """The sub-step as whole nanoseconds, its whole multiples as so many; told if it differs."""
    old_ns = round(scenario.model.rubble.substep * NS)
    exact = old_ns * multiplier(factor, Fraction(1, 2))
    step_ns = max(1, round(exact))
    if exact == step_ns:
        return []
    for section, key in MULTIPLES:
        value = getattr(getattr(scenario.model, section), key)
        if value is not None and key in table[section]:
            table[section][key] = f"{_plain(Fraction(round(value * NS / old_ns) * step_ns, 1000))} us"
    names = ", ".join(f"{section}.{key}" for section, key in MULTIPLES)
    share = f"{float(step_ns / exact - 1):+.1e}"
    return [f"the sub-step is {step_ns} ns, whole nanoseconds; it and its multiples ({names}) are off by {share}"]
