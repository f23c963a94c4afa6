"""Loads on the sheet by name: each takes from a scenario what it needs, or is not there.

A load from outside is one more line, before the run: ``LOADS["wind"] = lambda scenario: Wind()``.
"""

from __future__ import annotations

from collections.abc import Callable

from cosim.scenario.scenario import Scenario
from coupling.current import Current
from coupling.interface import Load


def _current(scenario: Scenario) -> Load | None:
    w = scenario.water
    return None if w.current is None else Current(w.current, w.density, scenario.rubble.skin_drag)


#: beside structure, rubble and still water; None: this scenario has no such load
LOADS: dict[str, Callable[[Scenario], Load | None]] = {"current": _current}


def loads_of(scenario: Scenario) -> tuple[Load, ...]:
    """What acts on the sheet of a scenario, in the order of the table."""
    made = (make(scenario) for make in LOADS.values())
    return tuple(load for load in made if load is not None)
