"""Progress of a run on standard error, in 80 columns."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

from cosim.observer import RunInfo
from cosim.show.console import as_line, stderr
from cosim.show.talk import QUIET, VERBOSE, Talk
from coupling.interface import NS, Frame

TITLE, BAR = 22, 12  #: columns
LOGGED = 10  #: lines about the progress of a run in a log file


class ProgressBar:
    """Observer that shows simulated time, rate and the time that remains."""

    def __init__(self, talk: Talk, console: Console | None = None) -> None:
        self._talk = talk
        self._progress = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(BAR),
            TextColumn("{task.fields[now]}", markup=False),
            TextColumn("{task.fields[rate]}", markup=False),
            TimeRemainingColumn(compact=True),
            TextColumn("left"),
            console=console or stderr,
            transient=True,
            disable=talk.level == QUIET,
        )
        self._task: TaskID | None = None
        self._logged, self._seen, self._from = 0, False, 0.0

    def on_start(self, run_info: RunInfo) -> None:
        """Show the bar."""
        self._window = run_info.window_ns / NS
        self._duration = run_info.duration_ns / NS
        self._begin = time.monotonic()
        title = as_line(run_info.scenario.title)
        short = title if len(title) <= TITLE else f"{title[: TITLE - 1]}…"
        self._task = self._progress.add_task(short, total=self._duration, now="", rate="")
        self._progress.start()

    def on_frame(self, frame: Frame) -> None:
        """Move the bar to the end of the window; a line for each kind of event, or for each event."""
        if self._task is None:
            return
        t = frame.t_ns / NS
        if not self._seen:  # a run that goes on begins late
            self._seen, self._from = True, max(t - self._window, 0.0)
        rate = (t - self._from) / max(time.monotonic() - self._begin, 1e-9)
        self._progress.update(self._task, completed=t, now=f"{t:.5g}/{self._duration:g} s", rate=f"{rate:.2g}x")
        for line in all_event_lines(frame) if self._talk.level >= VERBOSE else event_lines(frame):
            self._talk.note(line)
        if t * LOGGED >= (self._logged + 1) * self._duration:
            self._logged = int(t * LOGGED / self._duration)
            self._talk.keep(f"{t:8.2f} s of {self._duration:g} s, {rate:.2g} x real time")

    def on_close(self) -> None:
        """Take the bar away."""
        self._progress.stop()


def event_lines(frame: Frame) -> list[str]:
    """One line for each kind of event of a window: the first of its kind, and how many more there are.

    That a piece becomes rubble is told where nothing else tells that it has come off.
    """
    count = Counter(event.kind for event in frame.events)
    if count["hand_over"] <= count["circumferential"]:
        del count["hand_over"]
    first = {event.kind: event for event in reversed(frame.events) if event.kind in count}
    more = {kind: f" (and {n - 1} more)" if n > 1 else "" for kind, n in count.items()}
    return [
        f"{event.t_ns / NS:8.2f} s  {kind}: {event.text}{more[kind]}"
        for kind, event in sorted(first.items(), key=lambda item: item[1].t_ns)
    ]


def all_event_lines(frame: Frame) -> list[str]:
    """One line for each event of a window, with its place."""
    return [
        f"{e.t_ns / NS:10.4f} s  {e.kind}: {e.text} at x = {e.position[0]:.3g} m, y = {e.position[1]:.3g} m"
        for e in frame.events
    ]


@contextmanager
def counted(what: str) -> Iterator[Callable[[int, int], None]]:
    """A bar that is told how many of how many are done."""
    columns = (TextColumn(what), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(compact=True))
    with Progress(*columns, console=stderr, transient=True) as progress:
        task = progress.add_task(what)

        def told(done: int, of: int) -> None:
            progress.update(task, completed=done, total=of)

        yield told
