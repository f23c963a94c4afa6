"""Commands on a recording: replay, compare, export, info, recover, report."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cosim.cli.grouping import grouped
from cosim.cli.options import ForceOption, JsonOption, RunArgument, SeriesSetOption
from cosim.cli.output import print_json
from cosim.errors import InputError
from cosim.outputs import whole, writable

if TYPE_CHECKING:
    from cosim.analysis.run_data import RunData
    from cosim.series.series import Series


@dataclass(frozen=True)
class Shown:
    """Where a replay goes to; without any of them, to the viewer on the screen."""

    save: Annotated[Path | None, typer.Option(help="write a rerun file (.rrd) instead of opening a viewer")] = None
    web: Annotated[bool, typer.Option("--web", help="serve the viewer to a browser on this machine")] = False
    screenshot: Annotated[Path | None, typer.Option(help="write a picture (.png), no screen needed")] = None
    video: Annotated[Path | None, typer.Option(help="write a film of the recorded frames (.mp4)")] = None
    follow: Annotated[
        bool, typer.Option("--follow", help="go along with a run that is still being recorded, until it ends")
    ] = False

    def check(self, recording: Path, series: Path | None) -> None:
        """One of them at most, and its place can be written."""
        places = (
            ("--save", self.save, ".rrd"),
            ("--screenshot", self.screenshot, ".png"),
            ("--video", self.video, ".mp4"),
        )
        if sum((self.web, *(path is not None for _, path, _ in places))) > 1:
            raise InputError("--save, --web, --screenshot and --video exclude each other; give one of them")
        if self.follow and (self.screenshot is not None or self.video is not None):
            raise InputError("--follow goes with a viewer or with --save; leave out --screenshot and --video")
        if series is not None and (self.follow or self.screenshot is not None or self.video is not None):
            raise InputError("--measured lies over curves of a viewer; leave out --follow, --screenshot and --video")
        for _, path, kind in places:
            if path is not None:
                writable(path, kind, [recording, *([] if series is None else [series])])


@grouped
def replay(
    recording: RunArgument,
    shown: Shown,
    at: Annotated[
        float | None, typer.Option("--at", "--time", help="simulated time of the picture in s; default the end")
    ] = None,
    section: Annotated[
        float | None, typer.Option(help="y of the section of the picture in m; default where most force acts")
    ] = None,
    series: Annotated[Path | None, typer.Option("--measured", help="a series over the curves, as of `compare`")] = None,
    settings: SeriesSetOption = None,
) -> None:
    """Look at a recording: in rerun, as a picture, or as a film. Sheet, structure, blocks, sections, loads, events."""
    shown.check(recording, series)
    if (at is not None or section is not None) and shown.screenshot is None:
        raise InputError("--at and --section belong to --screenshot; add --screenshot x.png")
    if shown.screenshot is not None or shown.video is not None:
        _draw(recording, shown, at, section)
        return
    os.environ.setdefault("RUST_LOG", "off")  # rerun's own log; what goes wrong it says to us as well
    from cosim.show import replay as show

    measured = None if series is None else partial(_in_time_of, series, settings or ())
    if shown.follow:
        from cosim.show.follow import follow

        follow(recording, shown.save, shown.web)
    elif shown.save is not None:
        show.save(recording, shown.save, measured)
    elif shown.web:
        show.serve(recording, measured)
    else:
        show.open_viewer(recording, measured)


def _in_time_of(path: Path, settings: Sequence[str], run: RunData) -> Series:
    """A measured series laid beside a run."""
    from cosim.series.compare import files

    return replace(files(path, [run], settings)[0].measured, name=path.name)


def _draw(recording: Path, shown: Shown, at: float | None, section: float | None) -> None:
    from cosim.show.opening import opened
    from cosim.show.progress import counted
    from cosim.show.still import screenshot, video

    run = opened(recording)
    if shown.screenshot is not None:
        with whole(shown.screenshot, ".png") as part:
            screenshot(run, recording, part, at, section)
    elif shown.video is not None:
        with whole(shown.video, ".mp4") as part, counted("pictures") as told:
            video(run, recording, part, told)


def compare(
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="RUN... [REFERENCE] [SERIES]",
            help="recordings; reference.toml or its folder, default: of the run; a measured series (.csv, .parquet, "
            "series.toml) or as the last of several recordings another run",
        ),
    ],
    settings: SeriesSetOption = None,
    pictures: Annotated[Path | None, typer.Option(help="folder for pictures of run and series (.png)")] = None,
    as_json: JsonOption = False,
) -> None:
    """Put the features of recordings beside what was measured and what others computed, and beside a series."""
    from cosim.cli.comparing import compared
    from cosim.series.beside import sort_files
    from cosim.series.compare import files as beside_series
    from cosim.show.opening import opened
    from cosim.show.series_tables import write_pictures

    asked = sort_files(files)
    if asked.series is None and (settings or pictures):
        raise InputError("--set and --pictures belong to a series; name its file, for example measured.csv")
    runs = [opened(run) for run in asked.runs]
    pairs = [None] * len(runs) if asked.series is None else beside_series(asked.series, runs, settings or ())
    objects = [compared(run, asked.reference, pair, as_json) for run, pair in zip(runs, pairs, strict=True)]
    for pair in pairs:
        if pair is not None and pictures is not None:
            write_pictures(pair, pictures)
    if as_json:
        print_json(objects[0] if len(objects) == 1 else objects)


def export(
    recording: RunArgument,
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            help="the file; its ending says the form: .csv, .parquet, .nc or .h5, .pvd (ParaView), .dat (OpenFAST)",
        ),
    ],
    table: Annotated[
        str | None, typer.Option(help="of .csv and .parquet: loads (default), events, ledger, budget")
    ] = None,
) -> None:
    """A recording in a form that other programs read."""
    from cosim.export.write import FORMS, check
    from cosim.export.write import export as write
    from cosim.show.console import print_line
    from cosim.show.opening import opened

    check(output, table, recording)
    write(opened(recording), recording, output, table)
    print_line(f"{output}: written, {FORMS[output.suffix.lower()][1]}")


def info(
    recording: RunArgument,
    events: Annotated[bool, typer.Option("--events", help="list all events")] = False,
    as_json: JsonOption = False,
) -> None:
    """What a recording holds: scenario, version, time, peaks, events."""
    from cosim.analysis.summary import summary
    from cosim.show.opening import opened
    from cosim.show.tables import print_info

    content = summary(opened(recording))
    print_json(content) if as_json else print_info(content, events)


def recover(
    recording: RunArgument,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="the clean recording")] = None,
    force: ForceOption = False,
    as_json: JsonOption = False,
) -> None:
    """Write what can be read of a truncated or damaged recording as a clean file."""
    from cosim.recording.recover import recover as rescue
    from cosim.show.console import print_line

    output = writable(output or recording.with_suffix(".recovered.mcap"), ".mcap", [recording], force)
    data = rescue(recording, output)
    content = {
        "run": recording.name,
        "recording": str(output),
        "windows": len(data.t_ns),
        "simulated_s": float(data.t[-1]),
        "events": len(data.events),
    }
    print_json(content) if as_json else print_line(
        f"{output}: {content['windows']} windows, {content['simulated_s']:g} s, {content['events']} events"
    )


def report(
    recording: RunArgument,
    output: Annotated[Path, typer.Option("-o", "--output", help="the page (.html)")],
    series: Annotated[Path | None, typer.Option(help="a measured series, as of `cosim compare`")] = None,
    settings: SeriesSetOption = None,
) -> None:
    """One HTML page of a recording: loads by phase, balances, events, numbers beside reference and series."""
    from cosim.recording.reader import recorded_pictures, recorded_stresses
    from cosim.series.compare import files
    from cosim.show.console import print_line
    from cosim.show.opening import opened
    from cosim.show.report import write_report

    inputs = [recording] if series is None else [recording, series]
    writable(output, ".html", inputs)
    run = opened(recording)
    measured = None if series is None else files(series, [run], settings or ())[0]
    with whole(output, ".html") as part:
        write_report(run, part, measured, recorded_pictures(recording), recorded_stresses(recording))
    print_line(f"{output}: written")
