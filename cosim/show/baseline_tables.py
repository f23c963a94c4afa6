"""Tables of the design formulas in the terminal."""

from __future__ import annotations

from typing import Any

from cosim.show.baseline_cells import beside_table, method_cells, remarks, scale_of_methods
from cosim.show.console import new_table, print_line, stdout
from cosim.show.scale import Scale, significant


def print_baseline(title: str, methods: dict[str, dict[str, Any]]) -> None:
    """`cosim baseline`: loads and terms, then what is assumed and what is not verified."""
    scale = scale_of_methods(methods.values())
    heads = ("formula", f"Fx [{scale.unit}]", f"Fz [{scale.unit}]", "breaking", "terms")
    table = new_table(*heads, title=f"Design formulas: {title}")
    for found in methods.values():
        table.add_row(*method_cells(found, scale), _terms(found, scale))
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


def _terms(found: dict[str, Any], scale: Scale) -> str:
    if "refused" in found:
        return str(found["refused"])
    return ", ".join(f"{name} {significant(value / scale.size)}" for name, value in found["terms"].items())


def print_beside(design: dict[str, Any]) -> None:
    """The design formulas of `cosim compare`; ratio = simulated / design."""
    head, rows = beside_table(design)
    table = new_table(*head, title="Peak beside design formulas")
    for row in rows:
        table.add_row(*row)
    stdout.print(table)
    for line in remarks(design):
        print_line(line)
