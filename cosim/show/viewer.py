"""The viewer without a screen that photographs a run; the only place that starts a process."""

from __future__ import annotations

import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from cosim.analysis.run_data import RunData
from cosim.errors import FailedError
from cosim.show.layout import TIMELINE

NO_DRIVER = (
    "the viewer ended by itself (exit code {code}): a picture without screen needs a Vulkan driver; "
    "install one, on Debian: apt-get install mesa-vulkan-drivers"
)


@contextmanager
def headless_viewer(size: tuple[int, int]) -> Iterator[tuple[str, Any]]:
    """A viewer without screen that listens on this machine only; ended on the way out.

    It answers before it draws its first picture, and ends there if it has no driver: then whatever asks it next fails.
    """
    import rerun_cli
    from rerun.experimental import ViewerClient

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    binary = Path(rerun_cli.__file__).with_name("rerun")
    process = subprocess.Popen(
        [
            binary,
            "--headless",
            "--bind",
            "127.0.0.1",
            "--port",
            str(port),
            "--window-size",
            f"{size[0]}x{size[1]}",
            "--hide-welcome-screen",
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    url = f"rerun+http://127.0.0.1:{port}/proxy"
    try:
        yield url, _connect(ViewerClient, url, process)
    except Exception as error:
        if (code := _exit_code(process)) is None or isinstance(error, FailedError):
            raise
        raise FailedError(NO_DRIVER.format(code=code)) from error
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
            raise FailedError(NO_DRIVER.format(code=process.returncode))
        try:
            client = client_class.connect(url)
            client.get_state()
            return client
        except Exception:
            time.sleep(0.1)
    raise FailedError(f"the viewer did not answer within {patience:g} s; try again, or save a .rrd with --save")


def wait_until_loaded(client: Any, run: RunData, patience: float = 120.0) -> None:
    """Return when the viewer has all of a run and shows it; FailedError after ``patience`` [s]."""
    until = time.monotonic() + patience
    while time.monotonic() < until:
        state = client.get_state()
        if not state.loading and state.views and _end_of(state) >= run.t_ns[-1]:
            return
        time.sleep(0.1)
    raise FailedError(f"the viewer did not load the run within {patience:g} s; save a .rrd with --save instead")


def _end_of(state: Any) -> int:
    """Latest simulated time that the viewer has [ns]."""
    ends = [t.end for recording in state.recordings for t in recording.timelines if t.name == TIMELINE]
    return max((end for end in ends if end is not None), default=-1)
