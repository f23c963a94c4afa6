"""All rules, in the order in which their faults are told."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.scenario.rules import ice, moving, sheet, structure, times

#: takes the model, or what stands for it; yields faults
RULES: tuple[Callable[[Any], Iterator[PydanticCustomError]], ...] = (
    *ice.RULES,
    *sheet.RULES,
    *structure.RULES,
    *moving.RULES,
    *times.RULES,
)
