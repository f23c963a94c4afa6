"""The terminal: standard output and error, plain tables, lines and warnings.

Texts of files and of people are shown, never obeyed: markup is text, and escape sequences become visible characters.
"""

from __future__ import annotations

import sys

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

WIDTH = None if sys.stdout.isatty() else 120  #: a pipe has no width of its own
stderr = Console(stderr=True)
stdout = Console(width=WIDTH)


def plain(text: str) -> str:
    """A text of one line whose every character can be seen: what a terminal would obey is written out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def print_line(text: str) -> None:
    """A line on standard output, as it is."""
    stdout.print(Text(plain(text)), soft_wrap=True)


def print_progress(text: str) -> None:
    """A line on standard error: how far it is."""
    stderr.print(Text(plain(text)), soft_wrap=True)


def warn(text: str) -> None:
    """A warning on standard error."""
    stderr.print(Text(f"warning: {plain(text)}", style="yellow"), soft_wrap=True)


class PlainTable(Table):
    """A table whose cells are shown as they are."""

    def add_row(self, *cells: str) -> None:  # type: ignore[override]
        """A row of texts."""
        super().add_row(*(Text(plain(cell)) for cell in cells))


def new_table(*columns: str, title: str) -> PlainTable:
    """A plain table: the first column and texts to the left, numbers to the right."""
    table = PlainTable(title=Text(plain(title), style="italic"), box=box.SIMPLE, title_justify="left")
    for k, name in enumerate(columns):
        table.add_column(Text(name), justify="left" if k == 0 or name in ("event", "unit", "what") else "right")
    return table
