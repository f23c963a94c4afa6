"""The force budget of a recorded run as a table: what carries the load, see `coupling.budget`."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.analysis.instants import encounters
from cosim.analysis.peaks import at_peak
from cosim.analysis.run_data import RunData
from coupling.budget import AXES, TERMS
from coupling.interface import Array


def rows(run: RunData) -> list[dict[str, Any]]:
    """The terms [N] of Fx and Fz: at both peaks, before circumferential failures, on the mean; empty without a budget.

    Those at an instant are means over the averaging time of the run. "Before" is the last window before the first
    failure of each encounter.
    """
    if not run.budget or not len(run.t_ns):
        return []
    windows, run = run, run.lasting
    at_fz, at_fx = (at_peak(run, name) or 0 for name in ("fz", "fx"))
    instants = [("peak of Fz", at_fz), ("peak of Fx", at_fx)] if at_fz != at_fx else [("peak of Fz and Fx", at_fz)]
    instants += [("before failure", e.event - 1) for e in encounters(run) if e.event > 0]
    table = [_row(run, when, f"{run.t[k]:.2f}", axis, slice(k, k + 1)) for when, k in instants for axis in ("fz", "fx")]
    return table + [_row(windows, "mean", "all", axis, slice(None)) for axis in ("fz", "fx")]


def carriers(run: RunData) -> tuple[str, ...]:
    """Names of the terms of a recorded budget: those of every run, then those of its loads on the sheet."""
    own = (name.removeprefix("fz_") for name in run.budget if name.startswith("fz_"))
    return (*TERMS, *(name for name in own if name not in (*TERMS, "residual")))


def _row(run: RunData, when: str, time: str, axis: str, windows: slice) -> dict[str, Any]:
    length = (run.t_ns - run.begin_ns)[windows]

    def mean(values: Array) -> float:
        return float(np.average(values[windows], weights=length))

    terms = {name.replace("_", " "): mean(run.budget[f"{axis}_{name}"]) for name in (*carriers(run), "residual")}
    return {
        "when": when,
        "time": time,
        "component": axis.capitalize(),
        "total": mean(run.component(axis)),
        "terms": terms,
    }


def largest_residual(run: RunData) -> dict[str, float]:
    """Largest residual of any window as a share of the run's largest load, by component."""
    if not run.budget or not len(run.t_ns):
        return {}
    return {
        axis: float(np.abs(run.budget[f"{axis}_residual"]).max() / max(np.abs(run.component(axis)).max(), 1e-9))
        for axis in AXES
    }
