"""The command `cosim sweep`: progress, table, CSV, JSON."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from cosim.scenario.loading import load_scenario
from cosim.show.console import print_line, stderr, stdout, warn
from cosim.study.sweep import COMPONENTS, RESULTS, Row, sweep
from cosim.study.variants import Variant, parse_axis, variants

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


def run_sweep(scenario: str, vary: Sequence[str], overrides: Sequence[str], grid: bool, workers: int) -> dict[str, Any]:
    """All variants with a progress bar; the content of ``--json``."""
    axes = [parse_axis(text) for text in vary]
    base = load_scenario(scenario, overrides)
    for text in base.warnings:
        warn(text)
    chosen = variants(axes, grid)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("variants, remaining"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=stderr, transient=True) as progress:
        task = progress.add_task(base.title, total=len(chosen))

        def done(variant: Variant, row: Row) -> None:
            progress.advance(task)
            what = row.get("error") or f"Fx {row['fx_peak'] / 1e6:.2f} MN, Fz {row['fz_peak'] / 1e6:.2f} MN"
            progress.console.print(f"{variant.name}: {what}", highlight=False, markup=False, soft_wrap=True)

        rows = sweep(scenario, overrides, chosen, workers, done)
    return {
        "scenario": base.title,
        "overrides": list(overrides),
        "keys": [axis.key for axis in axes],
        "grid": grid,
        "failed": sum(row["error"] is not None for row in rows),
        "variants": rows,
    }


def write_csv(content: dict[str, Any], out: Path) -> None:
    """One line for each variant: name, varied keys (empty: as in the base), results in SI units, ratios, error."""
    names = ["variant", *content["keys"], *RESULTS, *(f"{c}_ratio" for c in COMPONENTS), "error"]
    with out.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(content["variants"])


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
