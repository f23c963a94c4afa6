"""What people see in a terminal: progress on standard error, tables. Numbers in MN, s, m^3."""

from __future__ import annotations

import sys
import time
from collections import Counter
from typing import Any

from rich import box
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from cosim.compare import Range, Row, ratio
from cosim.observer import RunInfo
from coupling.energy import STORES
from coupling.interface import NS, PHASES, Frame

WIDTH = None if sys.stdout.isatty() else 120  #: a pipe has no width of its own
stderr = Console(stderr=True)
stdout = Console(width=WIDTH)
SCALES = {"N": (1e-6, "MN"), "s": (1.0, "s"), "m^3": (1.0, "m^3")}  #: factor and unit of display


class ProgressBar:
    """Observer that shows simulated time, rate and the time that remains."""

    def __init__(self, console: Console | None = None) -> None:
        self._progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.fields[now]}"),
            TextColumn("{task.fields[rate]}"),
            TextColumn("remaining"),
            TimeRemainingColumn(),
            console=console or stderr,
            transient=True,
        )
        self._task: TaskID | None = None

    def on_start(self, run_info: RunInfo) -> None:
        self._duration = run_info.duration_ns / NS
        self._begin = time.monotonic()
        self._task = self._progress.add_task(run_info.scenario.title, total=self._duration, now="", rate="")
        self._progress.start()

    def on_frame(self, frame: Frame) -> None:
        if self._task is None:
            return
        t = frame.t_ns / NS
        wall = max(time.monotonic() - self._begin, 1e-9)
        self._progress.update(
            self._task, completed=t, now=f"{t:6.1f} of {self._duration:g} s", rate=f"{t / wall:.2f} x real time"
        )
        for line in event_lines(frame):
            self._progress.console.print(line, highlight=False, markup=False, soft_wrap=True)

    def on_close(self) -> None:
        self._progress.stop()


def event_lines(frame: Frame) -> list[str]:
    """One line for each kind of event of a window: the first of its kind, and how many more there are."""
    count = Counter(event.kind for event in frame.events)
    first = {event.kind: event for event in reversed(frame.events)}
    more = {kind: f" (and {n - 1} more)" if n > 1 else "" for kind, n in count.items()}
    return [
        f"{event.t_ns / NS:8.2f} s  {kind}: {event.text}{more[kind]}"
        for kind, event in sorted(first.items(), key=lambda item: item[1].t_ns)
    ]


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


def compare_cells(row: Row) -> tuple[str, ...]:
    """Name, simulated, thesis, ratio, measured, ratio and unit of a feature, as text."""
    f = row.feature
    factor, unit = SCALES.get(f.unit, (1.0, f.unit))
    beside = [
        text
        for value in (f.thesis, f.measured)
        for text in (_range(value, factor), number(ratio(row.simulated, value), 1.0))
    ]
    return f.name, number(row.simulated, factor), *beside, unit


def ledger_lines(ledger: dict[str, float | None]) -> list[str]:
    """Errors and masses of a run, and the energy terms that are at least 1 % of the work of the drift."""
    known = {name: value for name, value in ledger.items() if value is not None}
    errors = [f"{name} {value:.2g}" for name, value in known.items() if name.endswith(("_error", "residual", "_mass"))]
    least = 0.01 * abs(known.get("drift_work", 0.0))
    terms = [
        (name, value)
        for name, value in known.items()
        if (name in STORES or name.endswith("_loss")) and abs(value) >= max(least, 1.0)
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


def print_scenarios(rows: list[dict[str, Any]]) -> None:
    """`cosim list`."""
    table = new_table("scenario", "event", "s", title="Scenarios")
    table.columns[1].header = Text("what")
    for row in rows:
        table.add_row(row["name"], row["title"], f"{row['duration_s']:g}")
    stdout.print(table)


def print_line(text: str) -> None:
    stdout.print(text, highlight=False, markup=False, soft_wrap=True)


def warn(text: str) -> None:
    stderr.print(f"warning: {text}", style="yellow", highlight=False, markup=False, soft_wrap=True)


def new_table(*columns: str, title: str) -> Table:
    table = Table(title=title, box=box.SIMPLE, title_justify="left")
    for k, name in enumerate(columns):
        table.add_column(Text(name), justify="left" if k == 0 or name in ("event", "unit") else "right")
    return table


def number(value: float | None, factor: float) -> str:
    return "-" if value is None else f"{value * factor:.2f}"


def _range(value: Range | None, factor: float) -> str:
    if value is None:
        return "-"
    low, high = (f"{v * factor:g}" for v in value)
    return low if low == high else f"{low} to {high}"
