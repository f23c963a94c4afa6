"""The command line: ``cosim run | sweep | replay | compare | report | baseline | verify | info | recover | list``.

Only this file exits. Every expected error is one line on standard error: exit 2 for a bad input, 1 for a failed run or
check. With ``--json`` standard output holds one JSON object and nothing else. Slow imports stay inside the commands.
"""

from __future__ import annotations

import json
import math
import os
import sys
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from cosim.errors import FailedError, InputError

app = typer.Typer(
    name="cosim",
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Ice loads on sloping structures: a lattice that breaks, coupled with rubble that slides.",
)

ScenarioArgument = Annotated[str, typer.Argument(help="scenario folder, TOML file, or name from `cosim list`")]
RunArgument = Annotated[Path, typer.Argument(help="recording (.mcap)")]
SetOption = Annotated[list[str] | None, typer.Option("--set", metavar="A.B=V", help="override a value of the scenario")]
JsonOption = Annotated[bool, typer.Option("--json", help="one JSON object on standard output")]


@app.command()
def run(
    scenario: ScenarioArgument,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="write a recording (.mcap)")] = None,
    overrides: SetOption = None,
    as_json: JsonOption = False,
) -> None:
    """Simulate a scenario."""
    from cosim.console import ProgressBar, print_run, warn
    from cosim.observer import Observer
    from cosim.recording import Recorder
    from cosim.scenario import load_scenario

    loaded = load_scenario(scenario, overrides or ())
    for text in loaded.warnings:
        warn(text)
    observers: list[Observer] = [ProgressBar()]
    if output is not None:
        observers.append(Recorder(_writable(output)))
    result = _simulate(loaded, observers)
    result["recording"] = None if output is None else str(output)
    _print_json(result) if as_json else print_run(result)


def _simulate(scenario: Any, observers: list[Any]) -> dict[str, Any]:
    """Run and close the observers whatever happens."""
    from cosim.run import run_scenario

    try:
        result: dict[str, Any] = run_scenario(scenario, observers).to_json()
        return result
    finally:
        for observer in observers:
            observer.on_close()


@app.command("sweep")
def sweep_variants(
    scenario: ScenarioArgument,
    vary: Annotated[list[str], typer.Option("--vary", metavar="A.B=V,V", help="a key and its values, repeatable")],
    overrides: SetOption = None,
    grid: Annotated[bool, typer.Option("--grid/--one-at-a-time", help="all combinations, or each value alone")] = False,
    workers: Annotated[int, typer.Option("-j", "--jobs", min=1, help="variants that run at the same time")] = 1,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="write the table (.csv), SI units")] = None,
    plot: Annotated[Path | None, typer.Option(help="draw the peaks against the base (.png)")] = None,
    as_json: JsonOption = False,
) -> None:
    """Run variants of a scenario and put their loads side by side."""
    from cosim import sweep_command as command

    for path in (output, plot):
        if path is not None:
            _writable(path)
    content = command.run_sweep(scenario, vary, overrides or (), grid, workers)
    if output is not None:
        command.write_csv(content, output)
    _print_json(content) if as_json else command.show(content)
    if plot is not None:
        from cosim.tornado import tornado

        tornado(content, plot)
    if content["failed"]:
        raise FailedError(f"{content['failed']} of {len(content['variants'])} variants failed; their lines say why")


@app.command()
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
    for path in (save, screenshot):
        if path is not None:
            _writable(path)
    from cosim import replay as show

    if save is not None:
        show.save(recording, save)
    elif screenshot is not None:
        show.screenshot(recording, screenshot, time)
    elif web:
        show.serve(recording)
    else:
        show.open_viewer(recording)


@app.command()
def compare(
    recording: RunArgument,
    reference: Annotated[Path | None, typer.Argument(help="reference.toml or its folder; default: of the run")] = None,
    as_json: JsonOption = False,
) -> None:
    """Put the features of a recording beside what was measured and what others computed."""
    from cosim import compare as comparison
    from cosim.baselines.beside import beside
    from cosim.console import print_compare
    from cosim.console_baseline import print_beside
    from cosim.recording import read_run

    data = read_run(recording)
    name, loaded = comparison.reference_of(data, reference)
    rows, design = comparison.compare(data, loaded), beside(data)
    if as_json:
        _print_json({**comparison.to_json(data, name, rows), "design": design})
    else:
        print_compare(loaded.title, rows)
        print_beside(design)


