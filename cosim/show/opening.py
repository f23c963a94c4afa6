"""A recording opened for people: what it lacks is said before anything of it is shown."""

from __future__ import annotations

from pathlib import Path

from cosim.analysis.run_data import RunData
from cosim.recording.reader import read_run
from cosim.show.console import warn


def opened(recording: Path) -> RunData:
    """The recording; a warning on standard error if it is not whole."""
    run = read_run(recording)
    if run.remark:
        warn(run.remark)
    return run
