"""[scenario] and [recording]: what runs for how long, and what of it is kept."""

from __future__ import annotations

import unicodedata
from typing import Annotated, Any

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from cosim.scenario.limits import Limits
from cosim.scenario.section import Section
from cosim.scenario.units import Height, Time, Unit, list_of


def _without_controls(text: str) -> str:
    """Text of one line, without escape sequences and without marks that turn the direction of reading."""
    for c in text:
        if unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp"):
            raise PydanticCustomError("value", "{text}", {"text": f"one line of plain text: remove {c!a}"})
    return text


_Coordinate = Annotated[Height, Limits("-1000 m", "1000 m", "0 m")]
Place: Any = list_of(Unit("m", "0 m", '["0 m", "0 m", "-20 m"]'), _Coordinate, _Coordinate, _Coordinate)
Line = Annotated[str, AfterValidator(_without_controls), Field(max_length=200)]


class Case(Section):
    """[scenario] What runs, and for how long."""

    title: Line = Field(examples=["Pier with a cone, ice of 60 cm"])  #: one line, shown by every command
    #: what happens in the case, and where it is from
    description: str = Field("", max_length=10_000, examples=["What happens, and where the case is from"])
    duration: Annotated[Time, Limits("1 ms", "1e6 s", "60 s")]  #: simulated time [s]
    seed: int = Field(0, ge=0, lt=2**63)  #: of every random number of the run


class Recording(Section):
    """[recording] What of a run is kept, and what is called a peak."""

    #: time between recorded frames; loads are recorded for every window [s]
    every: Annotated[Time, Limits("1 us", "1e6 s", "0.5 s")] = 0.5
    #: time between checkpoints, from which an interrupted run goes on; default none. A run goes on from each of its
    #: checkpoints itself, so its last bits depend on this, not on interruptions: `cosim resume` [s]
    checkpoint_every: Annotated[Time, Limits("1 us", "1e6 s", "10 s")] = None
    #: peaks are those of the mean load over this time; default half a second at ice of 1 m, by Froude's law for other
    #: ice: 0.5 s (h / 1 m)^0.5 at 9.81 m/s2, see `cosim.analysis.sustained` [s]
    averaging: Annotated[Time, Limits("1 us", "1000 s", "0.5 s")] = None
    #: x, y and z of the point about which moments are told; default the waterline on the structure's axis, z up [m]
    moment_point: Place = None
