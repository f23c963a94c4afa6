"""Ctrl-C and SIGTERM: a command ends in order, with a line and an exit code; a run ends after its window."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cosim.observer import RunInfo
    from coupling.interface import Frame

NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM"}


class StoppedError(BaseException):
    """A signal has ended the command. No `Exception`: nothing on the way takes it for an error and goes on."""

    def __init__(self, number: int, when: str = "") -> None:
        self.code = 128 + number
        self.kept: str | None = None  #: file that holds what was done until now
        super().__init__(f"stopped by {NAMES[signal.Signals(number)]}{when}")


class _State:
    """What a signal does now: end the command at once, or after the window that is under way."""

    waits = False
    asked: int | None = None


def _handle(number: int, _frame: FrameType | None) -> None:
    if _State.waits and _State.asked is None:
        _State.asked = number
    else:
        raise StoppedError(number)


@contextmanager
def handled() -> Iterator[None]:
    """Signals raise `StoppedError` inside; as before afterwards."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.signal(number, _handle) for number in NAMES}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


class StopAfterWindow:
    """Observer, the last of a run: the first signal waits until all others have seen the window, a second does not."""

    def on_start(self, run_info: RunInfo) -> None:
        """From here on a signal waits."""
        self._duration = run_info.duration_ns / 1e9
        _State.waits, _State.asked = True, None

    def on_frame(self, frame: Frame) -> None:
        """End the run if that was asked for."""
        if _State.asked is not None:
            raise StoppedError(_State.asked, f" after {frame.t_ns / 1e9:g} of {self._duration:g} s")

    def on_close(self) -> None:
        """Signals act at once again."""
        _State.waits, _State.asked = False, None
