"""A recorded run beside what was measured and what others computed.

``ratio = simulated / measured``: 1 is agreement, below 1 the simulation is too low. Against a range it is 1 anywhere
inside, otherwise the ratio to the nearer end. Without a measured value, or without the feature in the run, it is null.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cosim.analysis.features import QUANTITIES
from cosim.analysis.peaks import shares_at_peak
from cosim.analysis.reference import Feature, FeatureError, Reference, load_reference, parse_reference
from cosim.analysis.run_data import RunData

Range = tuple[float, float]


@dataclass(frozen=True)
class Row:
    """A feature beside what the run gives for it, None if the run has none."""

    feature: Feature
    simulated: float | None
    over: float  #: time over which its loads are means [s]; 0 for single windows and instants


def ratio(simulated: float | None, value: Range | None) -> float | None:
    """Simulated / value; 1 inside a range."""
    if simulated is None or value is None:
        return None
    nearest = min(max(simulated, value[0]), value[1])
    return simulated / nearest if nearest else None


def compare(run: RunData, reference: Reference) -> list[Row]:
    """Every feature of the reference, taken from the run."""

    def value(f: Feature) -> float | None:
        loads = run.lasting if f.over is None else run.averaged(f.over)
        return QUANTITIES[f.quantity](loads, **f.arguments)

    return [Row(f, value(f), run.averaging if f.over is None else f.over) for f in reference.features]


def reference_of(run: RunData, path: str | Path | None) -> tuple[str, Reference]:
    """The named reference, or the one that the recording carries."""
    if path is not None:
        return Path(path).name, load_reference(path)
    text = run.texts.get("reference.toml")
    if text is None:
        raise FeatureError(f"{run.name}: the scenario of this run had no reference.toml; name a reference file")
    return "reference.toml", parse_reference(text, f"{run.name}/reference.toml")


def to_json(run: RunData, name: str | None, rows: list[Row]) -> dict[str, Any]:
    """``measured`` is a number; a range gives its middle, and ``measured_range`` both ends.

    ``peaks`` holds the load and the share of each phase at the peak of Fx, Fz and the resultant.
    """
    return {
        "run": run.name,
        "reference": name,
        "remark": run.remark or None,
        "averaging_s": run.averaging,
        "features": [_json_row(row) for row in rows],
        "series": None,
        "peaks": shares_at_peak(run),
    }


def _json_row(row: Row) -> dict[str, Any]:
    f = row.feature
    return {
        "name": f.name,
        "simulated": row.simulated,
        "measured": _middle(f.measured),
        "ratio": ratio(row.simulated, f.measured),
        "source": f.source,
        "unit": f.unit,
        "measured_range": list(f.measured) if f.measured and f.measured[0] != f.measured[1] else None,
        "thesis": _middle(f.thesis),
        "thesis_ratio": ratio(row.simulated, f.thesis),
        "quantity": f.quantity,
        "arguments": f.arguments,
        "over": row.over,
    }


def _middle(value: Range | None) -> float | None:
    return None if value is None else (value[0] + value[1]) / 2
