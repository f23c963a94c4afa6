"""How large a value of a key may be, and what it may look like. Outside of its limits a value is a slip or no ice.

Limits are wide: from a basin at a scale of 1:50 to the largest ridge. What is only unlikely is told by `cosim check`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

from pydantic_core import PydanticCustomError, core_schema

from cosim.scenario.units import si_of


@dataclass(frozen=True, slots=True)
class Limits:
    """Smallest and largest value of a quantity, both allowed, and an example of the key that they belong to."""

    low: str
    high: str
    example: str

    def check(self, value: float) -> float:
        """The value [SI], if it lies inside."""
        low, high = _ends(self.low, self.high)
        if not low <= value <= high:
            raise PydanticCustomError(
                "range",
                "outside of {low} to {high}; for example {example}",
                {"low": self.low, "high": self.high, "example": f'"{self.example}"'},
            )
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> core_schema.CoreSchema:
        return core_schema.no_info_after_validator_function(self.check, handler(source))


@cache
def _ends(low: str, high: str) -> tuple[float, float]:
    return si_of(low), si_of(high)
