"""How much a command says while it works, and where it is kept: on standard error, and in a log file.

Quiet: warnings only. Usual: a line for each kind of event, and a bar. Verbose: every event, and what was chosen.
"""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import IO, Self

from cosim.errors import explain
from cosim.show.console import plain, print_progress, warn

QUIET, USUAL, VERBOSE = -1, 0, 1


class Talk:
    """Says lines by their weight; all of them go into the log file, whatever is shown."""

    def __init__(self, level: int = USUAL, log: Path | None = None) -> None:
        self.level = level
        self._file: IO[str] | None = None if log is None else log.open("a", encoding="utf-8", buffering=1)

    def warn(self, text: str) -> None:
        """Something that a user should know, also a quiet one."""
        warn(text)
        self._keep(f"warning: {text}")

    def note(self, text: str) -> None:
        """How far it is."""
        self._say(text, USUAL)

    def detail(self, text: str) -> None:
        """For those who asked for more."""
        self._say(text, VERBOSE)

    def keep(self, text: str) -> None:
        """For the log file alone."""
        self._keep(text)

    def _say(self, text: str, weight: int) -> None:
        if self.level >= weight:
            print_progress(text)
        self._keep(text)

    def _keep(self, text: str) -> None:
        if self._file is not None:
            self._file.write(plain(text) + "\n")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, Exception):
            self._keep(f"error: {explain(error)[0]}")
        elif error is not None:
            self._keep(f"stopped: {kind.__name__ if kind else ''}")
        if self._file is not None:
            self._file.close()
            self._file = None
