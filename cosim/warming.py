"""Kernels compiled before they are needed, by processes side by side, so that a run finds them on the disk.

numba compiles one kernel at a time in a process. Here each part of the program is run for a moment in a process of its
own, which compiles what this part needs; a mark beside the kernels says that it is done, until a source changes.
"""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any, NamedTuple

from cosim.scenario.scenario import Scenario
from cosim.show.talk import Talk
from coupling import compiled as of_coupling
from lattice import compiled as of_lattice
from rubble import compiled as of_rubble

CASE = "first_cone"
PACKAGES = {"lattice", "rubble", "coupling"}
ICE_ALONE = ("rubble.enabled=false", "scenario.duration='0.1 s'")
#: what of `CASE` each part takes; those that take longest first, and last what finds kernels of the others done
PARTS: dict[str, tuple[str, ...]] = {
    "rubble": (
        "rubble.initial_volume='6 m^3'",
        "rubble.initial_lengths=[2.2, 3.0]",  # thicknesses: long enough to break again
        "rubble.breaking_time='20 ms'",
        "scenario.duration='0.1 s'",
    ),
    "closing": (*ICE_ALONE, "fracture.cracks=closing"),
    "open": (*ICE_ALONE, "fracture.cracks=open"),
    "explicit": (*ICE_ALONE, "fracture.cracks=open", "fracture.propagation=dynamic"),
    "pieces": ("rubble.initial_volume='0 m^3'",),
}
OF_RUBBLE = {"rubble", "pieces"}
SWITCH = "COSIM_COMPILE_AHEAD"  #: 0: runs compile kernels as they come to them


class Compiled(NamedTuple):
    """What a part came to."""

    part: str
    kernels: int
    seconds: float


def parts_of(scenario: Scenario) -> list[str]:
    """What a scenario needs, in the order of `PARTS`."""
    fracture = scenario.fracture
    ice = "closing" if fracture.cracks == "closing" else "explicit" if fracture.propagation == "dynamic" else "open"
    return [part for part in PARTS if part == ice or (part in OF_RUBBLE and scenario.rubble.enabled)]


def missing(parts: Sequence[str]) -> list[str]:
    """Those that are not compiled yet for these sources; none if there is no place to keep kernels."""
    marks = {part: _marks(part) for part in parts}
    return [part for part, files in marks.items() if files and not all(file.exists() for file in files)]


def _marks(part: str) -> list[Path]:
    """Files that are there when a part is compiled: one in the folder of each package, which goes with its sources."""
    folders = [package.FOLDER for package in (of_lattice, of_rubble, of_coupling)]
    return [folder / f"{part}.done" for folder in folders if folder is not None] if all(folders) else []


def compile_part(part: str) -> Compiled:
    """Compiles what a part needs, in this process: a case runs for a moment, or pieces meet between two steps."""
    from numba.core import event

    from cosim.scenario.loading import load_scenario
    from cosim.simulation import run_scenario

    began = time.perf_counter()
    gc.disable()  # of a process that ends: compiling makes so many objects that a tenth of its time goes into counting
    with event.install_recorder("numba:compile") as recorder:
        scenario = load_scenario(CASE, PARTS[part])
        (_between_steps if part == "pieces" else run_scenario)(scenario)
    for file in _marks(part):
        file.touch()
    return Compiled(part, sum(_is_ours(e) for _, e in recorder.buffer), time.perf_counter() - began)


def _between_steps(scenario: Scenario) -> None:
    """Who may meet whom, and what breaks, in a pile of nothing: the part `rubble` comes to that last."""
    from cosim.build import build
    from coupling.rubble_port import RubblePort

    port = build(scenario).rubble
    assert isinstance(port, RubblePort)
    layer = port.layer
    layer.begin()
    layer.runner.break_and_wear(layer.store, layer.crushed)


def _is_ours(event: Any) -> bool:
    name: str = event.data["dispatcher"].py_func.__module__
    return bool(event.is_start) and name.partition(".")[0] in PACKAGES


def compile_parts(parts: Sequence[str], processes: int, done: Callable[[Compiled], None]) -> None:
    """Runs parts side by side; ``done`` is called as each ends. Raises BrokenProcessPool if a process dies."""
    from cosim.study.pool import pool_of  # not for runs that find all kernels

    with pool_of(max(1, min(processes, len(parts)))) as pool:
        under_way = {pool.submit(compile_part, part) for part in parts}
        while under_way:
            ended, under_way = wait(under_way, return_when=FIRST_COMPLETED)
            for future in ended:
                done(future.result())


def compile_ahead(scenario: Scenario, talk: Talk) -> None:
    """Before a run: if two or more parts are missing, and there are processors for them, they are compiled at once."""
    processes = os.cpu_count() or 1
    parts = missing(parts_of(scenario)) if processes > 1 and os.environ.get(SWITCH) != "0" else []
    if len(parts) < 2:
        return
    talk.note("compiles kernels, once for these sources; about half a minute")
    try:
        compile_parts(parts, processes, lambda c: talk.detail(f"{c.part}: {c.kernels} kernels in {c.seconds:.0f} s"))
    except BrokenProcessPool:
        talk.detail("a process that compiles has died; the run compiles as it goes")
