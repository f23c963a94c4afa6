"""Command that runs the benchmarks: bench."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from cosim.cli.options import JsonOption, talking
from cosim.cli.output import print_json
from cosim.errors import FailedError
from cosim.outputs import whole, writable
from cosim.show.talk import Talk


@talking
def bench(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME]...", help="these benchmarks; default: all")
    ] = None,
    output: Annotated[Path, typer.Option("-o", "--output", metavar="MD", help="page of the results")] = Path(
        "bench.md"
    ),
    list_them: Annotated[bool, typer.Option("--list", help="show the benchmarks, run nothing")] = False,
    as_json: JsonOption = False,
    *,
    talk: Talk,
) -> None:
    """Measure how fast it is on this machine, in about ten minutes: ratios to peers and to limits."""
    from cosim.bench import chosen, machine, page, run

    plan = chosen(names or ())
    if list_them:
        rows = [{"name": b.name, "claim": b.claim, "script": b.script, "arguments": list(b.arguments)} for b in plan]
        if as_json:
            print_json({"benchmarks": rows})
            return
        for b in plan:
            talk.note(f"{b.name:<10} {b.claim}")
        return
    target, where, date, found = writable(output, ".bench.md"), machine(), datetime.now(UTC), []
    talk.note(where)
    for number, b in enumerate(plan, 1):
        talk.note(f"{number} of {len(plan)}, {b.name}: {b.claim}")
        found.append(run(b, talk.detail if as_json else lambda text: talk.note("  " + text)))
    with whole(target, ".bench.md") as part:
        part.write_text(page(found, f"{date:%Y-%m-%d}", where), encoding="utf-8")
    if as_json:
        results = [{"name": m.benchmark.name, "code": m.code, "wall_s": m.wall, "text": m.text} for m in found]
        print_json({"date": f"{date:%Y-%m-%d}", "machine": where, "benchmarks": results})
    talk.note(f"written: {output}")
    if failed := [m.benchmark.name for m in found if m.code]:
        raise FailedError(f"benchmarks failed: {', '.join(failed)}; {output} holds what they said")
