"""Tasks on a dask cluster that is already there: by the address of its scheduler, or by its scheduler file.

Only as many tasks are handed out as keep the workers busy, so that the scheduler holds few of them, however many the
study has. Each runs in a process beside its worker (`cosim.study.apart`): what kills it is tried again a few times and
then the error in its row, and costs nothing else. A task whose worker dies goes to another one. Everything that a task
needs goes with it (some kilobytes), so workers need this program and no files.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from itertools import islice
from pathlib import Path
from typing import Any
from uuid import uuid4

from cosim.errors import FailedError, InputError
from cosim.provenance import commit, version
from cosim.study.apart import Apart
from cosim.study.pool import Task, Work
from cosim.study.task import Row
from cosim.study.variants import Variant

AHEAD = 3  #: tasks in hand per thread of the workers: one runs, the others wait beside it
LOOK = 2.0  #: time between two counts of the workers [s]
PATIENCE = 30.0  #: time within which a scheduler answers [s]
_OF_THREAD = threading.local()


class Room:
    """How many tasks may be in hand; workers come and go."""

    def __init__(self, client: Any):
        self._client, self._count, self._due = client, 0, 0.0

    def now(self) -> int:
        """Asks the scheduler at most every `LOOK` seconds; one task at least, for a cluster that grows on demand."""
        if time.monotonic() >= self._due:
            self._count = max(1, AHEAD * sum(self._client.nthreads().values()))
            self._due = time.monotonic() + LOOK
        return self._count


class Cluster:
    """The workers of a scheduler; start them with one thread each."""

    def __init__(self, address: str, retries: int = 3):
        """``address`` as ``tcp://host:8786`` or the path of a scheduler file; a task gets ``retries`` more workers."""
        if "://" not in address and not Path(address).is_file():
            raise InputError(
                f"--scheduler {address}: neither an address nor a file; give tcp://host:8786 or what "
                "`dask scheduler --scheduler-file` has written"
            )
        self.address, self.retries = address, retries

    def run(self, tasks: Sequence[Task], work: Work) -> Generator[tuple[int, Row], None, None]:
        """Number and row of each task as it ends."""
        waiting, study = iter(tasks), uuid4().hex[:8]
        with self._client() as (distributed, client):
            given: dict[str, int] = {}

            def hand_out(task: Task) -> Any:
                key = f"brash-{study}-{task[0]}"
                given[key] = task[0]
                return client.submit(_here, work, *task, key=key, retries=self.retries, pure=False)

            room = Room(client)
            futures = distributed.as_completed([hand_out(t) for t in islice(waiting, room.now())], loop=client.loop)
            for future in futures:
                yield given.pop(future.key), _row(future, self.address)
                futures.update([hand_out(t) for t in islice(waiting, max(room.now() - len(given), 0))])

    @contextmanager
    def _client(self) -> Iterator[tuple[Any, Any]]:
        """The library, which is an extra, and what speaks to the scheduler."""
        try:
            distributed: Any = import_module("distributed")
        except ImportError:
            raise InputError("--scheduler needs dask; install the extra: pip install 'brash-ice[cluster]'") from None
        place = {"address": self.address} if "://" in self.address else {"scheduler_file": self.address}
        try:
            client = distributed.Client(**place, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise FailedError(
                f"--scheduler {self.address}: no scheduler answers within {PATIENCE:g} s ({error}); is it running?"
            ) from None
        with client:
            yield distributed, client


def _here(work: Work, number: int, variant: Variant) -> Row:
    """A task in a thread of a worker: its row, with the program that made it."""
    if not hasattr(_OF_THREAD, "apart"):
        _OF_THREAD.apart = Apart()
    return {**_OF_THREAD.apart(work, number, variant), "program": program()}


def program() -> str:
    """Version and commit of this program."""
    return f"{version()} {commit()}"


def _row(future: Any, address: str) -> Row:
    """The row of a task that has ended; FailedError where the scheduler has gone or a worker runs another program."""
    if future.cancelled():
        raise FailedError(f"--scheduler {address}: the scheduler has gone; start it again and go on with --resume")
    try:
        row: Row = future.result()
    except Exception as error:
        return {"error": f"no worker brought it to its end: {' '.join(str(error).split())[:300]}"}
    theirs = row.pop("program")
    if theirs != program():
        raise FailedError(f"a worker runs brash {theirs}, this is {program()}; install the same on all machines")
    return row
