"""The command `cosim sweep`: progress, table, CSV, JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich import box
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from cosim.scenario.finding import locate
from cosim.scenario.loading import load_scenario
from cosim.show.console import print_line, stderr, stdout, warn
from cosim.signals import StoppedError
from cosim.study.sweep import Row, sweep
from cosim.study.table import Table as TableFile
from cosim.study.variants import parse_axis, variants

COLUMNS = (
    "variant",
    "Fx",
    "at [s]",
    "ratio",
    "Fz",
    "at [s]",
    "ratio",
    "breaking",
    "rotating",
    "sliding",
    "mean Fx",
    "wall [s]",
)


def run_sweep(
    scenario: str, vary: Sequence[str], overrides: Sequence[str], grid: bool, workers: int, table: TableFile
) -> dict[str, Any]:
    """All variants with a progress bar, written to ``table`` as they end; the content of ``--json``.

    If it is stopped, what has ended until then is shown.
    """
    axes = [parse_axis(text) for text in vary]
    file = locate(scenario).resolve()  # once: every process reads the same file
    base = load_scenario(file, overrides)
    for text in base.warnings:
        warn(text)
    keys = [axis.key for axis in axes]
    content = {"scenario": base.title, "overrides": list(overrides), "keys": keys, "grid": grid}
    chosen = variants(axes, grid)
    rows: list[Row] = []
    try:
        with _progress() as progress:
            task = progress.add_task(base.title, total=len(chosen))

            def done(row: Row, ended: list[Row]) -> None:
                progress.advance(task)
                what = row["error"] or f"Fx {row['fx_peak'] / 1e6:.2f} MN, Fz {row['fz_peak'] / 1e6:.2f} MN"
                progress.console.print(f"{row['variant']}: {what}", highlight=False, soft_wrap=True)
                rows[:] = ended
                table.write(keys, ended)

            sweep(str(file), overrides, chosen, workers, done)
    except StoppedError:
        if rows:
            show({**content, "variants": rows})
        raise
    return {**content, "failed": sum(row["error"] is not None for row in rows), "variants": rows}


def _progress() -> Progress:
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("variants, remaining"),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=stderr, transient=True)


def show(content: dict[str, Any]) -> None:
    """The table for people."""
    title = f"{content['scenario']}: peaks of 0.5 s means [MN], ratio to the base, largest Fx of each phase"
    table = Table(title=title, box=box.SIMPLE, title_justify="left", padding=(0, 0, 0, 1))
    for k, name in enumerate(COLUMNS):
        table.add_column(Text(name), justify="right" if k else "left", min_width=0 if k else 28)
    for row in content["variants"]:
        if row["error"] is not None:
            table.add_row(row["variant"], "failed", *[""] * 10)
            continue
        phases = [_mega(row[f"{p}_fx_peak"]) for p in ("breaking", "rotating", "sliding")]
        load = [(_mega(row[f"{c}_peak"]), f"{row[f'{c}_time']:.2f}", _ratio(row[f"{c}_ratio"])) for c in ("fx", "fz")]
        table.add_row(row["variant"], *load[0], *load[1], *phases, _mega(row["fx_mean"]), f"{row['wall_s']:.1f}")
    stdout.print(table)
    for row in content["variants"]:
        if row["error"] is not None:
            print_line(f"failed: {row['variant']}: {row['error']}")
        elif max(row["fx_time"], row["fz_time"]) >= row["simulated_s"]:
            print_line(f"largest load at the end: {row['variant']}: it may still grow; give a longer scenario.duration")


def _mega(value: float) -> str:
    return f"{value / 1e6:.2f}"


def _ratio(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"
