"""Tables of the design formulas in the terminal."""

from __future__ import annotations

from typing import Any

from cosim.show.baseline_cells import BESIDE, beside_rows, method_cells, remarks
from cosim.show.console import new_table, print_line, stdout


def print_baseline(title: str, methods: dict[str, dict[str, Any]]) -> None:
    """`cosim baseline`: loads and terms, then what is assumed and what is not verified."""
    table = new_table("formula", "Fx [MN]", "Fz [MN]", "breaking", "terms", title=f"Design formulas: {title}")
    for found in methods.values():
        table.add_row(*method_cells(found), _terms(found))
    stdout.print(table)
    for found in methods.values():
        print_line(f"{found['title']}: {found['source']}; {found['caveat']}")
    assumed = {
        key: text for found in methods.values() if "refused" not in found for key, text in found["assumed"].items()
    }
    if assumed:
        print_line("assumed, because [baseline] of the scenario does not say:")
    for key, text in assumed.items():
        print_line(f"  {key} = {text}")


def _terms(found: dict[str, Any]) -> str:
    if "refused" in found:
        return str(found["refused"])
    return ", ".join(f"{name} {value * 1e-6:.4g}" for name, value in found["terms"].items())


def print_beside(design: dict[str, Any]) -> None:
    """The design formulas of `cosim compare`; ratio = simulated / design."""
    table = new_table(*BESIDE, title="Peak beside design formulas")
    for row in beside_rows(design):
        table.add_row(*row)
    stdout.print(table)
    for line in remarks(design):
        print_line(line)
