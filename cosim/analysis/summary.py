"""What a recording holds, as `cosim info --json` prints it."""

from __future__ import annotations

import json
from typing import Any

from cosim.analysis.lights import trust
from cosim.analysis.moments import moments
from cosim.analysis.peaks import peaks
from cosim.analysis.run_data import RunData
from coupling.interface import NS, PHASES


def summary(run: RunData) -> dict[str, Any]:
    """What a recording holds, as `cosim info --json` prints it."""
    return {
        "run": run.name,
        "scenario": run.metadata["scenario"],
        "title": run.metadata["title"],
        "version": run.metadata["version"],
        "seed": int(run.metadata["seed"]),
        "overrides": run.overrides,
        "ended": run.ended,
        "remark": run.remark or None,
        "commit": run.metadata.get("commit"),
        "libraries": json.loads(run.metadata.get("libraries", "{}")),
        "simulated_s": float(run.t[-1]) if len(run.t) else 0.0,
        "duration_s": int(run.metadata["duration_ns"]) / NS,
        "windows": len(run.t),
        "averaging_s": run.averaging,
        "peaks": peaks(run),
        "peaks_by_phase": {p: peaks(run, p) for p in PHASES},
        "moments": moments(run),
        "trust": trust(run),
        "events": [
            {
                "time": e.t_ns / NS,
                "kind": e.kind,
                "fx": e.force[0],
                "fy": e.force[1],
                "fz": e.force[2],
                "cells": e.cells,
                "length": e.length,
                "area": e.area,
                "cause": e.cause,
            }
            for e in run.lasting.events
        ],
        "ledger": {name: float(values[-1]) for name, values in run.ledger.items()},
    }
