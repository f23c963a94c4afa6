"""Progress of a run on standard error."""

from __future__ import annotations

import time
from collections import Counter

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from cosim.observer import RunInfo
from cosim.show.console import stderr
from coupling.interface import NS, Frame


class ProgressBar:
    """Observer that shows simulated time, rate and the time that remains."""

    def __init__(self, console: Console | None = None) -> None:
        self._progress = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            TextColumn("{task.fields[now]}", markup=False),
            TextColumn("{task.fields[rate]}"),
            TextColumn("remaining"),
            TimeRemainingColumn(),
            console=console or stderr,
            transient=True,
        )
        self._task: TaskID | None = None

    def on_start(self, run_info: RunInfo) -> None:
        """Show the bar."""
        self._duration = run_info.duration_ns / NS
        self._begin = time.monotonic()
        self._task = self._progress.add_task(run_info.scenario.title, total=self._duration, now="", rate="")
        self._progress.start()

    def on_frame(self, frame: Frame) -> None:
        """Move the bar to the end of the window; a line for each kind of event."""
        if self._task is None:
            return
        t = frame.t_ns / NS
        wall = max(time.monotonic() - self._begin, 1e-9)
        self._progress.update(
            self._task, completed=t, now=f"{t:6.1f} of {self._duration:g} s", rate=f"{t / wall:.2f} x real time"
        )
        for line in event_lines(frame):
            self._progress.console.print(line, highlight=False, markup=False, soft_wrap=True)

    def on_close(self) -> None:
        """Take the bar away."""
        self._progress.stop()


def event_lines(frame: Frame) -> list[str]:
    """One line for each kind of event of a window: the first of its kind, and how many more there are."""
    count = Counter(event.kind for event in frame.events)
    first = {event.kind: event for event in reversed(frame.events)}
    more = {kind: f" (and {n - 1} more)" if n > 1 else "" for kind, n in count.items()}
    return [
        f"{event.t_ns / NS:8.2f} s  {kind}: {event.text}{more[kind]}"
        for kind, event in sorted(first.items(), key=lambda item: item[1].t_ns)
    ]