@app.command()
def baseline(scenario: ScenarioArgument, overrides: SetOption = None, as_json: JsonOption = False) -> None:
    """Design formulas for the ice and the structure of a scenario: Croasdale, Ralston, Nevel."""
    from cosim.baselines.methods import design_loads
    from cosim.console_baseline import print_baseline
    from cosim.scenario import load_scenario

    loaded = load_scenario(scenario, overrides or ())
    found = design_loads(loaded.model)
    _print_json(found) if as_json else print_baseline(loaded.title, found)


@app.command()
def info(recording: RunArgument, as_json: JsonOption = False) -> None:
    """What a recording holds: scenario, version, time, peaks, events."""
    from cosim.console import print_info
    from cosim.features import summary
    from cosim.recording import read_run

    content = summary(read_run(recording))
    _print_json(content) if as_json else print_info(content)


@app.command()
def recover(
    recording: RunArgument,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="the clean recording")] = None,
    as_json: JsonOption = False,
) -> None:
    """Write what can be read of a truncated recording as a clean file."""
    from cosim.console import print_line
    from cosim.recording import recover as rescue

    output = _writable(output or recording.with_suffix(".recovered.mcap"))
    data = rescue(recording, output)
    content = {
        "run": recording.name,
        "recording": str(output),
        "windows": len(data.t_ns),
        "simulated_s": float(data.t[-1]),
        "events": len(data.events),
    }
    _print_json(content) if as_json else print_line(
        f"{output}: {content['windows']} windows, {content['simulated_s']:g} s, {content['events']} events"
    )


@app.command("list")
def list_scenarios(as_json: JsonOption = False) -> None:
    """The scenarios that are found here and in the project."""
    from cosim.console import print_scenarios
    from cosim.scenario import find_scenarios, load_scenario

    found = [load_scenario(folder) for folder in find_scenarios()]
    rows = [
        {
            "name": s.name,
            "title": s.title,
            "description": s.model.scenario.description,
            "duration_s": s.duration_ns / 1e9,
        }
        for s in found
    ]
    _print_json({"scenarios": rows}) if as_json else print_scenarios(rows)


@app.command()
def report(
    recording: RunArgument,
    output: Annotated[Path, typer.Option("-o", "--output", help="the page (.html)")],
) -> None:
    """One HTML page of a recording: loads by phase, balances, events, numbers beside the reference."""
    from cosim.console import print_line
    from cosim.recording import read_run
    from cosim.report import write_report

    write_report(read_run(recording), _writable(output))
    print_line(f"{output}: written")


@app.command()
def verify(
    case: Annotated[str | None, typer.Argument(help="a case; all without it")] = None,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="K=V", help="parameter of the case")] = None,
    plots: Annotated[Path | None, typer.Option(help="folder for the figures, as PNG")] = None,
    quick: Annotated[bool, typer.Option(help="coarser and shorter where a case is slow")] = False,
    as_json: JsonOption = False,
) -> None:
    """Check the parts against closed forms and the tables and figures of their sources."""
    from cosim.verify.command import verify_command

    verify_command(case, settings, plots, quick, as_json)


def _writable(path: Path) -> Path:
    """Refuse a place that cannot be written before hours are simulated."""
    if path.is_dir():
        raise InputError(f"{path}: is a folder; name a file in it")
    if not path.parent.is_dir():
        raise InputError(f"{path}: no such folder {path.parent}; create it or write elsewhere")
    return path


def _print_json(content: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(_finite(content), indent=2, allow_nan=False) + "\n")


def _finite(value: Any) -> Any:
    """JSON has no nan: null instead. Numpy scalars become numbers."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    if hasattr(value, "item"):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


def explain(error: Exception) -> tuple[str, int]:
    """The line and the exit code of an error; an unexpected one is named as such."""
    if isinstance(error, InputError):
        return str(error), 2
    if isinstance(error, FailedError) or type(error).__name__ == "SimulationError":
        return str(error), 1
    if hasattr(error, "format_message"):  # the argument parser's own
        return f"{error.format_message()} (`cosim --help` shows the commands)", 2
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}; check the path", 2
    return f"unexpected {type(error).__name__}: {error}; set COSIM_TRACEBACK=1 to see where, and report it", 1


def main(arguments: list[str] | None = None) -> NoReturn:
    """Entry point: what goes wrong becomes one line and an exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        code = app(args=arguments or ["--help"], prog_name="cosim", standalone_mode=False)
    except KeyboardInterrupt:
        text, code = "stopped by the user; a recording holds what was simulated until now", 130
    except Exception as error:
        if os.environ.get("COSIM_TRACEBACK"):
            raise
        text, code = explain(error)
    else:
        raise SystemExit(code if isinstance(code, int) else 0)
    sys.stderr.write(f"cosim: {' '.join(text.split())}\n")
    raise SystemExit(code)


if __name__ == "__main__":
    main()
