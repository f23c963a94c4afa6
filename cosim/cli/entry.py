"""The entry point: commands by name, and what goes wrong as one line and an exit code.

Only this file exits. Every expected error is one line on standard error: exit 2 for a bad input, 1 for a failed run or
check. With ``--json`` standard output holds one JSON object and nothing else. Slow imports stay inside the commands.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Callable
from typing import Annotated, NoReturn

import typer

from cosim.cli import authoring, benching, coupling, evidencing, recordings, scenarios, simulate, sweeping, warming
from cosim.errors import explain
from cosim.plain import one_line
from cosim.signals import StoppedError, handled

app = typer.Typer(
    name="cosim",
    pretty_exceptions_enable=False,
)
#: in the order of the help
COMMANDS: dict[str, Callable[..., None]] = {
    "new": authoring.new,
    "scale": authoring.scale,
    "keys": authoring.keys,
    "check": authoring.check,
    "fmu": coupling.fmu,
    "run": simulate.run,
    "resume": simulate.resume,
    "sweep": sweeping.sweep,
    "evidence": evidencing.evidence,
    "replay": recordings.replay,
    "compare": recordings.compare,
    "baseline": scenarios.baseline,
    "info": recordings.info,
    "recover": recordings.recover,
    "list": scenarios.list_scenarios,
    "report": recordings.report,
    "export": recordings.export,
    "verify": simulate.verify,
    "warm": warming.warm,
    "bench": benching.bench,
}
for _name, _command in COMMANDS.items():
    app.command(_name)(_command)


def _print_version(asked: bool) -> None:
    if asked:
        from cosim.provenance import commit, version

        sys.stdout.write(f"cosim {version()} ({commit()})\n")
        raise typer.Exit


@app.callback()
def options(
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="print version and commit")
    ] = False,
) -> None:
    """Ice loads on sloping structures: a lattice that breaks, coupled with rubble that slides."""


#: objects between two looks for garbage: libraries and kernels make half a million that stay, and looking through them
#: as often as Python does takes a tenth of the time until a run begins
GARBAGE = 50_000


def main(arguments: list[str] | None = None) -> NoReturn:
    """Entry point: what goes wrong becomes one line and an exit code."""
    gc.set_threshold(GARBAGE)
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        with handled():
            code = app(args=arguments or ["--help"], prog_name="cosim", standalone_mode=False)
            sys.stdout.flush()
    except StoppedError as error:
        text, code = (
            f"{error}; {error.kept} holds what was simulated until then" if error.kept else str(error),
            error.code,
        )
    except SystemExit as error:  # the argument parser's own end when its reader has gone
        if error.code != 1 or "_COSIM_COMPLETE" in os.environ:
            raise
        text, code = "standard output: closed by its reader", 1
    except Exception as error:
        if os.environ.get("COSIM_TRACEBACK"):
            raise
        text, code = explain(error)
    else:
        raise SystemExit(code if isinstance(code, int) else 0)
    _let_go_of_output()
    sys.stderr.write(f"cosim: {one_line(text)}\n")
    raise SystemExit(code)


def _let_go_of_output() -> None:
    """What is buffered for an output that takes no more is dropped, else Python complains about it at its end."""
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
