"""Time and memory of breaking-only runs against the number of nodes, on the 165 m floe from 40 x 40 to 10^6 nodes.

    python tests/benchmarks/growth.py -o growth.png                     # all of it, in about an hour
    python tests/benchmarks/growth.py --sizes 40 60 120 --limit 60      # in a few minutes

Each run has a process of its own, and goes on for `SECONDS` of the floe from the first touch or as far
as ``--limit`` seconds of processor time reach (a share of them on explicit engines, see `CASES`). Cases:

* `implicit`: open cracks, quasi-static (van Vliet 2018, section 6.3);
* `explicit`: the same with true inertia, on the explicit engine; its material damping is proportional to stiffness,
  so that the critical step goes with the square of the cells' size;
* `closing`: cracks that close (floe of the basin of 2010);
* `undamped`: `explicit` without material damping: the critical step goes with the cells' size.

Cost is wall and processor time per simulated second, without the start: building and the first window, which
factorises. Sizes are compared over the same time of the floe, the longest that all of a case have reached, as slopes
of log cost over log N by least squares and between the two largest; beside them the slopes of N log N and N^1.5.
Memory is the largest resident size of the process, with Python and its libraries.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import argparse
import resource
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("Agg")

import numpy as np
from engine_cost import apart, machine
from matplotlib import pyplot as plt
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.scenario.loading import load_scenario
from coupling.scheduler import Scheduler

SIZES = (40, 60, 120, 240, 480)
THESIS, BASIN = "van_vliet_2018_floe_165m", "basin_2010_floe_165m"
DYNAMIC = ("fracture.propagation='dynamic'",)


class Case(NamedTuple):
    """A floe, and what of it is affordable."""

    scenario: str
    overrides: tuple[str, ...]
    largest: int  #: nodes along a side
    share: float  #: of the processor time of the implicit engine: an explicit one costs the same in every window


CASES = {
    "implicit": Case(THESIS, (), 480, 1.0),
    "explicit": Case(THESIS, DYNAMIC, 240, 0.05),
    "closing": Case(BASIN, ("rubble.initial_volume='0 m^3'",), 240, 0.1),
    "undamped": Case(THESIS, (*DYNAMIC, "ice.material_damping='0 s'"), 1000, 0.05),
}
SECONDS = 60.0
LINES: dict[str, Callable[[np.ndarray], np.ndarray]] = {"N log N": lambda N: N * np.log(N), "N^1.5": lambda N: N**1.5}


class Task(NamedTuple):
    """One run."""

    case: str
    nodes: int  #: along a side
    limit: float  #: longest processor time [s]
    threads: int = 1
    seconds: float = SECONDS  #: longest time of the floe [s]


class Run(NamedTuple):
    """What a run took, from the end of its first window."""

    nodes: int  #: along a side
    start: float  #: processor time of building and of the first window [s]
    failed: int  #: cells
    memory: float  #: [MB]
    at: np.ndarray  #: (windows + 1,) time of the floe [s]
    wall: np.ndarray  #: (windows + 1,) [s]
    cpu: np.ndarray  #: (windows + 1,) processor time [s]

    def per_second(self, clock: np.ndarray, until: float = np.inf) -> float:
        """Mean of wall or processor time per second of the floe."""
        k = int(np.searchsorted(self.at, until * (1.0 + 1e-9), side="right")) - 1
        return float(clock[k] - clock[0]) / float(self.at[k] - self.at[0])


def floe(case: str, n: int, threads: int = 1) -> Scheduler:
    """The floe with n x n nodes, alone."""
    c, size = CASES[case], (f"sheet.nodes=[{n}, {n}]", f"sheet.threads={threads}")
    return build(load_scenario(c.scenario, ["rubble.enabled=false", *size, *c.overrides]))


def measure(task: Task) -> Run:
    """One run in this process."""
    floe(task.case, 24).macro_step()  # compiles
    with threadpool_limits(1):
        began = time.process_time()
        scheduler = floe(task.case, task.nodes, task.threads)
        rows = []
        while not rows or (rows[-1][0] < task.seconds and rows[-1][2] - rows[0][2] < task.limit):
            scheduler.macro_step()
            rows.append((scheduler.t_ns / 1e9, time.perf_counter(), time.process_time()))
        if len(rows) == 1:
            scheduler.macro_step()
            rows.append((scheduler.t_ns / 1e9, time.perf_counter(), time.process_time()))
    sheet = scheduler.sheet.sheet
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    return Run(task.nodes, rows[0][2] - began, int((~sheet.intact).sum()), memory, *np.array(rows).T)


def slope(N: np.ndarray, values: np.ndarray) -> float:
    """Exponent p of values ~ N^p by least squares."""
    return float(np.polyfit(np.log(N), np.log(values), 1)[0])


def growth_of(name: str, runs: Sequence[Run]) -> str:
    """Exponents of N, for all sizes and for the two largest."""
    until = min(float(r.at[-1]) for r in runs)
    N = np.array([float(r.nodes**2) for r in runs])
    cost = np.array([r.per_second(r.cpu, until) for r in runs])
    found = {"processor time": cost, "memory": np.array([r.memory for r in runs])}
    found |= {label: line(N) for label, line in LINES.items()}
    both = (f"{what} {slope(N, v):.2f} ({slope(N[-2:], v[-2:]):.2f})" for what, v in found.items())
    return f"exponents of {name} until {until:g} s, in brackets those of the two largest: {', '.join(both)}"


def picture(found: dict[str, list[Run]], target: Path) -> None:
    """Cost and memory of all runs beside N log N and N^1.5 through the smallest of the first case."""
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), layout="constrained")
    values: tuple[tuple[str, Callable[[Run], float]], ...] = (
        ("processor time per simulated second", lambda r: r.per_second(r.cpu)),
        ("largest resident memory [MB]", lambda r: r.memory),
    )
    first = next(iter(found.values()))[0]
    lines = np.unique([float(r.nodes**2) for runs in found.values() for r in runs])
    for axis, (title, value) in zip(axes, values, strict=True):
        for (name, runs), marker in zip(found.items(), "osD^", strict=False):
            axis.loglog([r.nodes**2 for r in runs], [value(r) for r in runs], marker + "-", label=name)
        for (label, line), style in zip(LINES.items(), (":", "--"), strict=True):
            shape = line(lines) / line(np.array(float(first.nodes**2)))
            axis.loglog(lines, value(first) * shape, style, c="0.5", label=label)
        axis.set(xlabel="nodes N", title=title)
        axis.grid(alpha=0.3)
        axis.legend()
    axes[1].set_ylim(top=2.0 * max(r.memory for runs in found.values() for r in runs))
    figure.savefig(target, dpi=110)


def main() -> None:
    """Prints a table for each case, row by row, and draws them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", nargs="*", choices=CASES, default=list(CASES))
    parser.add_argument("--sizes", type=int, nargs="*", default=(*SIZES, 1000), help="nodes along a side of the floe")
    parser.add_argument("--limit", type=float, default=1200.0, help="longest processor time of an implicit run [s]")
    parser.add_argument("--threads", type=int, choices=(1, 2), default=1, help="of the implicit and the closing case")
    parser.add_argument("-o", "--output", type=Path, default=None, metavar="PNG", help="picture")
    options = parser.parse_args()
    print(f"165 m floe, breaking only. {machine(options.threads)}")
    found: dict[str, list[Run]] = {}
    for name in options.cases:
        print(
            "\n| case | nodes | simulated [s] | failed cells | start [s] | wall per s | processor per s | memory [MB] |"
        )
        print("|---|---|---|---|---|---|---|---|")
        for n in (n for n in options.sizes if n <= CASES[name].largest):
            r = apart(measure, Task(name, n, CASES[name].share * options.limit, options.threads))
            found.setdefault(name, []).append(r)
            print(
                f"| {name} | {n} x {n} | {r.at[-1]:g} | {r.failed} | {r.start:.1f} | {r.per_second(r.wall):.2f} "
                f"| {r.per_second(r.cpu):.2f} | {r.memory:.0f} |",
                flush=True,
            )
        if len(found.get(name, ())) > 1:
            print(f"\n{growth_of(name, found[name])}", flush=True)
        if options.output is not None:
            picture(found, options.output)


if __name__ == "__main__":
    main()
