"""The command `cosim sweep`: progress, table, CSV, JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from cosim.scenario.finding import locate
from cosim.scenario.loading import load_scenario
from cosim.show.cells import over_text
from cosim.show.check import fact_lines, judged
from cosim.show.console import as_line, new_table, print_line, stderr, stdout
from cosim.show.scale import scale_of
from cosim.show.talk import QUIET, Talk
from cosim.signals import StoppedError
from cosim.study.sweep import Row, sweep
from cosim.study.table import Table
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
    scenario: str, vary: Sequence[str], overrides: Sequence[str], grid: bool, workers: int, table: Table, talk: Talk
) -> dict[str, Any]:
    """All variants with a progress bar, written to ``table`` as they end; the content of ``--json``.

    If it is stopped, what has ended until then is shown.
    """
    axes = [parse_axis(text) for text in vary]
    file = locate(scenario).resolve()  # once: every process reads the same file
    base = load_scenario(file, overrides)
    for text in base.warnings:
        talk.warn(text)
    for line in fact_lines(judged(base)["facts"]):
        talk.detail(line)
    keys = [axis.key for axis in axes]
    content = {"scenario": base.title, "overrides": list(overrides), "keys": keys, "grid": grid}
    chosen = variants(axes, grid)
    rows: list[Row] = []
    try:
        with _progress(talk) as progress:
            task = progress.add_task(as_line(base.title)[:30], total=len(chosen))

            def done(row: Row, ended: list[Row]) -> None:
                progress.advance(task)
                talk.note(f"{row['variant']}: {row['error'] or _in_a_line(row)}")
                rows[:] = ended
                table.write(keys, ended)

            sweep(str(file), overrides, chosen, workers, done)
    except StoppedError:
        if rows:
            show({**content, "variants": rows})
        raise
    return {**content, "failed": sum(row["error"] is not None for row in rows), "variants": rows}


def _progress(talk: Talk) -> Progress:
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("variants, remaining"),
        TimeRemainingColumn(),
    )
    return Progress(*columns, console=stderr, transient=True, disable=talk.level == QUIET)


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
