"""Tables of the terminal: end of a run, recordings, comparison."""

from __future__ import annotations

from typing import Any

from rich.table import Table

from cosim.analysis.compare import Row
from cosim.show.cells import compare_cells, number
from cosim.show.console import new_table, stdout
from coupling.energy import LOAD_WORK, STORES
from coupling.interface import PHASES


def run_tables(result: dict[str, Any]) -> list[Table]:
    """End of a run: peaks by phase, and the events."""
    peaks = new_table("load", "Fx [MN]", "at [s]", "Fz [MN]", "at [s]", "F [MN]", "at [s]", title="Peaks")
    for name, values in [("total", result["peaks"]), *((p, result["peaks_by_phase"][p]) for p in PHASES)]:
        cells = [
            number(values[key][what], scale)
            for key in ("fx", "fz", "f")
            for what, scale in (("value", 1e-6), ("time", 1.0))
        ]
        peaks.add_row(name, *cells)
    tables = [peaks]
    if result["events"]:
        tables.append(events_table(result["events"]))
    return tables


def events_table(events: list[dict[str, Any]], most: int = 25) -> Table:
    """Events with the load at their time; a long list ends with how many are left out."""
    table = new_table("at [s]", "event", "Fx [MN]", "Fz [MN]", "cells", title="Events")
    for e in events[:most]:
        table.add_row(number(e["time"], 1.0), e["kind"], number(e["fx"], 1e-6), number(e["fz"], 1e-6), str(e["cells"]))
    if len(events) > most:
        table.add_row("", f"... {len(events) - most} more", "", "", "")
    return table


def compare_table(title: str, rows: list[Row]) -> Table:
    """Simulated beside computed and measured."""
    table = new_table("feature", "simulated", "thesis", "ratio", "measured", "ratio", "unit", title=title)
    for row in rows:
        table.add_row(*compare_cells(row))
    return table


def ledger_lines(ledger: dict[str, float | None]) -> list[str]:
    """Errors and masses of a run, and the energy terms that are at least 1 % of the work of the drift."""
    known = {name: value for name, value in ledger.items() if value is not None}
    errors = [f"{name} {value:.2g}" for name, value in known.items() if name.endswith(("_error", "residual", "_mass"))]
    least = 0.01 * abs(known.get("drift_work", 0.0))
    terms = [
        (name, value)
        for name, value in known.items()
        if (name in STORES or name.endswith(("_loss", LOAD_WORK))) and abs(value) >= max(least, 1.0)
    ]
    lines = ["ledger: " + ", ".join(errors)]
    if "drift_work" in known:
        terms.sort(key=lambda term: -abs(term[1]))
        went = ", ".join(f"{name.removesuffix('_loss')} {value / 1e6:.2f}" for name, value in terms)
        lines.append(f"energy [MJ]: work of the drift {known['drift_work'] / 1e6:.2f}; {went}")
    return lines


def print_run(result: dict[str, Any]) -> None:
    """End of `cosim run`."""
    for table in run_tables(result):
        stdout.print(table)
    ledger = "\n".join(ledger_lines(result["ledger"]))
    stdout.print(
        f"{result['simulated_s']:g} s simulated in {result['wall_s']:.1f} s "
        f"({result['real_time_factor']:.2f} x real time), {result['fragments']} fragments, "
        f"{result['blocks']} blocks\n{ledger}",
        highlight=False,
    )
    if result["recording"]:
        stdout.print(f"recording: {result['recording']}", highlight=False, soft_wrap=True)


def print_info(content: dict[str, Any]) -> None:
    """`cosim info`."""
    stdout.print(
        f"{content['title']} ({content['scenario']}), version {content['version']}, seed {content['seed']}\n"
        f"{content['simulated_s']:g} of {content['duration_s']:g} s, {content['windows']} windows, "
        f"overrides: {' '.join(content['overrides']) or 'none'}",
        highlight=False,
        soft_wrap=True,
        markup=False,
    )
    for table in run_tables(content):
        stdout.print(table)


def print_compare(title: str, rows: list[Row]) -> None:
    """`cosim compare`: the table, then where the numbers are from."""
    stdout.print(compare_table(title, rows))
    for row in rows:
        stdout.print(f"{row.feature.name}: {row.feature.source}", highlight=False, markup=False, soft_wrap=True)
