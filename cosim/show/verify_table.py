"""The table of `cosim verify` in the terminal."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from cosim.show.console import stdout
from cosim.verify.case import CaseResult, Quantity

PIPE = 140  #: characters of a line where there is no terminal


def print_verification(results: list[CaseResult]) -> None:
    """`cosim verify`: quantities that have a reference; of a single case all of them."""
    table = Table("case", "quantity", "value", "reference", "tolerance", "", title="van Vliet (2018) and the lattice")
    for result in results:
        for quantity in result.quantities:
            if quantity.reference is not None or len(results) == 1:
                table.add_row(result.case, escape(f"{quantity.name} [{quantity.unit}]"), *_row(quantity))
    (stdout if stdout.is_terminal else Console(width=PIPE)).print(table)


def _row(q: Quantity) -> tuple[str, str, str, str]:
    tolerance = "" if q.tolerance is None else f"{q.measure} {q.tolerance:g}"
    mark = {None: "", True: "[green]ok[/]", False: "[red]FAILED[/]"}[q.passed]
    return _text(q.value), "" if q.reference is None else _text(q.reference), tolerance, mark


def _text(number: object) -> str:
    if not isinstance(number, list):
        return f"{number:.6g}"
    flat = _flat(number)
    return ", ".join(f"{x:.5g}" for x in flat) if len(flat) <= 5 else f"{flat[0]:.6g} ... {flat[-1]:.6g} ({len(flat)})"


def _flat(numbers: list[Any]) -> list[float]:
    return [x for item in numbers for x in (_flat(item) if isinstance(item, list) else [item])]
