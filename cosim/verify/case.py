"""Result of a verification case: quantities with their reference, and figures that can be drawn from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Quantity:
    """One number or list of numbers. ``passed`` is None when there is nothing to compare with."""

    name: str
    value: Any  #: number or nested list
    unit: str
    reference: Any = None  #: same shape as the value, or null
    source: str = ""  #: where the reference stands
    tolerance: float | None = None
    measure: str = ""  #: how the tolerance is meant: relative, absolute, at most, at least
    passed: bool | None = None


@dataclass(frozen=True)
class Figure:
    """A picture of the thesis: file name without ending, title, and a function that draws on a matplotlib figure."""

    name: str
    title: str
    draw: Callable[[Any], None]


@dataclass(frozen=True)
class CaseResult:
    """What a case came to."""

    case: str
    parameters: dict[str, Any]
    quantities: list[Quantity]
    figures: list[Figure] = field(default_factory=list, compare=False)

    @property
    def passed(self) -> bool:
        """No quantity that has a reference misses it."""
        return all(q.passed is not False for q in self.quantities)

    def as_dict(self) -> dict[str, Any]:
        """JSON object of `cosim verify --json`."""
        return {
            "case": self.case,
            "parameters": self.parameters,
            "quantities": [vars(q) for q in self.quantities],
            "passed": self.passed,
        }


def plain(value: Any) -> Any:
    """Numbers and nested lists for JSON from numpy values; a number that is not finite is refused."""
    array = np.asarray(value, dtype=float)
    if not np.all(np.isfinite(array)):
        raise ValueError("a verification quantity is not finite")
    return array.tolist()


def value(name: str, number: Any, unit: str, source: str = "") -> Quantity:
    """A quantity without reference."""
    return Quantity(name, plain(number), unit, source=source)


def near(
    name: str, number: Any, unit: str, reference: Any, tolerance: float, source: str, measure: str = "relative"
) -> Quantity:
    """Every entry within ``tolerance`` of the reference, as part of the reference or ``absolute``; None: no check."""
    if reference is None:
        return value(name, number, unit)
    difference = np.abs(np.asarray(number, float) - np.asarray(reference, float))
    allowed = tolerance * (np.abs(np.asarray(reference, float)) if measure == "relative" else 1.0)
    ok = bool(np.all(difference <= allowed))
    return Quantity(name, plain(number), unit, plain(reference), source, tolerance, measure, ok)


def limited(name: str, number: Any, unit: str, limit: float, source: str, known: bool) -> Quantity:
    """`at_most` with the parameters of the source, a plain value with others."""
    return at_most(name, number, unit, limit, source) if known else value(name, number, unit)


def at_most(name: str, number: Any, unit: str, limit: float, source: str) -> Quantity:
    """Every entry at most ``limit``: errors and residuals, whose reference is zero."""
    ok = bool(np.all(np.abs(np.asarray(number, float)) <= limit))
    return Quantity(name, plain(number), unit, 0.0, source, limit, "at most", ok)
