"""An interrupted run found again beside its recording."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cosim.build import run_info
from cosim.checkpoint.file import CheckpointError, Kept, place_of, read
from cosim.checkpoint.keeping import header_of
from cosim.recording.records import Records
from cosim.recording.retrace import Since
from cosim.scenario.model import ScenarioModel
from cosim.scenario.scenario import Scenario


@dataclass(frozen=True)
class Interrupted:
    """A run, and where it goes on."""

    scenario: Scenario
    kept: Kept
    since: Since
    warnings: tuple[str, ...]


def interrupted(recording: Path) -> Interrupted:
    """The run of a recording; CheckpointError with one line where it cannot go on from a checkpoint."""
    Records(recording)  # refuses what is none
    place = place_of(recording)
    if not place.is_file():
        raise CheckpointError(
            f"{recording}: no checkpoint {place.name} beside it: it has reached its end, or was not asked to keep any "
            "(`cosim run SCENARIO --checkpoint-every '10 s'`)"
        )
    kept = read(place)
    try:
        scenario, since = _scenario(kept.header["scenario"]), Since(**kept.header["since"])
        now = header_of(scenario, run_info(scenario))
        faults = list(_faults(kept.header["run"], now["run"]))
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        raise CheckpointError(f"{place}: checkpoint cannot be read: {error}; run the scenario again") from None
    if faults:
        raise CheckpointError(f"{place}: {faults[0]}, bits would differ; resume it there, or run the scenario again")
    machine, here = kept.header.get("machine"), now["machine"]
    other = f"{place.name} was kept on another machine ({machine}, here {here}): last bits may differ"
    return Interrupted(scenario, kept, since, (other,) if machine != here else ())


def _scenario(told: Mapping[str, Any]) -> Scenario:
    """As it was read when the run began, whatever its files hold now."""
    raw = dict(told["raw"])
    folder = None if told["folder"] is None else Path(told["folder"])
    model = ScenarioModel.model_validate(raw)
    return Scenario(str(told["name"]), str(told["text"]), raw, model, tuple(told["overrides"]), folder)


def _faults(then: Mapping[str, str], now: Mapping[str, str]) -> Iterator[str]:
    """What the run was made with that is another now."""
    for name in sorted(then.keys() | now.keys()):
        if then.get(name) != now.get(name):
            yield f"{name} was {then.get(name)} when the run began and is {now.get(name)}"
