"""What is wrong with a scenario beyond its keys: files that it names, fields of ice that cannot be drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from cosim.errors import InputError
from cosim.scenario.scenario import Scenario
from cosim.scenario.variation import FIELDS
from lattice.grid import Grid


def faults_of(scenario: Scenario) -> list[str]:
    """All of them, a line each, as a run tells the first of them: each is tried as a run would."""
    faults = []
    for attempt in _attempts(scenario):
        try:
            attempt()
        except InputError as error:
            faults.append(str(error))
    return faults


def _attempts(scenario: Scenario) -> Iterator[Callable[[], object]]:
    """What a run reads and draws, one after the other."""
    sheet, folder = scenario.sheet, scenario.folder or Path()
    nx, ny = sheet.nodes
    grid = Grid(nx, ny, sheet.spacing)
    if fields := [name for name in FIELDS if getattr(scenario.ice, name) is not None]:
        from cosim.ice.fields import of_cells  # tables are slow to import, and few ice varies

        yield from (partial(of_cells, scenario, name, grid) for name in fields)
    if sheet.broken:
        from cosim.ice.broken import broken

        yield partial(broken, folder / sheet.broken, grid)
    if scenario.rubble.pieces:
        from cosim.ice.pieces import checked

        yield partial(checked, folder / scenario.rubble.pieces, scenario)
    motion = scenario.structure.motion
    if motion is not None and motion.kind == "fmu":
        yield partial(_is_there, folder / motion.file)  # a model of others is not started to be looked at
    elif motion is not None and motion.file:
        from cosim.build_motion import build_motion

        yield partial(build_motion, scenario)


def _is_there(path: Path) -> None:
    if not path.is_file():
        raise InputError(f"{path}: no such file; give a path from the folder of the scenario (structure.motion.file)")
