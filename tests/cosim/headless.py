"""A viewer of rerun without a screen, for tests: it says whether the views that we lay out can be drawn."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

from cosim.analysis.run_data import RunData
from cosim.show.layout import TIMELINE
from cosim.show.viewer import address, free_port, start


class NoDriverError(RuntimeError):
    """There is no Vulkan driver on this machine."""


@contextmanager
def headless_viewer(size: tuple[int, int]) -> Iterator[tuple[str, Any]]:
    """A viewer without screen; ended on the way out.

    It answers before it draws its first picture, and ends there if it has no driver: then whatever asks it next fails.
    """
    from rerun.experimental import ViewerClient

    port = free_port()
    process = start(port, "--headless", "--window-size", f"{size[0]}x{size[1]}", "--hide-welcome-screen")
    url = address(port)
    try:
        yield url, _connect(ViewerClient, url, process)
    except Exception as error:
        if (code := _exit_code(process)) is None or isinstance(error, NoDriverError):
            raise
        raise NoDriverError(str(code)) from error
    finally:
        process.terminate()
        process.wait(timeout=10)


def _exit_code(process: subprocess.Popen[bytes], patience: float = 2.0) -> int | None:
    """Of a viewer that has ended, or does so within ``patience`` [s]."""
    with suppress(subprocess.TimeoutExpired):
        return process.wait(timeout=patience)
    return None


def _connect(client_class: Any, url: str, process: subprocess.Popen[bytes], patience: float = 30.0) -> Any:
    until = time.monotonic() + patience
    while time.monotonic() < until:
        if process.poll() is not None:
            raise NoDriverError(str(process.returncode))
        try:
            client = client_class.connect(url)
            client.get_state()
            return client
        except Exception:
            time.sleep(0.1)
    raise TimeoutError(f"no answer within {patience:g} s")


def wait_until_loaded(client: Any, run: RunData, patience: float = 120.0) -> None:
    """Return when the viewer has all of a run and shows it; TimeoutError after ``patience`` [s]."""
    until = time.monotonic() + patience
    while time.monotonic() < until:
        state = client.get_state()
        if not state.loading and state.views and _end_of(state) >= run.t_ns[-1]:
            return
        time.sleep(0.1)
    raise TimeoutError(f"not loaded within {patience:g} s")


def _end_of(state: Any) -> int:
    """Latest simulated time that the viewer has [ns]."""
    ends = [t.end for recording in state.recordings for t in recording.timelines if t.name == TIMELINE]
    return max((end for end in ends if end is not None), default=-1)
