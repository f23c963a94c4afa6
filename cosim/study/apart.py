"""A task in a process of its own beside the worker of a cluster.

What kills it (no memory, a signal) leaves the worker alive, with the results of other tasks that are still there. A
worker may be a process that is not allowed processes of `multiprocessing`; so this one is an interpreter that takes
tasks at its standard input, one after the other, and ends with the worker, however that ends.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
from queue import SimpleQueue
from typing import Any

from cosim.study.pool import Work
from cosim.study.task import Row
from cosim.study.variants import Variant


class DiedError(Exception):
    """The process of a task has died of it."""


class Apart:
    """One process, started with the first task and again after a death; for one thread."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def __call__(self, work: Work, number: int, variant: Variant) -> Row:
        """The row of a task; DiedError where the process ends before it."""
        process = self._started()
        assert process.stdin is not None
        assert process.stdout is not None
        try:
            pickle.dump((work, number, variant), process.stdin)
            process.stdin.flush()
            ended, what = pickle.load(process.stdout)
        except (EOFError, OSError, pickle.UnpicklingError):
            raise DiedError(f"its process died, {self._end()}") from None
        if not ended:
            raise RuntimeError(what)
        row: Row = what
        return row

    def _started(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            path = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
            self._process = subprocess.Popen(
                [sys.executable, "-m", __name__], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=os.environ | path
            )
        return self._process

    def _end(self) -> str:
        """How the process has ended, and makes sure that it has."""
        assert self._process is not None
        self._process.kill()
        code = self._process.wait()
        self._process = None
        return f"exit {code}" if code >= 0 else f"signal {signal.Signals(-code).name}"


def main() -> None:
    """Tasks from standard input, rows to standard output, until the input ends; what they print goes to the errors."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    tasks: SimpleQueue[tuple[Work, int, Variant]] = SimpleQueue()

    def read() -> None:
        while True:
            try:
                tasks.put(pickle.load(sys.stdin.buffer))
            except EOFError:  # the worker has ended: so does this, also in the middle of a task
                os._exit(1)

    threading.Thread(target=read, daemon=True).start()
    while True:
        work, number, variant = tasks.get()
        pickle.dump(_answer(work, number, variant), answers)
        answers.flush()


def _answer(work: Work, number: int, variant: Variant) -> tuple[bool, Any]:
    """Whether the task came to its end, and its row or what went wrong."""
    try:
        return True, work(number, variant)
    except Exception as error:
        return False, f"{type(error).__name__}: {error}"


if __name__ == "__main__":
    main()
