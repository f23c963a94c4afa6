"""A recording that is still being written, read as it grows."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import IO

from cosim.analysis.run_data import RunData
from cosim.outputs import is_growing
from cosim.recording.reader import read_run
from cosim.recording.records import RecordingError, Records

EVERY = 0.2  #: time between two looks at the file [s]
PATIENCE = 1.0  #: time in which a file that is there is locked by who writes it [s]


class Tail(Records):
    """Records front to back, each as soon as it is whole; ends with the run, be it finished or killed.

    ``waits`` is called where nothing new has come.
    """

    def __init__(self, path: Path, waits: Callable[[], None] = lambda: time.sleep(EVERY)) -> None:
        super().__init__(path)
        self._waits = waits

    def _next(self, file: IO[bytes], finished: bool) -> tuple[bytes, bytes] | None:  # noqa: ARG002  it may come to be
        at = file.tell()
        while True:
            grows = is_growing(self.path)
            self._size = self.path.stat().st_size
            head = file.read(9)
            length = int.from_bytes(head[1:], "little")
            if len(head) == 9 and length <= self._size - file.tell():
                return head, file.read(length)
            if not grows:
                self.cut = True
                return None
            file.seek(at)
            self._waits()

    def _end(self, file: IO[bytes], finished: bool) -> None:
        """What follows the data says nothing new."""


def begun(path: Path) -> RunData:
    """A recording that holds a window, or will soon; RecordingError if nobody is writing it for `PATIENCE`."""
    until = time.monotonic() + PATIENCE
    while True:
        if path.is_file() and is_growing(path):
            until = time.monotonic() + PATIENCE
        try:
            return read_run(path)
        except RecordingError:
            if time.monotonic() > until:
                raise
        time.sleep(EVERY)
