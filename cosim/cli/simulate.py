"""Commands that simulate: run, verify."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cosim.cli.grouping import grouped
from cosim.cli.options import ForceOption, JsonOption, RunArgument, ScenarioArgument, SetOption, talking
from cosim.cli.output import print_json
from cosim.errors import FailedError, InputError
from cosim.outputs import whole, writable
from cosim.show.talk import Talk

if TYPE_CHECKING:
    from cosim.scenario.scenario import Scenario
    from cosim.verify.case import CaseResult
    from coupling.scheduler import Scheduler


IceOption = Annotated[Path | None, typer.Option(help="write cracks and lost ice at the end (.csv, .parquet)")]
PiecesOption = Annotated[
    Path | None, typer.Option(help="write all pieces of ice at the end, for a floe that follows (.json)")
]


@dataclass(frozen=True)
class RunFiles:
    """What a run writes."""

    output: Annotated[Path | None, typer.Option("-o", "--output", help="write a recording (.mcap)")] = None
    ice: IceOption = None
    pieces: PiecesOption = None
    force: ForceOption = False
    checkpoint_every: Annotated[
        str | None, typer.Option(metavar="TIME", help="as --set recording.checkpoint_every: for `cosim resume`")
    ] = None

    follow: Annotated[bool, typer.Option("--follow", help="show the run in rerun while it is recorded")] = False

    @property
    def overrides(self) -> list[str]:
        """What is said of the scenario here."""
        return [] if self.checkpoint_every is None else [f"recording.checkpoint_every={self.checkpoint_every}"]

    def check(self, scenario: Scenario) -> None:
        """Before anything is simulated."""
        if self.follow and self.output is None:
            raise InputError("--follow shows what is recorded; name a recording with -o run.mcap")
        if self.output is not None:
            writable(self.output, ".mcap", scenario.inputs, self.force)
        _check_ends(scenario, self.ice, self.pieces, scenario.inputs, self.force)


@talking
@grouped
def run(
    scenario: ScenarioArgument,
    files: RunFiles,
    overrides: SetOption = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="check and build, simulate nothing")] = False,
    as_json: JsonOption = False,
    *,
    talk: Talk,
) -> None:
    """Simulate a scenario."""
    from cosim.observer import Observer
    from cosim.recording.writer import Recorder
    from cosim.scenario.loading import load_scenario
    from cosim.show.check import fact_lines, judged
    from cosim.show.companion import Companion
    from cosim.show.progress import ProgressBar
    from cosim.warming import compile_ahead
    from cosim.watched import simulate

    loaded = load_scenario(scenario, [*(overrides or ()), *files.overrides])
    about = judged(loaded)
    for text in about["faults"]:
        raise InputError(text)
    for text in loaded.warnings:
        talk.warn(text)
    for line in (*fact_lines(about["facts"]), about["cost_text"]):
        talk.detail(line)
    observers: list[Observer] = [ProgressBar(talk)]
    files.check(loaded)
    if dry_run:
        _dry_run(loaded, about, as_json)
        return
    if files.output is not None:
        observers.append(Recorder(files.output, force=files.force))
        observers += [Companion(files.output)] if files.follow else []
    compile_ahead(loaded, talk)
    _tell(simulate(loaded, observers, _at_end(loaded, files.ice, files.pieces)), files.output, as_json, talk)


@talking
def resume(
    recording: RunArgument,
    ice: IceOption = None,
    pieces: PiecesOption = None,
    as_json: JsonOption = False,
    *,
    talk: Talk,
) -> None:
    """Go on with an interrupted run from its last checkpoint, with the bits that it would have had."""
    from cosim.checkpoint.interrupted import interrupted
    from cosim.observer import Observer
    from cosim.recording.writer import Recorder
    from cosim.show.progress import ProgressBar
    from cosim.watched import simulate

    run = interrupted(recording)
    _check_ends(run.scenario, ice, pieces, [recording, *run.scenario.inputs])
    for text in run.warnings:
        talk.warn(text)
    talk.detail(f"goes on at {run.since.t_ns / 1e9:g} s")
    observers: list[Observer] = [Recorder(recording, since=run.since), ProgressBar(talk)]
    _tell(simulate(run.scenario, observers, _at_end(run.scenario, ice, pieces), run.kept), recording, as_json, talk)


def _tell(result: dict[str, Any], recording: Path | None, as_json: bool, talk: Talk) -> None:
    """What a run came to."""
    from cosim.show.tables import print_run, result_lines

    result["recording"] = None if recording is None else str(recording)
    for line in result_lines(result):
        talk.keep(line)
    print_json(result) if as_json else print_run(result, talk.level)


def _check_ends(
    scenario: Scenario, ice: Path | None, pieces: Path | None, inputs: Sequence[Path], force: bool = False
) -> None:
    """What `_at_end` writes, before anything is simulated."""
    if ice is not None:
        writable(ice, _kind(ice), inputs, force)
    if pieces is not None:
        if not scenario.rubble.enabled:
            text = "--pieces writes the rubble of a run, and rubble.enabled is false; leave one of the two out"
            raise InputError(text)
        writable(pieces, ".pieces", inputs, force)


def _at_end(scenario: Scenario, ice: Path | None, pieces: Path | None) -> Callable[[Scheduler], None]:
    def keep(scheduler: Scheduler) -> None:
        if ice is not None:
            _keep_ice(ice, scheduler)
        if pieces is not None:
            _keep_pieces(pieces, scenario, scheduler)

    return keep


def _kind(ice: Path) -> str:
    return ".parquet" if ice.suffix == ".parquet" else ".ice"


def _keep_ice(path: Path, scheduler: Scheduler) -> None:
    """Writes what of the sheet is broken, as `sheet.broken` reads it."""
    from cosim.ice.broken import write
    from coupling.sheet_port import SheetPort

    assert isinstance(scheduler.sheet, SheetPort)
    with whole(path, _kind(path)) as part:
        write(scheduler.sheet.sheet, part)


def _keep_pieces(path: Path, scenario: Scenario, scheduler: Scheduler) -> None:
    """Writes all pieces, as `rubble.pieces` reads them; the sheet is used up."""
    from cosim.ice.pieces import write

    with whole(path, ".pieces") as part:
        write(scheduler, scenario, part)


def _dry_run(scenario: Scenario, about: dict[str, Any], as_json: bool) -> None:
    """Build all participants, tell what would run, and simulate nothing."""
    from cosim.build import build
    from cosim.show.check import print_check

    build(scenario)
    print_json(about) if as_json else print_check(about)


def verify(
    case: Annotated[str | None, typer.Argument(help="a case; all without it")] = None,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="K=V", help="parameter of the case")] = None,
    plots: Annotated[Path | None, typer.Option(help="folder for the figures, as PNG")] = None,
    quick: Annotated[bool, typer.Option(help="coarser and shorter where a case is slow")] = False,
    as_json: JsonOption = False,
) -> None:
    """Check the parts against closed forms and the tables and figures of their sources."""
    from cosim.show.console import print_progress
    from cosim.show.verify_table import print_verification
    from cosim.verify.cases import run as run_cases

    def done(result: CaseResult, seconds: float) -> None:
        if case is None:
            print_progress(f"{result.case}: {'ok' if result.passed else 'FAILED'}, {seconds:.1f} s")

    try:
        results = run_cases(case, settings, plots, quick, done)
    except ValueError as error:
        raise InputError(str(error)) from error
    if as_json:
        found = [result.as_dict() for result in results]
        print_json(found if case is None else found[0])
    else:
        print_verification(results)
    if failed := [result.case for result in results if not result.passed]:
        raise FailedError(f"{len(failed)} of {len(results)} cases miss their reference: {', '.join(failed)}")
