"""Checkpoints of a run: taken when they are due, and where a run goes on that was interrupted.

After a checkpoint the run itself goes on from what was kept, whether it is written to a file or not: pymunk's order of
contacts is another one in spaces that were filled anew. So the bits of a run depend on `recording.checkpoint_every`,
which is part of its scenario, and on nothing else: not on whether and where it was interrupted.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from cosim.checkpoint.file import ENDING, CheckpointError, Kept, Packed, place_of, write
from cosim.checkpoint.graph import UnknownKindError, graph_of
from cosim.checkpoint.restore import Restore, StrangeError
from cosim.observer import RunInfo
from cosim.outputs import drop, resolved, writable
from cosim.recording.metadata import run_metadata
from cosim.recording.writer import Recorder, attachments
from cosim.scenario.scenario import Scenario
from coupling.interface import SimulationError
from coupling.scheduler import Scheduler

STATE, SEEN = "state", "seen"  #: parts of a checkpoint: participants and scheduler; what a run has to tell


@dataclass
class Checkpoints:
    """Of one run. ``kept`` is the checkpoint from which it goes on; None: it begins."""

    scenario: Scenario
    recorder: Recorder | None = None  #: whose file they lie beside; None: nothing is written
    kept: Kept | None = None

    def begin(self, info: RunInfo, scheduler: Scheduler) -> Mapping[str, Any]:
        """Before the first window: participants go on where they were; returns what the run had to tell until then."""
        every: float | None = self.scenario.recording.checkpoint_every
        self._every_ns = 0 if every is None else round(every * 1e9)
        self._header = header_of(self.scenario, info)
        self._path = None if self.recorder is None else _path(self.recorder.path)
        seen: Mapping[str, Any] = {}
        if self.kept is not None:
            _back(self.kept.parts[STATE], scheduler)
            seen = dict(Restore(*self.kept.parts[SEEN].read()).root({}))
        self._due_ns = self._next(scheduler.t_ns)
        return seen

    def started(self) -> None:
        """The recording is open: what lies beside it from an earlier one is none of it."""
        if self.kept is None:
            self.clear()

    def after_window(self, scheduler: Scheduler, seen: Callable[[], Mapping[str, Any]]) -> None:
        """Takes a checkpoint if one is due; ``seen`` gives what the run has to tell."""
        if not self._every_ns or scheduler.t_ns < self._due_ns or scheduler.t_ns >= self.scenario.duration_ns:
            return
        self._due_ns = self._next(scheduler.t_ns)
        try:
            state = Packed.of(graph_of(scheduler))
            if self._path is not None and self.recorder is not None:
                told = Packed.of(graph_of(dict(seen())))
                header = {**self._header, "since": asdict(self.recorder.settle())}
                write(self._path, Kept(header, {STATE: state, SEEN: told}))
        except UnknownKindError as error:
            raise SimulationError(
                f"a checkpoint cannot keep {error}; leave recording.checkpoint_every out, or give its class plain "
                "attributes"
            ) from error
        _back(state, scheduler)

    def clear(self) -> None:
        """Nothing is left to go on with: the run has reached its end, or it begins."""
        if self._path is not None and self._path.exists():
            drop(writable(self._path, ENDING))

    def _next(self, t_ns: int) -> int:
        return (t_ns // self._every_ns + 1) * self._every_ns if self._every_ns else 0


def _path(recording: Path) -> Path | None:
    """Beside the recording; None where that is a device or a pipe."""
    target = resolved(recording)
    return None if target.exists() and not target.is_file() else writable(place_of(recording), ENDING)


def _back(state: Packed, scheduler: Scheduler) -> None:
    """Participants and scheduler take on what was kept."""
    try:
        if Restore(*state.read()).root(scheduler) is not scheduler:
            raise StrangeError("another scheduler")
    except StrangeError as error:
        raise CheckpointError(
            f"the checkpoint does not fit what its scenario builds ({error}); run the scenario again"
        ) from None


def header_of(scenario: Scenario, info: RunInfo) -> dict[str, Any]:
    """What identifies the run, and the scenario as it was read."""
    return {
        "run": run_metadata(info, attachments(scenario)),
        "machine": f"{platform.system()} {platform.machine()}",
        "scenario": {
            "name": scenario.name,
            "text": scenario.text,
            "raw": scenario.raw,
            "overrides": list(scenario.overrides),
            "folder": None if scenario.folder is None else str(scenario.folder.resolve()),
        },
    }
