"""The terminal: standard output and error, plain tables, lines and warnings.

Texts of files and of people are shown, never obeyed: markup is text, and escape sequences become visible characters.
"""

from __future__ import annotations

import sys

from rich import box
from rich.table import Table
from rich.text import Text

from cosim.plain import plain
from cosim.show.terminal import Terminal

WIDTH = None if sys.stdout.isatty() else 120  #: a pipe has no width of its own
stderr = Terminal(stderr=True)
stdout = Terminal(width=WIDTH)


def as_line(text: str) -> str:
    """A text of one line: what a terminal would obey is written out, line breaks as well."""
    return plain(text, kept="")


def print_line(text: str) -> None:
    """A line on standard output, as it is."""
    stdout.print(Text(as_line(text)), soft_wrap=True)


def print_progress(text: str) -> None:
    """A line on standard error: how far it is."""
    stderr.print(Text(as_line(text)), soft_wrap=True)


def warn(text: str) -> None:
    """A warning on standard error."""
    stderr.print(Text(f"warning: {as_line(text)}", style="yellow"), soft_wrap=True)


class PlainTable(Table):
    """A table whose cells are shown as they are."""

    def add_row(self, *cells: str) -> None:  # type: ignore[override]
        """A row of texts."""
        super().add_row(*(Text(as_line(cell)) for cell in cells))


def new_table(*columns: str, title: str) -> PlainTable:
    """A plain table: the first column and texts to the left, numbers to the right."""
    table = PlainTable(title=Text(as_line(title), style="italic"), box=box.SIMPLE, title_justify="left")
    for k, name in enumerate(columns):
        table.add_column(Text(name), justify="left" if k == 0 or name in ("event", "unit", "what") else "right")
    return table
