"""The viewer as a process of its own: on the screen, without one, or for a browser. It serves this machine only."""

from __future__ import annotations

import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any
from urllib.parse import quote

from cosim.analysis.run_data import RunData
from cosim.errors import FailedError
from cosim.show.layout import TIMELINE

NO_DRIVER = (
    "the viewer ended by itself (exit code {code}): a picture without screen needs a Vulkan driver; "
    "install one, on Debian: apt-get install mesa-vulkan-drivers"
)


NO_SCREEN = "the viewer ended by itself (exit code {code}); without a screen use --web, --save or --screenshot"
HERE = "127.0.0.1"


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
        if (code := _exit_code(process)) is None or isinstance(error, FailedError):
            raise
        raise FailedError(NO_DRIVER.format(code=code)) from error
    finally:
        process.terminate()
        process.wait(timeout=10)


@contextmanager
def web_viewer(port: int | None = None) -> Iterator[tuple[str, str, subprocess.Popen[bytes]]]:
    """A viewer for a browser on this machine: where data go, what the browser opens, the process; ended on the way out.

    ``port`` is that of the page; default any.
    """
    data, page = free_port(), port or free_port()
    process = start(data, "--serve-web", "--web-viewer-port", str(page))
    try:
        _wait_for((data, page), process)
        yield address(data), f"http://{HERE}:{page}/?url={quote(address(data), safe='')}", process
    finally:
        process.terminate()
        process.wait(timeout=10)


@contextmanager
def screen_viewer() -> Iterator[str]:
    """A viewer on this machine's screen, which stays when the command ends: where data go."""
    port = free_port()
    process = start(port, "--hide-welcome-screen", detached=True)
    _wait_for((port,), process)
    yield address(port)


def start(port: int, *options: str, detached: bool = False) -> subprocess.Popen[bytes]:
    """The viewer's own program; whatever it serves is for this machine only, its default is all networks."""
    import rerun_cli

    binary = Path(rerun_cli.__file__).with_name("rerun")
    return subprocess.Popen(
        [binary, "--bind", HERE, "--port", str(port), *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=detached,
    )


def address(port: int) -> str:
    """Where a viewer takes data."""
    return f"rerun+http://{HERE}:{port}/proxy"


def free_port() -> int:
    """A port that nobody uses now."""
    with socket.socket() as free:
        free.bind((HERE, 0))
        port: int = free.getsockname()[1]
    return port


def _wait_for(ports: tuple[int, ...], process: subprocess.Popen[bytes], patience: float = 30.0) -> None:
    """Return when a viewer listens at all of these ports; FailedError after ``patience`` [s]."""
    until = time.monotonic() + patience
    while time.monotonic() < until:
        if process.poll() is not None:
            raise FailedError(NO_SCREEN.format(code=process.returncode))
        with suppress(OSError):
            for port in ports:
                socket.create_connection((HERE, port), timeout=1.0).close()
            return
        time.sleep(0.1)
    process.terminate()
    raise FailedError(f"the viewer did not answer within {patience:g} s; try again, or save a .rrd with --save")


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
