"""A run as tables of pandas. Columns have plain names; ``table.attrs["units"]`` says in which unit each is."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from cosim.analysis.run_data import AXES, COMPONENTS, MOMENT_AXES, MOMENTS, MOTION, RunData
from cosim.moments import attack_of
from coupling.interface import NS, PHASES

if TYPE_CHECKING:
    import pandas as pd

TIME = "time"
ATTACK = ("attack_x", "attack_y", "attack_z")


def load_units() -> dict[str, str]:
    """Columns of `loads` and their units."""
    forces = [*COMPONENTS, *(f"{phase}_{axis}" for phase in PHASES for axis in AXES)]
    moments = [*MOMENTS, *(f"{phase}_{axis}" for phase in PHASES for axis in MOMENT_AXES)]
    return {TIME: "s"} | dict.fromkeys(forces, "N") | dict.fromkeys(moments, "N m") | dict.fromkeys(ATTACK, "m")


def loads(run: RunData, over: float = 0.0) -> pd.DataFrame:
    """Forces [N], moments [N m] and point of attack [m] of every window, by the end of the window [s].

    ``over``: means over this time [s]; 0: over each window. The totals come first, then the phases.
    """
    run = run.averaged(over)
    columns = {name: run.component(name) for name in COMPONENTS}
    columns |= {f"{phase}_{axis}": run.component(axis, phase) for phase in PHASES for axis in AXES}
    if run.moment is not None and run.weight is not None:
        columns |= {name: run.component(name) for name in MOMENTS}
        columns |= {f"{phase}_{axis}": run.component(axis, phase) for phase in PHASES for axis in MOMENT_AXES}
        columns |= dict(zip(ATTACK, attack_of(run.weight).T, strict=True))
    return _table(run, columns, load_units())


def events(run: RunData) -> pd.DataFrame:
    """All events: time [s], kind, load [N], place [m], size, cause, and a line for people.

    ``fx`` to ``fz`` are means over ``averaging`` [s], the loads of which the peaks are the largest; ``fx_instant`` to
    ``fz_instant`` are those of the instant itself, as the recording holds them.
    """
    import pandas as pd

    instant = [f"{axis}_instant" for axis in AXES]
    units = {TIME: "s", "kind": "", **dict.fromkeys(AXES, "N"), "averaging": "s", **dict.fromkeys(instant, "N")}
    units |= {"cells": "1", **dict.fromkeys("xyz", "m"), "length": "m", "area": "m2", "cause": "", "text": ""}
    rows = [
        (
            e.t_ns / NS,
            e.kind,
            *mean.force,
            run.averaging,
            *e.force,
            e.cells,
            *e.position,
            e.length,
            e.area,
            e.cause,
            e.text,
        )
        for e, mean in zip(run.events, run.lasting.events, strict=True)
    ]
    found = pd.DataFrame(rows, columns=list(units))
    found.attrs["units"] = units
    return found


def ledger(run: RunData) -> pd.DataFrame:
    """Balances of every window, by name: masses [kg], energies [J], momenta [N s], errors [1]."""
    return _table(run, run.ledger, {TIME: "s"} | {name: unit_of_balance(name) for name in run.ledger})


def motion(run: RunData) -> pd.DataFrame:
    """Displacement and velocity of a structure that moves, after every window; without columns where it rests."""
    units = {name: "m" if k % 6 < 3 else "rad" for k, name in enumerate(MOTION)}
    units |= {name: f"{units[name]}/s" for name in MOTION[6:]}
    return _table(run, run.motion, {TIME: "s"} | units)


def budget(run: RunData) -> pd.DataFrame:
    """What carries the load, of every window [N]; see `coupling.budget`."""
    return _table(run, run.budget, {TIME: "s"} | dict.fromkeys(run.budget, "N"))


#: units of balances by what their names begin or end with, the first that fits; the others are energies
UNITS = (
    ("power_error", "1"),
    ("power_", "W"),
    ("structure_power_", "W"),
    ("_repeats", "1"),
    ("cleared_momentum_", "N s"),
    ("crushed_momentum_", "N s"),
    ("handover_crushed_momentum_", "N s"),
    ("handover_crushed_spin_", "N m s"),
    ("handover_held_spin_", "N m s"),
    *((ending, "1") for ending in ("_error", "_change", "_windows")),
    ("_mass", "kg"),
)


def unit_of_balance(name: str) -> str:
    """Of a term of the ledger."""
    return next((unit for part, unit in UNITS if name.startswith(part) or name.endswith(part)), "J")


def _table(run: RunData, columns: dict[str, np.ndarray], units: dict[str, str]) -> pd.DataFrame:
    import pandas as pd

    found = pd.DataFrame(columns, index=pd.Index(run.t, name=TIME))
    found.attrs["units"] = {name: units[name] for name in (TIME, *columns)}
    return found


TABLES: dict[str, Callable[[RunData], pd.DataFrame]] = {
    "loads": loads,
    "events": events,
    "ledger": ledger,
    "budget": budget,
    "motion": motion,
}
