"""A viewer beside a run: another process that follows the recording, so that the run knows nothing of it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from cosim.observer import RunInfo
from coupling.interface import Frame


class Companion:
    """Observer behind the recorder: when the file is there it starts `cosim replay RUN --follow`, which ends itself."""

    def __init__(self, recording: Path, options: Sequence[str] = ()) -> None:
        """``options`` of that command."""
        self._command = [sys.executable, "-m", "cosim", "replay", str(recording), "--follow", *options]
        self.process: subprocess.Popen[bytes] | None = None

    def on_start(self, run_info: RunInfo) -> None:  # noqa: ARG002  as every observer
        """The recording is open. Ctrl-C is for the run alone."""
        self.process = subprocess.Popen(self._command, start_new_session=True)

    def on_frame(self, frame: Frame) -> None:
        """It reads the file."""

    def on_close(self) -> None:
        """It shows what is left, and ends when the file does."""
