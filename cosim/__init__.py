"""Ice loads on sloping structures, from Python: simulate, open a recording, take its numbers along.

    import cosim

    run = cosim.run("first_cone", set={"ice.thickness": "40 cm"})
    run.loads["fx"].max()

`run`, `resume` and `open` give a `Run`, `sweep` a table of variants, `scenarios` the names that there are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cosim.api.calls import open, resume, run, scenarios, sweep
    from cosim.api.run import Run
    from cosim.errors import FailedError, InputError

__all__ = ["FailedError", "InputError", "Run", "open", "resume", "run", "scenarios", "sweep"]

_HOME = {"Run": "cosim.api.run", "FailedError": "cosim.errors", "InputError": "cosim.errors"}


def __getattr__(name: str) -> Any:
    """What is offered is imported when it is first asked for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    found = getattr(import_module(_HOME.get(name, "cosim.api.calls")), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
