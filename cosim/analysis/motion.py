"""How a structure has moved."""

from __future__ import annotations

import numpy as np

from cosim.analysis.run_data import RunData
from coupling.interface import FREEDOMS


def motion(run: RunData) -> dict[str, dict[str, float]] | None:
    """Largest and smallest displacement of every degree of freedom that moves, mean, deviation and largest speed.

    Of the whole run; [m] and [m/s], [rad] and [rad/s]. None: the structure rests.
    """
    if not run.motion:
        return None
    found = {}
    for name in FREEDOMS:
        way, rate = run.motion[name], run.motion[f"{name}_rate"]
        if way.any() or rate.any():
            found[name] = {
                "max": float(way.max()),
                "min": float(way.min()),
                "mean": float(way.mean()),
                "deviation": float(way.std()),
                "max_rate": float(np.abs(rate).max()),
            }
    return found
