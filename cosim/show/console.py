"""The terminal: standard output and error, plain tables, lines and warnings."""

from __future__ import annotations

import sys

from rich import box
from rich.table import Table
from rich.text import Text

from cosim.show.terminal import Terminal

WIDTH = None if sys.stdout.isatty() else 120  #: a pipe has no width of its own
stderr = Terminal(stderr=True)
stdout = Terminal(width=WIDTH)


def print_line(text: str) -> None:
    """A line on standard output, as it is."""
    stdout.print(text, highlight=False, markup=False, soft_wrap=True)


def print_progress(text: str) -> None:
    """A line on standard error: how far it is."""
    stderr.print(text, highlight=False, markup=False, soft_wrap=True)


def warn(text: str) -> None:
    """A warning on standard error."""
    stderr.print(f"warning: {text}", style="yellow", highlight=False, markup=False, soft_wrap=True)


def new_table(*columns: str, title: str) -> Table:
    """A plain table: the first column and texts to the left, numbers to the right."""
    table = Table(title=title, box=box.SIMPLE, title_justify="left")
    for k, name in enumerate(columns):
        table.add_column(Text(name), justify="left" if k == 0 or name in ("event", "unit") else "right")
    return table
