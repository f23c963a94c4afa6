"""Runs variants of a scenario side by side in a pool of processes, and tells what came out.

A variant that fails does not stop the others: its row holds the error as one line. So does one whose process dies (no
memory, a signal): the pool is then made anew, and what was under way runs again, one at a time, to find out which it
was. All processes end with this one, however it ends. Each variant computes on one thread, so that its numbers do not
depend on how many run beside it. Peaks are those of `cosim.analysis.sustained`, means over the averaging time of each
variant.
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
from contextlib import closing, contextmanager, suppress
from multiprocessing.connection import Connection
from typing import Any

from cosim.study.variants import Variant
from coupling.interface import PHASES

Row = dict[str, Any]
COMPONENTS = ("fx", "fz", "f")
#: columns of a row that do not depend on what is varied, [N], [s]
RESULTS = (
    *(f"{c}_peak" for c in COMPONENTS),
    *(f"{c}_time" for c in COMPONENTS),
    *(f"{p}_{c}_peak" for p in PHASES for c in COMPONENTS),
    "averaging_s",
    "not_trustworthy",
    "fx_mean",
    "fz_mean",
    "simulated_s",
    "wall_s",
    "fragments",
    "blocks",
)


def run_variant(scenario: str, overrides: Sequence[str], variant: Variant) -> Row:
    """Simulate one variant; what goes wrong becomes ``error``, one line. Runs in a process of the pool."""
    from cosim.errors import explain
    from cosim.scenario.cost import cost_of, too_large
    from cosim.scenario.loading import load_scenario
    from cosim.simulation import run_scenario

    try:
        loaded = load_scenario(scenario, (*overrides, *variant.overrides))
        if refused := too_large(cost_of(loaded.model)):
            return {"error": refused}
        run = run_scenario(loaded)
        result, mean = run.to_json(), run.mean_load()
    except Exception as error:
        return {"error": " ".join(explain(error)[0].split())}
    row = {"averaging_s": result["averaging_s"], "not_trustworthy": "; ".join(result["trust"]["because"])}
    for c in COMPONENTS:
        row[f"{c}_peak"], row[f"{c}_time"] = result["peaks"][c]["value"], result["peaks"][c]["time"]
        row |= {f"{p}_{c}_peak": result["peaks_by_phase"][p][c]["value"] for p in PHASES}
    row["fx_mean"], row["fz_mean"] = float(mean[0]), float(mean[2])
    return row | {name: result[name] for name in ("simulated_s", "wall_s", "fragments", "blocks")}


def sweep(
    scenario: str,
    overrides: Sequence[str],
    variants: Sequence[Variant],
    workers: int,
    done: Callable[[Row, list[Row]], None],
    task: Callable[..., Row] = run_variant,
) -> list[Row]:
    """A row for each variant, in their order, whatever order they end in.

    ``done`` is called as each ends, with its row and all rows until then.
    """
    rows: dict[int, Row] = {}
    ended: list[Row] = []
    with closing(_all(scenario, overrides, variants, workers, task)) as results:
        for k, row in results:
            rows[k] = {"variant": variants[k].name, **dict(variants[k].changes), **row}
            ended = with_ratios([rows[k] for k in sorted(rows)], rows.get(0, {}))
            done(rows[k], ended)
    return ended


def _all(
    scenario: str, overrides: Sequence[str], variants: Sequence[Variant], workers: int, task: Callable[..., Row]
) -> Generator[tuple[int, Row], None, None]:
    """Number and row of each variant as it ends."""
    waiting = deque(enumerate(variants))
    while waiting:
        under_way: dict[Future[Row], tuple[int, Variant]] = {}
        with suppress(BrokenProcessPool), _pool(min(workers, len(waiting))) as pool:
            while waiting or under_way:
                while waiting and len(under_way) < workers:
                    future = pool.submit(task, scenario, overrides, waiting[0][1])
                    under_way[future] = waiting.popleft()
                for future in wait(under_way, return_when=FIRST_COMPLETED).done:
                    row = future.result()
                    yield under_way.pop(future)[0], row
        for k, variant in under_way.values():  # one of them has broken the pool
            yield k, _alone(scenario, overrides, variant, task)


def _alone(scenario: str, overrides: Sequence[str], variant: Variant, task: Callable[..., Row]) -> Row:
    try:
        with _pool(1) as pool:
            return pool.submit(task, scenario, overrides, variant).result()
    except BrokenProcessPool:
        return {"error": "its process died (no memory, or a signal); run it alone with `cosim run --set ...` to see"}


@contextmanager
def _pool(workers: int) -> Iterator[ProcessPoolExecutor]:
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


def with_ratios(rows: list[Row], base: Row) -> list[Row]:
    """Adds ``fx_ratio``, ``fz_ratio``, ``f_ratio``: the peak over that of the base."""
    for row in rows:
        for c in COMPONENTS:
            least, peak = base.get(f"{c}_peak"), row.get(f"{c}_peak")
            row[f"{c}_ratio"] = peak / least if least and peak is not None else None
        row.setdefault("error", None)
    return rows
