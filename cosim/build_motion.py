"""From [structure.motion] to a model of the motion."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from cosim.errors import InputError
from cosim.scenario.files import read_toml
from cosim.scenario.scenario import Scenario
from coupling.interface import FREEDOMS, Array, Motion
from coupling.structure.motion import LinearMotion, Prescribed, modal, spring

MODES = ("frequency_Hz", "damping_ratio", "mass_kg")
SERIES = tuple(f"{name}_{'m' if k < 3 else 'rad'}" for k, name in enumerate(FREEDOMS))


def build_motion(scenario: Scenario) -> Motion | None:
    """The model, at rest; None: the structure stands still. InputError if a file does not describe one."""
    m = scenario.structure.motion
    if m is None or not m.moves:
        return None
    path = (scenario.folder or Path()) / m.file
    if m.kind == "fmu":
        return _of_fmu(path, m.repeats)
    try:
        if m.kind == "spring":
            return _of_matrices(path) if m.file else _of_tables(m)
        if m.kind == "modal":
            return _of_modes(path)
        if m.file:
            return _of_series(path, scenario.duration_ns / 1e9)
        return Prescribed.steady(np.array([*m.velocity, 0.0, 0.0, 0.0]), scenario.duration_ns / 1e9)
    except ValueError as error:
        raise InputError(f"{f'{path}: ' if m.file else 'structure.motion: '}{error}") from error


def repeats_of(scenario: Scenario) -> int:
    """How often at most a window is repeated for the motion."""
    m = scenario.structure.motion
    return 0 if m is None else int(m.repeats)


def _of_tables(m: Any) -> LinearMotion:
    """The degrees of freedom that have a table."""
    tables = [(k, getattr(m, name)) for k, name in enumerate(FREEDOMS) if getattr(m, name) is not None]
    mass = np.diag([t.mass if k < 3 else t.inertia for k, t in tables])
    damping, stiffness = (np.diag([getattr(t, name) for _, t in tables]) for name in ("damping", "stiffness"))
    return spring([k for k, _ in tables], mass, damping, stiffness)


def _of_matrices(path: Path) -> LinearMotion:
    """A TOML file with ``freedoms`` and the matrices ``mass``, ``damping`` and ``stiffness``, SI."""
    table = read_toml(path, InputError)[1]
    unknown = set(table) - {"freedoms", "mass", "damping", "stiffness"}
    if unknown or not {"freedoms", "mass"} <= set(table):
        raise InputError(f"{path}: has {', '.join(table)}; give freedoms, mass, damping and stiffness")
    names = table["freedoms"]
    listed = isinstance(names, list) and bool(names) and all(n in FREEDOMS for n in names)
    if not listed or len(set(names)) < len(names):
        raise InputError(f"{path}: freedoms = {names}; name some of {', '.join(FREEDOMS)}, each once")
    none = np.zeros((len(names), len(names))).tolist()
    try:
        mass, damping, stiffness = (np.array(table.get(k, none), np.float64) for k in ("mass", "damping", "stiffness"))
    except (TypeError, ValueError):
        raise InputError(f"{path}: a matrix is not {len(names)} rows of {len(names)} numbers") from None
    return spring([FREEDOMS.index(n) for n in names], mass, damping, stiffness)


def _of_modes(path: Path) -> LinearMotion:
    """A table with a row for each mode."""
    from cosim.ice.columns import numbers, read_table  # slow to import

    table = read_table(path, MODES)
    frequency, ratio, mass = (numbers(path, table, name) for name in MODES)
    shape = np.column_stack([_column(path, table, name, len(mass)) for name in FREEDOMS])
    if (frequency < 0.0).any() or (ratio < 0.0).any():
        raise InputError(f"{path}: frequencies and damping ratios must not be negative")
    if not shape.any(axis=1).all():
        number = int(np.argmin(shape.any(axis=1))) + 1
        raise InputError(f"{path}: mode {number} does not move the waterline; leave it out")
    return modal(frequency, ratio, mass, shape)


def _of_series(path: Path, duration: float) -> Prescribed:
    """A table with a row for each time."""
    from cosim.ice.columns import numbers, read_table

    table = read_table(path, ("time_s",))
    time = numbers(path, table, "time_s")
    if not any(name in table.column_names for name in SERIES):
        raise InputError(f"{path}: has no column of a motion; name one or more of {', '.join(SERIES)}")
    if len(time) and time[-1] < duration:
        raise InputError(f"{path}: ends at {time[-1]:g} s, the run at {duration:g} s; lengthen it")
    return Prescribed(time, np.column_stack([_column(path, table, name, len(time)) for name in SERIES]))


def _of_fmu(path: Path, repeats: int) -> Motion:
    """A model of others."""
    from cosim.fmi.structure import FmuMotion

    return FmuMotion(path, repeats=repeats)


def _column(path: Path, table: Any, name: str, count: int) -> Array:
    """A column, or zeros where there is none."""
    from cosim.ice.columns import numbers

    return numbers(path, table, name) if name in table.column_names else np.zeros(count)
