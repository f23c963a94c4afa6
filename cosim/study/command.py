"""The command `cosim sweep`: progress, table, CSV, JSON."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from cosim.scenario.loading import load_scenario
from cosim.show.cells import over_text
from cosim.show.console import new_table, plain, print_line, print_progress, stderr, stdout, warn
from cosim.show.scale import scale_of
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
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("variants, remaining"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=stderr, transient=True) as progress:
        task = progress.add_task(plain(base.title)[:30], total=len(chosen))

        def done(variant: Variant, row: Row) -> None:
            progress.advance(task)
            print_progress(f"{variant.name}: {row.get('error') or _in_a_line(row)}")

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
    ran = [row for row in content["variants"] if row["error"] is None]
    scale = scale_of((row[name] for row in ran for name in ("fx_peak", "fz_peak")), "N")
    over = " or ".join(dict.fromkeys(over_text(row["averaging_s"]) for row in ran))
    title = f"{content['scenario']}: peaks of means over {over} [{scale.unit}], ratio to the base, largest Fx of phases"
    table = new_table(*COLUMNS, title=title)
    table.columns[0].min_width = 28
    for row in content["variants"]:
        if row["error"] is not None:
            table.add_row(row["variant"], "failed", *[""] * (len(COLUMNS) - 1))
            continue
        phases = [scale.text(row[f"{p}_fx_peak"]) for p in ("breaking", "rotating", "sliding")]
        load = [
            (scale.text(row[f"{c}_peak"]), f"{row[f'{c}_time']:.2f}", _ratio(row[f"{c}_ratio"])) for c in ("fx", "fz")
        ]
        table.add_row(row["variant"], *load[0], *load[1], *phases, scale.text(row["fx_mean"]), f"{row['wall_s']:.1f}")
    stdout.print(table)
    for row in content["variants"]:
        if row["error"] is not None:
            print_line(f"failed: {row['variant']}: {row['error']}")
        elif row["not_trustworthy"]:
            print_line(f"not trustworthy: {row['variant']}: because {row['not_trustworthy']}")


def _in_a_line(row: Row) -> str:
    scale = scale_of((row["fx_peak"], row["fz_peak"]), "N")
    return f"Fx {scale.labelled(row['fx_peak'])}, Fz {scale.labelled(row['fz_peak'])}"


def _ratio(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"
