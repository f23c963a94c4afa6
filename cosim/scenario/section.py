"""What the sections of a scenario file have in common: strict frozen models, SI floats inside.

Angles are stored in radians. A field without default must stand in the file. Keys that are not listed are refused.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError

Share = Annotated[float, Field(ge=0, le=1)]
Coefficient = Annotated[float, Field(ge=0, le=100)]
Friction = Annotated[float, Field(ge=0, le=2)]
Count = Annotated[int, Field(ge=1, le=1_000_000)]


def fault(key: str, text: str) -> PydanticCustomError:
    """An error that a rule over several keys finds; ``key`` is the one to change, with its section."""
    return PydanticCustomError("check", "{text}", {"text": text, "key": key})


class Section(BaseModel):
    """A table of a scenario file."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)
