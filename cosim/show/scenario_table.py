"""The table of scenarios in the terminal; apart, because it needs nothing that takes long to load."""

from __future__ import annotations

from typing import Any

from cosim.show.console import new_table, print_line, stdout


def print_scenarios(rows: list[dict[str, Any]]) -> None:
    """`cosim list`: the table, then what is wrong with files that cannot be read."""
    table = new_table("scenario", "what", "for", title="Scenarios")
    for row in rows:
        table.add_row(row["name"], row["title"] or "cannot be read, see below", row["duration"] or "-")
    stdout.print(table)
    for row in rows:
        if row["fault"]:
            print_line(row["fault"])
