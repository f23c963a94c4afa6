"""The viewer as a process of its own: on the screen or for a browser. It serves this machine only."""

from __future__ import annotations

import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from urllib.parse import quote

from cosim.errors import FailedError

NO_SCREEN = "the viewer ended by itself (exit code {code}); without a screen use --web, --save or --screenshot"
HERE = "127.0.0.1"


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
