"""[scenario] and [recording]: what runs for how long, and what of it is kept."""

from __future__ import annotations

from cosim.scenario.section import Section
from cosim.scenario.units import (
    Time,
)


class Case(Section):
    """[scenario]"""

    title: str
    description: str = ""
    duration: Time  #: simulated time [s]
    seed: int = 0  #: of every random number of the run


class Recording(Section):
    """[recording]"""

    every: Time = 0.5  #: time between recorded frames; loads are recorded for every window [s]
