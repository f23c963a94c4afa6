"""Largest loads of a recorded run, by component and phase."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.analysis.instants import largest
from cosim.analysis.run_data import COMPONENTS, RunData
from coupling.interface import PHASES


def at_peak(run: RunData, component: str = "fx", phase: str | None = None) -> int | None:
    """Window of the load that is `largest`; None if there is no window."""
    values = run.component(component, phase)
    return largest(values) if len(values) else None


def peaks(run: RunData, phase: str | None = None) -> dict[str, dict[str, float | None]]:
    """Each component and the resultant, largest in magnitude, with their simulated times, of all phases or of one.

    As everywhere, a peak is the largest mean over the averaging time of the run: `cosim.analysis.sustained`.
    """
    run, out = run.lasting, dict[str, dict[str, float | None]]()
    for name in COMPONENTS:
        values, k = run.component(name, phase), at_peak(run, name, phase)
        out[name] = {"value": None, "time": None} if k is None else {"value": float(values[k]), "time": float(run.t[k])}
    return out


def shares_at_peak(run: RunData) -> dict[str, dict[str, Any]]:
    """For Fx, Fz and the resultant: peak (by magnitude) [N], its time [s], load [N] and share of each phase then.

    The peak is as in `peaks`. The phases of the resultant are projected on its direction, so that they add up to it as
    the others do.
    """
    run, out = run.lasting, dict[str, dict[str, Any]]()
    for name in ("fx", "fz", "f") if len(run.t_ns) else ():
        total = run.component(name)
        k = at_peak(run, name) or 0
        peak = float(total[k])
        parts = run.load[k] @ (run.load[k].sum(axis=0) / peak if peak else np.zeros(3))
        loads = {p: float(parts[i] if name == "f" else run.component(name, p)[k]) for i, p in enumerate(PHASES)}
        out[name] = {
            "value": peak,
            "time": float(run.t[k]),
            "phases": loads,
            "shares": {p: v / peak if peak else 0.0 for p, v in loads.items()},
        }
    return out
