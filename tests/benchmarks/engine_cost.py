"""Cost of the implicit engine against the number of cells, on the 165 m floe, breaking only.

    python tests/benchmarks/engine_cost.py                    # all of it; 480 x 480 nodes need minutes and gigabytes
    python tests/benchmarks/engine_cost.py --sizes 40 60 --runs 60

Measured on one thread, each size in a process of its own, for a floe in contact with the cone:

* factorisation: first step of a length that is new, less a step of a known length; both systems, and the columns of
  the edge nodes;
* window: mean over windows in which no cell fails, with all that the scheduler does in them;
* failed cell: a step after one more cell of a straight crack has gone, less a step without; twelve cells, with the new
  factorisations that fall among them;
* memory: largest resident size of the process, with Python and its libraries;
* run: 60 s of the floe from the first touch, or as far as `--limit` seconds of wall time reach.

Wall times are those of the machine as it was: the load average is printed with them, and the processor time of the
runs, which other users of the machine disturb less.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import argparse
import datetime
import multiprocessing
import resource
import time
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from cosim import bench
from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.scheduler import Scheduler

FLOE = Path(__file__).parents[2] / "scenarios" / "van_vliet_2018_floe_165m"
SIZES, RUNS = (40, 60, 120, 240, 480), (60, 240)
WINDOWS, CELLS, SIMULATED = 40, 12, 60.0


def floe(n: int) -> Scheduler:
    """The 165 m floe with n x n nodes."""
    return build(load_scenario(FLOE, ["rubble.enabled=false", f"sheet.nodes=[{n}, {n}]"]))


def seconds(f, *arguments) -> float:
    """Wall time of one call [s]."""
    start = time.perf_counter()
    f(*arguments)
    return time.perf_counter() - start


def stepper(scheduler: Scheduler):
    """A function that makes one step of the sheet from where it is, and throws the result away."""
    port = scheduler.sheet
    sheet, t = port.sheet, scheduler.t_ns / 1e9
    force_u, force_q = np.zeros((sheet.grid.nodes, 2)), np.zeros((sheet.grid.nodes, 3))
    return lambda dt: sheet.engine.step(t, dt, sheet.state, force_u, force_q, port.contact)


def cost(n: int) -> dict[str, float]:
    """One row of the table [s], [MB]."""
    floe(12).macro_step()  # compiles
    with threadpool_limits(1):
        scheduler = floe(n)
        for _ in range(10):
            scheduler.macro_step()
        window = seconds(lambda: [scheduler.macro_step() for _ in range(WINDOWS)]) / WINDOWS
        step, sheet = stepper(scheduler), scheduler.sheet.sheet
        dt = 0.9 * sheet.dt
        first, plain = seconds(step, dt), min(seconds(step, dt) for _ in range(3))
        failed = [_failure(sheet, step, cell, dt) - plain for cell in crack(n)]
    assert sheet.intact.all(), "a cell has failed: the windows were not quiet"
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    return {
        "nodes": n,
        "cells": (n - 1) ** 2,
        "factorisation": first - plain,
        "window": window,
        "step": plain,
        "failed": float(np.mean(failed)),
        "memory": memory,
    }


def _failure(sheet, step, cell: int, dt: float) -> float:
    sheet.engine.remove(np.array([cell]))
    return seconds(step, dt)


def crack(n: int) -> range:
    """Cells of a straight crack along the drift, from the front backwards."""
    m = n - 1
    last = (m - 1) * m + m // 2
    return range(last, last - min(CELLS, m - 2) * m, -m)


def whole_run(task: tuple[int, float]) -> dict[str, float]:
    """60 s of the floe, or as far as ``limit`` seconds of wall time reach."""
    n, limit = task
    floe(12).macro_step()
    with threadpool_limits(1):
        scheduler, wall, cpu = floe(n), time.perf_counter(), time.process_time()
        first = None
        while scheduler.t_ns < SIMULATED * 1e9 and time.perf_counter() - wall < limit:
            frame = scheduler.macro_step()
            first = first or next((e for e in frame.events if e.kind == "circumferential"), None)
    return {
        "nodes": n,
        "simulated": scheduler.t_ns / 1e9,
        "wall": time.perf_counter() - wall,
        "cpu": time.process_time() - cpu,
        "failed": int((~scheduler.sheet.sheet.intact).sum()),
        "load": first.force[0] / 1e6 if first else float("nan"),
    }


def machine(threads: int = 1) -> str:
    """Date, threads, processor and how busy the machine is."""
    return f"{datetime.date.today()}, {('one thread', 'two threads')[threads - 1]}; {bench.machine()}"


def apart(f, task):
    """Result of f in a fresh process, so that its memory is its own."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(f, (task,))


def main() -> None:
    """Prints both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="*", default=SIZES, help="nodes along a side of the floe")
    parser.add_argument("--runs", type=int, nargs="*", default=RUNS, help="sizes of the runs of 60 s")
    parser.add_argument("--limit", type=float, default=600.0, help="longest wall time of a run [s]")
    options = parser.parse_args()
    print(f"Implicit engine, 165 m floe, breaking only. {machine()}\n")
    print("| nodes | cells | factorisation [ms] | window [ms] | step [ms] | failed cell [ms] | memory [MB] |")
    print("|---|---|---|---|---|---|---|")
    for n in options.sizes:
        r = apart(cost, n)
        print(
            f"| {n} x {n} | {r['cells']} | {1e3 * r['factorisation']:.0f} | {1e3 * r['window']:.1f} "
            f"| {1e3 * r['step']:.1f} | {1e3 * r['failed']:.1f} | {r['memory']:.0f} |",
            flush=True,
        )
    print("\n| nodes | simulated [s] | wall [s] | processor [s] | failed cells | Fx at circumferential failure [MN] |")
    print("|---|---|---|---|---|---|")
    for n in options.runs:
        r = apart(whole_run, (n, options.limit))
        print(
            f"| {n} x {n} | {r['simulated']:.1f} | {r['wall']:.1f} | {r['cpu']:.1f} | {r['failed']} "
            f"| {r['load']:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
