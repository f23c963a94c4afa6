"""The entry point: commands by name, and what goes wrong as one line and an exit code.

Only this file exits. Every expected error is one line on standard error: exit 2 for a bad input, 1 for a failed run or
check. With ``--json`` standard output holds one JSON object and nothing else. Slow imports stay inside the commands.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from typing import NoReturn

import typer

from cosim.cli import authoring, recordings, scenarios, simulate
from cosim.errors import explain
from cosim.show.console import plain

app = typer.Typer(
    name="cosim",
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Ice loads on sloping structures: a lattice that breaks, coupled with rubble that slides.",
)
#: in the order of the help
COMMANDS: dict[str, Callable[..., None]] = {
    "new": authoring.new,
    "scale": authoring.scale,
    "keys": authoring.keys,
    "check": authoring.check,
    "run": simulate.run,
    "sweep": simulate.sweep_variants,
    "replay": recordings.replay,
    "compare": recordings.compare,
    "baseline": scenarios.baseline,
    "info": recordings.info,
    "recover": recordings.recover,
    "list": scenarios.list_scenarios,
    "report": recordings.report,
    "verify": simulate.verify,
}
for _name, _command in COMMANDS.items():
    app.command(_name)(_command)


def main(arguments: list[str] | None = None) -> NoReturn:
    """Entry point: what goes wrong becomes one line and an exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    try:
        code = app(args=arguments or ["--help"], prog_name="cosim", standalone_mode=False)
    except KeyboardInterrupt:
        text, code = "stopped by the user; a recording holds what was simulated until now", 130
    except Exception as error:
        if os.environ.get("COSIM_TRACEBACK"):
            raise
        text, code = explain(error)
    else:
        raise SystemExit(code if isinstance(code, int) else 0)
    sys.stderr.write(f"cosim: {plain(' '.join(text.split()))}\n")
    raise SystemExit(code)
