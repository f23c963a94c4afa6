"""Rules of [structure.motion], and of ice at rest, which only a structure that moves by itself meets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.scenario.section import fault
from coupling.interface.motion import FREEDOMS

Faults = Iterator[PydanticCustomError]


def motion_has_its_keys(m: Any) -> Faults:
    """Those of its kind, and no others."""
    motion = m.structure.motion
    if motion is None:
        return
    tables = [name for name in FREEDOMS if getattr(motion, name) is not None]
    given = {"velocity": motion.velocity is not None, "file": bool(motion.file), "tables": bool(tables)}
    wants = {
        "rigid": (),
        "spring": ("tables", "file"),
        "modal": ("file",),
        "fmu": ("file",),
        "prescribed": ("velocity", "file"),
    }
    named = {
        "velocity": 'velocity = ["-0.1 m/s", "0 m/s", "0 m/s"]',
        "file": 'file = "motion.csv"',
        "tables": "a table [structure.motion.surge] with mass and stiffness",
    }
    own = wants[motion.kind]
    for what, there in given.items():
        if there and what not in own:
            key = tables[0] if what == "tables" else what
            yield fault(f"structure.motion.{key}", f"a {motion.kind} structure has none: remove it or change kind")
    if own and sum(given[what] for what in own) != 1:
        some = " or ".join(named[what] for what in own)
        yield fault("structure.motion.kind", f"{motion.kind} needs {'one of: ' if len(own) > 1 else ''}{some}")
    if motion.repeats and motion.kind in ("rigid", "prescribed"):
        yield fault("structure.motion.repeats", f"a {motion.kind} structure does not answer to the load: remove it")


def something_moves(m: Any) -> Faults:
    """Ice at rest is met by a structure that is moved alone."""
    motion = m.structure.motion
    if m.drift.velocity == 0.0 and (motion is None or motion.kind != "prescribed"):
        yield fault("drift.velocity", 'must be greater than zero where no structure.motion is "prescribed"')


RULES = (motion_has_its_keys, something_moves)
