"""Calls: simulate a scenario, go on with a run, open a recording, run variants, list the scenarios."""

from __future__ import annotations

import builtins
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cosim.api.run import Run

if TYPE_CHECKING:
    import pandas as pd

    from cosim.observer import Observer

Settings = Mapping[str, Any]  #: values by key, ``{"ice.thickness": "2 m"}``


def run(
    scenario: str | Path,
    set: Settings | None = None,
    output: str | Path | None = None,
    *,
    force: bool = False,
    progress: bool = False,
    observers: Iterable[Observer] = (),
) -> Run:
    """Simulate a scenario.

    Args:
        scenario: a folder, a TOML file, or a name of `scenarios`.
        set: values over those of the scenario, by key: ``{"ice.thickness": "2 m", "rubble.enabled": False}``.
            Quantities are texts with their unit, as in the file.
        output: where the recording is written (.mcap); without it in a place that is gone with the run.
        force: write over a recording that exists.
        progress: show a bar on standard error.
        observers: see every window, as `cosim.observer.Observer` says.

    Raises:
        InputError: the scenario has faults, or the output cannot be written.
        coupling.interface.SimulationError: the simulation could not go on; its recording holds what was until then.

    """
    from cosim.recording.writer import Recorder
    from cosim.scenario.loading import load_scenario
    from cosim.watched import simulate

    loaded = load_scenario(scenario, overrides_of(set))
    kept = tempfile.TemporaryDirectory(prefix="cosim-") if output is None else None
    path = Path(kept.name) / f"{loaded.name}.mcap" if kept is not None else Path(str(output))
    simulate(loaded, _watching(observers, Recorder(path, force=force), progress))
    return Run(path, _kept=kept)


def resume(recording: str | Path, *, progress: bool = False, observers: Iterable[Observer] = ()) -> Run:
    """Go on with an interrupted run from its last checkpoint, with the bits that it would have had.

    The run has kept checkpoints if ``recording.checkpoint_every`` is set, as by ``set`` of `run`.

    Args:
        recording: of the run; its checkpoint lies beside it.
        progress: show a bar on standard error.
        observers: see every window from the checkpoint on.

    Raises:
        InputError: there is no checkpoint, or it is damaged or of another version.
        coupling.interface.SimulationError: as of `run`.

    """
    from cosim.checkpoint.interrupted import interrupted
    from cosim.recording.writer import Recorder
    from cosim.watched import simulate

    found, path = interrupted(Path(recording)), Path(recording)
    recorder = Recorder(path, since=found.since)
    simulate(found.scenario, _watching(observers, recorder, progress), kept=found.kept)
    return Run(path)


def open(path: str | Path) -> Run:
    """Open a recording; of one that was cut off, what is whole.

    Raises:
        cosim.recording.records.RecordingError: the file is damaged, empty, or no recording; it is an `InputError`.

    """
    return Run(Path(path))


def sweep(
    scenario: str | Path,
    vary: Mapping[str, Sequence[Any]],
    set: Settings | None = None,
    *,
    grid: bool = False,
    seeds: int | None = None,
    jobs: int = 1,
) -> pd.DataFrame:
    """Run variants of a scenario side by side; one row each, the base first.

    Args:
        scenario: as of `run`.
        vary: keys and the values that each takes, ``{"ice.thickness": ["2 m", "3 m"]}``.
        set: values of all variants, as of `run`.
        grid: all combinations; else each value alone.
        seeds: how many seeds each variant runs with, from that of the scenario on; None: its own.
        jobs: variants that run at the same time, in processes of their own: a script that asks for it has its calls
            behind ``if __name__ == "__main__":``.

    Returns:
        Peaks [N], their times [s], ratios to the base; ``error`` is a line where a variant failed, else None.

    """
    import pandas as pd

    from cosim.scenario.loading import checked, read_scenario
    from cosim.study.design import Design
    from cosim.study.pool import Processes
    from cosim.study.sweep import sweep as run_variants
    from cosim.study.task import Study
    from cosim.study.variants import Axis

    written, overrides = read_scenario(scenario), overrides_of(set)
    base = checked(written, overrides)
    axes = [Axis(key, tuple(_text(value) for value in values)) for key, values in vary.items()]
    found = Design("grid" if grid else "one-at-a-time", seeds=seeds).variants(axes, base.seed)
    rows = run_variants(Study(written, tuple(overrides)), found, Processes(jobs), _nothing)
    return pd.DataFrame(rows).set_index("variant")


def scenarios() -> builtins.list[str]:
    """Names of the scenarios that come with the program, and of those in the folder ``scenarios``."""
    from cosim.scenario.finding import find_scenarios

    return [folder.name for folder in find_scenarios()]


def overrides_of(settings: Settings | None) -> builtins.list[str]:
    """As the command line takes them, ``a.b=v``."""
    return [f"{key}={_text(value)}" for key, value in (settings or {}).items()]


def _watching(observers: Iterable[Observer], recorder: Observer, progress: bool) -> builtins.list[Observer]:
    """All who see a run."""
    from cosim.show.progress import ProgressBar
    from cosim.show.talk import Talk

    return [*observers, recorder, *([ProgressBar(Talk())] if progress else [])]


def _nothing(_row: dict[str, Any]) -> None:
    """Nobody is told of a variant that ends."""


def _text(value: Any) -> str:
    from cosim.scenario.text import value_text

    return value_text(value)
