"""Tables of the terminal: end of a run, recordings, comparison."""

from __future__ import annotations

from collections import Counter
from typing import Any

from cosim.analysis.compare import Row
from cosim.analysis.lights import trust_lines
from cosim.show.cells import COMPARED, compare_cells, over_text
from cosim.show.console import PlainTable, new_table, print_line, stdout
from cosim.show.scale import Scale, scale_of, seconds, significant
from coupling.energy import LOAD_WORK, MOVING, STORES
from coupling.interface import PHASES

COMPONENTS = ("fx", "fz", "f")


def peaks_table(result: dict[str, Any]) -> PlainTable:
    """Peaks of all phases and of each, with the time over which they are means."""
    rows = [("total", result["peaks"]), *((p, result["peaks_by_phase"][p]) for p in PHASES)]
    loads = scale_of((values[key]["value"] for _, values in rows for key in COMPONENTS), "N")
    times = seconds(values[key]["time"] for _, values in rows for key in COMPONENTS)
    heads = [head for name in ("Fx", "Fz", "F") for head in (f"{name} [{loads.unit}]", "at [s]")]
    title = f"Peaks of the mean load over {over_text(result['averaging_s'])}"
    table = new_table("load", *heads, title=title)
    for name, values in rows:
        cells = []
        for key in COMPONENTS:
            value = values[key]["value"]
            cells += [loads.text(value), times.text(values[key]["time"] if value else None)]
        table.add_row(name, *cells)
    return table


def events_table(events: list[dict[str, Any]], averaging: float) -> PlainTable:
    """All events with the load at their time."""
    loads = scale_of((e[key] for e in events for key in ("fx", "fz")), "N")
    times = Scale(1.0, "s", 3)
    heads = ("at [s]", "event", f"Fx [{loads.unit}]", f"Fz [{loads.unit}]", "cells", "cause")
    table = new_table(*heads, title=f"Events, loads as means over {over_text(averaging)}")
    for e in events:
        cells = (times.text(e["time"]), e["kind"], loads.text(e["fx"]), loads.text(e["fz"]), str(e["cells"]))
        table.add_row(*cells, e.get("cause", ""))
    return table


def events_line(events: list[dict[str, Any]]) -> str:
    """How many events of each kind there were, and when the first one was."""
    if not events:
        return "events: none, no cell has failed"
    count = Counter(e["kind"] for e in events)
    first = {e["kind"]: e["time"] for e in reversed(events)}
    return "events: " + ", ".join(f"{n} {kind} (from {first[kind]:.2f} s)" for kind, n in count.items())


def ledger_lines(ledger: dict[str, float | None], full: bool = False) -> list[str]:
    """Largest error of a run's balances, and the energy terms of at least 5 % of the work of the drift; or all."""
    known = {name: value for name, value in ledger.items() if value is not None}
    kinds = ("_error", "residual", "_mass") if full else ("_error", "residual")
    errors = [f"{name} {value:.2g}" for name, value in known.items() if name.endswith(kinds)]
    lines = ["ledger: " + ", ".join(errors)]
    if "drift_work" not in known:
        return lines
    work = known["drift_work"]
    moved = known.get(MOVING, 0.0)
    least = 0.0 if full else 0.05 * max(abs(work), abs(moved))
    terms = [
        (name, value)
        for name, value in known.items()
        if (name in STORES or name.endswith(("_loss", LOAD_WORK))) and abs(value) > least
    ]
    scale = scale_of([work, *(value for _, value in terms)], "J")
    terms.sort(key=lambda term: -abs(term[1]))
    went = ", ".join(f"{name.removesuffix('_loss')} {scale.text(value)}" for name, value in terms)
    also = f", of the structure {scale.text(moved)}" if MOVING in known else ""
    return [*lines, f"energy [{scale.unit}]: work of the drift {scale.text(work)}{also}; {went}"]


def print_run(result: dict[str, Any], detail: int = 0) -> None:
    """End of `cosim run` on one screen; with more ``detail`` also all events and the whole ledger, with less a line."""
    if detail < 0:
        for line in result_lines(result):
            print_line(line)
        return
    stdout.print(peaks_table(result))
    print_line(
        f"{result['simulated_s']:g} s simulated in {result['wall_s']:.1f} s "
        f"({result['real_time_factor']:.2f} x real time), {result['fragments']} fragments, {result['blocks']} blocks, "
        f"{_steps(result)}"
    )
    if detail > 0 and result["events"]:
        stdout.print(events_table(result["events"], result["averaging_s"]))
    print_line(events_line(result["events"]))
    for line in (*trust_lines(result["trust"]), *ledger_lines(result["ledger"], full=detail > 0)):
        print_line(line)
    if result["recording"]:
        print_line(f"recording: {result['recording']}")
    else:
        print_line("nothing was recorded: -o run.mcap keeps a run")


def _steps(result: dict[str, Any]) -> str:
    """Windows and sub-steps, given or chosen."""
    window, substep = (f"{significant(1e3 * result[key])} ms" for key in ("window_s", "substep_s"))
    return f"windows of {window}, sub-steps of {substep}"


def result_lines(result: dict[str, Any]) -> list[str]:
    """The peaks of the whole load in a line, and what speaks against them in another."""
    loads = scale_of((result["peaks"][key]["value"] for key in COMPONENTS), "N")
    parts = [
        f"{name} {loads.labelled(result['peaks'][key]['value'])} at {result['peaks'][key]['time']:.2f} s"
        for key, name in (("fx", "Fx"), ("fz", "Fz"))
    ]
    line = f"peaks, means over {over_text(result['averaging_s'])}: {', '.join(parts)}"
    return [line] if result["trust"]["trustworthy"] else [line, trust_lines(result["trust"])[-1]]


def print_info(content: dict[str, Any], events: bool = False) -> None:
    """`cosim info`; with all ``events`` or with their number."""
    print_line(f"{content['title']} ({content['scenario']}), version {content['version']}, seed {content['seed']}")
    print_line(
        f"{content['simulated_s']:g} of {content['duration_s']:g} s, {content['windows']} windows, "
        f"overrides: {' '.join(content['overrides']) or 'none'}"
    )
    stdout.print(peaks_table(content))
    for line in trust_lines(content["trust"]):
        print_line(line)
    if events and content["events"]:
        stdout.print(events_table(content["events"], content["averaging_s"]))
        return
    more = "; `cosim info --events` lists them" if content["events"] else ""
    print_line(events_line(content["events"]) + more)


def print_compare(title: str, rows: list[Row], trust: dict[str, Any]) -> None:
    """`cosim compare`: simulated beside computed and measured, then where the numbers are from."""
    table = new_table(*COMPARED, title=title)
    for row in rows:
        table.add_row(*compare_cells(row))
    stdout.print(table)
    for line in trust_lines(trust):
        print_line(line)
    for row in rows:
        print_line(f"{row.feature.name}: {row.feature.source}")
