"""Tables of the campaign in the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cosim.evidence.campaign import Planned
from cosim.evidence.table import HEAD, cells
from cosim.scenario.cost import cost_of
from cosim.show.console import new_table, print_line, stdout


def list_of(cases: Sequence[Planned]) -> list[dict[str, Any]]:
    """What would run, and what it costs on one core [s]."""
    return [
        {
            "name": the.case.name,
            "scenario": the.case.scenario,
            "overrides": list(the.case.overrides),
            "claim": the.case.claim,
            "runs": len(the.plan.variants),
            "core_s": len(the.plan.variants) * cost_of(the.plan.base.model).seconds,
            "features": [f.name for f in the.features],
        }
        for the in cases
    ]


def show_list(rows: Sequence[dict[str, Any]]) -> None:
    """`cosim evidence --list`."""
    table = new_table("case", "scenario", "runs", "core minutes", "what", title="Cases of the campaign")
    for row in rows:
        table.add_row(row["name"], row["scenario"], str(row["runs"]), f"{row['core_s'] / 60:.1f}", row["claim"])
    stdout.print(table)
    print_line(f"about {sum(row['core_s'] for row in rows) / 3600:.1f} core hours, to within a factor of three")


def show(content: dict[str, Any]) -> None:
    """All cases that have a run; the others in a line."""
    table = new_table(*HEAD, title=f"Evidence of brash {content['evidence']}")
    for case in content["cases"]:
        if case["runs"]:
            for row in cells(case):
                table.add_row(*row)
    stdout.print(table)
    if missing := [case["name"] for case in content["cases"] if not case["runs"] and not case["errors"]]:
        print_line(f"not run: {', '.join(missing)}")
    for case in content["cases"]:
        for text in case["errors"]:
            print_line(f"failed: {case['name']}: {text}")
        for text in dict.fromkeys(case["not_trustworthy"]):
            print_line(f"not trustworthy: {case['name']}: because {text}")
