"""[scenario] and [recording]: what runs for how long, and what of it is kept."""

from __future__ import annotations

from pydantic import Field

from cosim.scenario.section import Section
from cosim.scenario.units import (
    Time,
)


class Case(Section):
    """[scenario] What runs, and for how long."""

    title: str  #: one line, shown by every command
    description: str = ""  #: what happens in the case, and where it is from
    duration: Time  #: simulated time [s]
    seed: int = Field(0, ge=0)  #: of every random number of the run


class Recording(Section):
    """[recording] What of a run is kept."""

    every: Time = 0.5  #: time between recorded frames; loads are recorded for every window [s]
