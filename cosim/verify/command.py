"""The command `cosim verify`: one table for people, one JSON text for programs."""

from __future__ import annotations

import json as json_module
import sys
import time
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from cosim.verify.case import CaseResult, Quantity
from cosim.verify.cases import CASES, run


def verify_command(
    case: Annotated[str | None, typer.Argument(help=f"One of {', '.join(CASES)}; all without it.")] = None,
    set: Annotated[list[str] | None, typer.Option("--set", help="Parameter of the case, name=value.")] = None,
    plots: Annotated[Path | None, typer.Option(help="Folder for the figures of the thesis, as PNG.")] = None,
    quick: Annotated[bool, typer.Option(help="Coarser and shorter where a case is slow.")] = False,
    json: Annotated[bool, typer.Option(help="One JSON text on standard output.")] = False,
) -> None:
    """Compare the lattice with the tables and figures of van Vliet (2018)."""
    try:
        results = _run_all(case, set, plots, quick)
    except ValueError as error:
        print(error, file=sys.stderr)
        raise typer.Exit(2) from None
    if json:
        objects = [result.as_dict() for result in results]
        print(json_module.dumps(objects if case is None else objects[0], allow_nan=False))
    else:
        _show(results)
    if not all(result.passed for result in results):
        raise typer.Exit(1)


def _run_all(case: str | None, settings: list[str] | None, plots: Path | None, quick: bool) -> list[CaseResult]:
    if case is not None or settings:
        return run(case, settings, plots, quick)
    results = []
    for name in CASES:
        start = time.perf_counter()
        results += run(name, None, plots, quick)
        mark = "ok" if results[-1].passed else "FAILED"
        print(f"{name}: {mark}, {time.perf_counter() - start:.1f} s", file=sys.stderr)
    return results


def _show(results: list[CaseResult]) -> None:
    table = Table("case", "quantity", "value", "reference", "tolerance", "", title="van Vliet (2018) and the lattice")
    for result in results:
        for quantity in result.quantities:
            if quantity.reference is not None or len(results) == 1:
                table.add_row(result.case, escape(f"{quantity.name} [{quantity.unit}]"), *_row(quantity))
    console = Console()
    (console if console.is_terminal else Console(width=140)).print(table)


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
