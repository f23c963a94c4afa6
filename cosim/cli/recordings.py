"""Commands on a recording: replay, compare, report, info, recover."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from cosim.cli.options import ForceOption, JsonOption, RunArgument
from cosim.cli.output import print_json
from cosim.errors import InputError
from cosim.outputs import whole, writable


def replay(
    recording: RunArgument,
    save: Annotated[Path | None, typer.Option(help="write a rerun file (.rrd) instead of opening a viewer")] = None,
    web: Annotated[bool, typer.Option("--web", help="serve the viewer to a browser")] = False,
    screenshot: Annotated[Path | None, typer.Option(help="write a picture (.png), no screen needed")] = None,
    time: Annotated[float | None, typer.Option(help="simulated time of the picture in s; default the end")] = None,
) -> None:
    """Look at a recording in rerun: sheet, structure, blocks, loads by phase, events."""
    if sum((save is not None, web, screenshot is not None)) > 1:
        raise InputError("--save, --web and --screenshot exclude each other; give one of them")
    if time is not None and screenshot is None:
        raise InputError("--time belongs to --screenshot; add --screenshot x.png")
    for path, kind in ((save, ".rrd"), (screenshot, ".png")):
        if path is not None:
            writable(path, kind, [recording])
    os.environ.setdefault("RUST_LOG", "off")  # rerun's own log; what goes wrong it says to us as well
    from cosim.show import replay as show

    if save is not None:
        show.save(recording, save)
    elif screenshot is not None:
        with whole(screenshot, ".png") as part:
            show.screenshot(recording, part, time)
    elif web:
        show.serve(recording)
    else:
        show.open_viewer(recording)


def compare(
    recording: RunArgument,
    reference: Annotated[Path | None, typer.Argument(help="reference.toml or its folder; default: of the run")] = None,
    as_json: JsonOption = False,
) -> None:
    """Put the features of a recording beside what was measured and what others computed."""
    from cosim.analysis import compare as comparison
    from cosim.analysis.lights import trust
    from cosim.baselines.beside import beside
    from cosim.show.baseline_tables import print_beside
    from cosim.show.opening import opened
    from cosim.show.tables import print_compare

    data = opened(recording)
    name, loaded = comparison.reference_of(data, reference)
    rows, design = comparison.compare(data, loaded), beside(data)
    if as_json:
        print_json({**comparison.to_json(data, name, rows), "design": design, "trust": trust(data)})
    else:
        print_compare(loaded.title, rows, trust(data))
        print_beside(design)


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
) -> None:
    """One HTML page of a recording: loads by phase, balances, events, numbers beside the reference."""
    from cosim.show.console import print_line
    from cosim.show.opening import opened
    from cosim.show.report import write_report

    writable(output, ".html", [recording])
    with whole(output, ".html") as part:
        write_report(opened(recording), part)
    print_line(f"{output}: written")
