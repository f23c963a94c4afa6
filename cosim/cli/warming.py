"""Command that compiles all kernels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from cosim.cli.options import JsonOption, talking
from cosim.cli.output import print_json
from cosim.errors import FailedError
from cosim.show.talk import Talk

if TYPE_CHECKING:
    from cosim.warming import Compiled


@talking
def warm(
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="processes side by side")] = 2,
    again: Annotated[
        bool, typer.Option("--again", help="run parts that are compiled too, to see that they are")
    ] = False,
    as_json: JsonOption = False,
    *,
    talk: Talk,
) -> None:
    """Compile all kernels now, so that no run waits for them."""
    import time
    from concurrent.futures.process import BrokenProcessPool

    from cosim.warming import PARTS, compile_parts, missing

    parts, found, began = list(PARTS) if again else missing(list(PARTS)), [], time.perf_counter()

    def done(part: Compiled) -> None:
        found.append(part)
        talk.note(f"{len(found)} of {len(parts)}, {part.part}: {part.kernels} kernels compiled, {part.seconds:.0f} s")

    if parts:
        talk.note(f"compiles kernels of {', '.join(parts)}")
    try:
        compile_parts(parts, jobs, done)
    except BrokenProcessPool:
        raise FailedError("a process that compiles has died (no memory, or a signal); try --jobs 1") from None
    kernels, seconds = sum(part.kernels for part in found), time.perf_counter() - began
    if as_json:
        print_json({"kernels": kernels, "wall_s": seconds, "parts": {part.part: part.seconds for part in found}})
    else:
        talk.note(f"{kernels} kernels compiled in {seconds:.0f} s" if parts else "all kernels are compiled")
