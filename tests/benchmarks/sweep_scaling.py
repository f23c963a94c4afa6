"""How a sweep scales: 40 short runs on one process, on two, and on a dask cluster of two workers of this machine.

    uv run python tests/benchmarks/sweep_scaling.py [--runs 40] [--cluster]

Prints wall times and the speed-up, beside that of two sweeps of half the runs which know nothing of each other: more
than that the machine does not give. On a machine that others use too, wall times say little: the processor time of each
process tells what the wall time would be on idle cores, which is that of the busiest process beside the parent's own.
"""

from __future__ import annotations

import argparse
import os
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from math import nan
from typing import Any

from cosim.scenario.loading import read_scenario
from cosim.study.cluster import Cluster
from cosim.study.design import Design
from cosim.study.pool import Processes
from cosim.study.sweep import Runner, sweep
from cosim.study.task import Study, run_variant

CASE = "basin_2010_floe_165m"
SHORT = (
    "scenario.duration='20 s'",
    "sheet.nodes=[24, 24]",
    "rubble.enabled=false",
    "fracture.cracks=open",
    "ice.tensile_strength='750 kPa'",
    "ice.strength_field={variation=0.2,correlation_length='10 m'}",
)


def timed(study: Study, number: int, variant: Any) -> dict[str, Any]:
    """A run, with its process and the processor time that this has used since it began."""
    return {**run_variant(study, number, variant), "pid": os.getpid(), "cpu": time.process_time()}


def measure(name: str, runner: Runner, runs: int, task: Any = timed) -> tuple[float, float, list[dict[str, Any]]]:
    """Wall time, processor time of the busiest process and the parent, and the rows.

    A cluster has tasks of the program alone, which do not tell their processor time.
    """
    study, variants = Study(read_scenario(CASE), SHORT), Design(seeds=runs).variants([], 0)
    began, own = time.perf_counter(), time.process_time()
    rows = sweep(study, variants, runner, lambda row: None, task=task)
    wall, own = time.perf_counter() - began, time.process_time() - own
    busy: dict[int, float] = defaultdict(float)
    for row in rows:
        if task is timed:
            busy[row["pid"]] = max(busy[row["pid"]], row["cpu"])
    each = ", ".join(f"{t:.1f}" for t in sorted(busy.values()))
    print(f"{name}: wall {wall:.1f} s, processor time of the processes {each} s, of the parent {own:.1f} s", flush=True)
    return wall, max(busy.values(), default=nan) + own, rows


def bare(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows without what they cost."""
    return [{k: v for k, v in row.items() if k not in ("wall_s", "pid", "cpu")} for row in rows]


def apart(runs: int) -> float:
    """Wall time of two sweeps of half the runs, each on one process of its own, side by side [s]."""

    def half(first: int) -> None:
        study, variants = Study(read_scenario(CASE), SHORT), Design(seeds=runs).variants([], 0)
        sweep(study, variants[first::2], Processes(1), lambda row: None, task=timed)

    began = time.perf_counter()
    with ThreadPoolExecutor(2) as both:
        list(both.map(half, (0, 1)))
    wall = time.perf_counter() - began
    print(f"two sweeps side by side: wall {wall:.1f} s", flush=True)
    return wall


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--cluster", action="store_true")
    given = parser.parse_args()
    measure("warming up", Processes(2), 2)
    one = measure("one process", Processes(1), given.runs)
    two = measure("two processes", Processes(2), given.runs)
    limit = apart(given.runs)
    others = [("two processes", two)]
    if given.cluster:
        import distributed

        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            runner = Cluster(cluster.scheduler_address)
            others.append(("dask", measure("dask, two workers", runner, given.runs, run_variant)))
    for name, other in others:
        same = "the same bits" if bare(other[2]) == bare(one[2]) else "OTHER BITS"
        print(f"{name}: speed-up {one[0] / other[0]:.2f} by wall, {one[1] / other[1]:.2f} by processor time; {same}")
    print(f"two sweeps side by side: {one[0] / limit:.2f} by wall, which is all that this machine gives")


if __name__ == "__main__":
    main()
