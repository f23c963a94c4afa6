"""Largest moments of a run, and where the load attacks when it is largest."""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.analysis.instants import largest
from cosim.analysis.run_data import COMPONENTS, MOMENT_AXES, MOMENTS, RunData
from cosim.moments import attack_of
from coupling.interface import PHASES


def moments(run: RunData) -> dict[str, Any] | None:
    """Point [m], peaks of all phases and of each [N m], moment and point of attack at the peaks of the load.

    Peaks are largest in magnitude, of the mean over the averaging time as everywhere (`cosim.analysis.sustained`);
    ``m`` is the overturning moment, hypot(mx, my). None: the run holds no moments.
    """
    run = run.lasting
    if run.moment is None or run.weight is None or not len(run.t_ns):
        return None
    at = {name: _at(run, largest(run.component(name))) for name in COMPONENTS}
    return {
        "point": run.moment_point,
        "peaks": _peaks(run, None),
        "peaks_by_phase": {phase: _peaks(run, phase) for phase in PHASES},
        "at_peaks": at,
    }


def _peaks(run: RunData, phase: str | None) -> dict[str, dict[str, float]]:
    found = {}
    for name in MOMENTS:
        values = run.component(name, phase)
        k = largest(values)
        found[name] = {"value": float(values[k]), "time": float(run.t[k])}
    return found


def _at(run: RunData, k: int) -> dict[str, Any]:
    """Time [s], moment [N m] and point of attack [m] of a window; no point without a load."""
    assert run.weight is not None
    attack = attack_of(run.weight[k])
    there = bool(np.isfinite(attack).all())
    return {
        "time": float(run.t[k]),
        **{name: float(run.component(name)[k]) for name in MOMENT_AXES},
        "attack": attack.tolist() if there else None,
    }
