"""Tasks in processes of this machine.

A process that dies (no memory, a signal) breaks its pool: the pool is made anew, and what was under way runs again, one
at a time and more than once, to find out which it was. All processes end with this one, however it ends.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection

from cosim.study.task import Row
from cosim.study.variants import Variant

Task = tuple[int, Variant]  #: number of a variant, and the variant
TRIES = 2  #: times that a task runs alone before its process is taken to die of it
Work = Callable[[int, Variant], Row]  #: may be sent to another process


class Processes:
    """Up to ``count`` tasks at the same time."""

    def __init__(self, count: int):
        self.count = count

    def run(self, tasks: Sequence[Task], work: Work) -> Generator[tuple[int, Row], None, None]:
        """Number and row of each task as it ends."""
        waiting = deque(tasks)
        while waiting:
            under_way: dict[Future[Row], Task] = {}
            with suppress(BrokenProcessPool), pool_of(min(self.count, len(waiting))) as pool:
                while waiting or under_way:
                    while waiting and len(under_way) < self.count:
                        future = pool.submit(work, *waiting[0])
                        under_way[future] = waiting.popleft()
                    for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                        row = future.result()
                        yield under_way.pop(future)[0], row
            for task in under_way.values():  # one of them has broken the pool
                yield task[0], _alone(task, work)


def _alone(task: Task, work: Work) -> Row:
    for _ in range(TRIES):
        with suppress(BrokenProcessPool), pool_of(1) as pool:
            return pool.submit(work, *task).result()
    return {"error": "its process died (no memory, or a signal); run it alone with `cosim run --set ...` to see"}


@contextmanager
def pool_of(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that end with the work: at once if it is broken off, and if this process is killed."""
    context = multiprocessing.get_context("spawn")
    theirs, ours = context.Pipe(duplex=False)
    pool = ProcessPoolExecutor(workers, context, _end_with, (theirs,))
    try:
        yield pool
    except BaseException:
        ours.close()
        raise
    finally:
        pool.shutdown(cancel_futures=True)
        ours.close()
        theirs.close()


def _end_with(parent: Connection) -> None:
    """Starts a process of the pool: Ctrl-C is the parent's to answer, and when the parent lets go, this one ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        with suppress(EOFError, OSError):
            parent.recv_bytes()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
