"""How much a command says while it works, and where it is kept: on standard error, and in a log file.

Quiet: warnings only. Usual: a line for each kind of event, and a bar. Verbose: every event, and what was chosen.
"""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import IO, Self

from cosim.errors import explain
from cosim.outputs import append, trouble
from cosim.show.console import as_line, print_progress, warn

QUIET, USUAL, VERBOSE = -1, 0, 1


class Talk:
    """Says lines by their weight; all of them go into the log file, whatever is shown."""

    def __init__(self, level: int = USUAL, log: Path | None = None) -> None:
        self.level = level
        self._log = log
        self._file: IO[bytes] | None = None if log is None else append(log, ".log")

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
        if self._file is None or self._log is None:
            return
        try:
            self._file.write(f"{as_line(text)}\n".encode())
        except OSError as error:
            self._close()
            raise trouble(self._log, error) from error

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, Exception):
            self._keep(f"error: {explain(error)[0]}")
        elif error is not None:
            self._keep(str(error))
        self._close()
