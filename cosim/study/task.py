"""One variant as a task: all that a process needs, and the row that it gives back.

What goes wrong becomes ``error``, one line. Each variant computes on one thread, so that its numbers do not depend on
how many run beside it, nor on which machine. Peaks are those of `cosim.analysis.sustained`, means over the averaging
time of each variant; features are those of the scenario's reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.scenario.loading import Written
from cosim.study.variants import Variant
from coupling.interface import PHASES, Frame

if TYPE_CHECKING:
    from cosim.analysis.run_data import RunData
    from cosim.observer import RunInfo
    from cosim.scenario.scenario import Scenario
    from cosim.simulation import RunResult

Row = dict[str, Any]
COMPONENTS = ("fx", "fz", "f")
#: columns of a row that do not depend on what is varied, [N], [s]
RESULTS = (
    *(f"{c}_peak" for c in COMPONENTS),
    *(f"{c}_time" for c in COMPONENTS),
    *(f"{p}_{c}_peak" for p in PHASES for c in COMPONENTS),
    "averaging_s",
    "not_trustworthy",
    "fx_mean",
    "fz_mean",
    "simulated_s",
    "wall_s",
    "fragments",
    "blocks",
)
FEATURE = "feature_"  #: before the name of a feature of the reference, in the names of columns


@dataclass(frozen=True)
class Study:
    """What all variants have in common, files included: it may go to a machine that does not see them."""

    written: Written
    overrides: tuple[str, ...] = ()
    reference: str | None = None  #: text of the scenario's reference.toml
    recordings: Path | None = None  #: folder for recordings
    keep: frozenset[int] | None = None  #: numbers of variants that are recorded; None: all

    def recording(self, number: int) -> Path | None:
        """File of a variant that is recorded."""
        if self.recordings is None or (self.keep is not None and number not in self.keep):
            return None
        return self.recordings / f"variant_{number:05d}.mcap"


def run_variant(study: Study, number: int, variant: Variant) -> Row:
    """Simulate one variant; what goes wrong becomes ``error``, one line."""
    from cosim.errors import explain
    from cosim.scenario.cost import cost_of, too_large
    from cosim.scenario.loading import checked
    from cosim.simulation import run_scenario

    try:
        scenario = checked(study.written, (*study.overrides, *variant.overrides))
        if refused := too_large(cost_of(scenario.model)):
            return {"error": refused}
        path, kept = study.recording(number), AsRecorded()
        run = run_scenario(scenario, [kept]) if path is None else _recorded(scenario, kept, path)
        result, mean = run.to_json(), run.mean_load()
        features = _features(study, kept.with_run(run))
    except Exception as error:
        return {"error": " ".join(explain(error)[0].split())}
    row = {"averaging_s": result["averaging_s"], "not_trustworthy": "; ".join(result["trust"]["because"])}
    for c in COMPONENTS:
        row[f"{c}_peak"], row[f"{c}_time"] = result["peaks"][c]["value"], result["peaks"][c]["time"]
        row |= {f"{p}_{c}_peak": result["peaks_by_phase"][p][c]["value"] for p in PHASES}
    row["fx_mean"], row["fz_mean"] = float(mean[0]), float(mean[2])
    return row | features | {name: result[name] for name in ("simulated_s", "wall_s", "fragments", "blocks")}


class AsRecorded:
    """Observer that keeps what features ask for beside loads and events: the ledger of every window, and metadata."""

    def __init__(self) -> None:
        self._ledger: list[dict[str, float]] = []
        self._metadata: dict[str, str] = {}

    def on_start(self, run_info: RunInfo) -> None:
        """Keep what stays constant."""
        from cosim.recording.metadata import run_metadata

        self._metadata = run_metadata(run_info, {})

    def on_frame(self, frame: Frame) -> None:
        """Keep the ledger."""
        self._ledger.append(dict(frame.ledger))

    def on_close(self) -> None:
        """Nothing."""

    def with_run(self, run: RunResult) -> RunData:
        """The run as a recording would give it."""
        names = dict.fromkeys(name for terms in self._ledger for name in terms)
        columns = {name: np.array([terms.get(name, np.nan) for terms in self._ledger]) for name in names}
        return replace(run.data, ledger=columns, metadata=self._metadata)


def _recorded(scenario: Scenario, kept: AsRecorded, path: Path) -> RunResult:
    """A run with its recording, which tells how it ended; one that is there from an earlier try is written over."""
    from cosim.errors import explain
    from cosim.recording.writer import Recorder
    from cosim.simulation import run_scenario

    recorder = Recorder(path, force=True)
    try:
        return run_scenario(scenario, [kept, recorder])
    except Exception as error:
        recorder.ending = " ".join(explain(error)[0].split())
        raise
    finally:
        recorder.on_close()


def _features(study: Study, run: RunData) -> Row:
    """What the run gives for each feature of the reference, under `FEATURE` and its name; None if it has none."""
    from cosim.analysis.compare import compare
    from cosim.analysis.reference import parse_reference

    if study.reference is None:
        return {}
    rows = compare(run, parse_reference(study.reference, "reference.toml"))
    return {FEATURE + row.feature.name: None if (x := row.simulated) is None else float(x) for row in rows}


def columns(rows: Sequence[Row]) -> list[str]:
    """Names of the features that rows have, each once."""
    return list(dict.fromkeys(name for row in rows for name in row if name.startswith(FEATURE)))
