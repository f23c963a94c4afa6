"""The benchmarks of the project, one after the other: each is a script that measures a ratio to a peer or to a limit.

Scripts stand in ``tests/benchmarks`` of a checkout; `BENCHMARKS` has those that together take about ten minutes, with
the arguments that make them short. `run` runs one in a process of its own.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from cosim.errors import InputError
from cosim.nearest import hint
from cosim.provenance import commit, version

FOLDER = Path(__file__).parents[1] / "tests" / "benchmarks"


@dataclass(frozen=True)
class Benchmark:
    """A script, and what it claims."""

    name: str
    script: str
    arguments: tuple[str, ...]
    claim: str


BENCHMARKS = (
    Benchmark("kernel", "explicit_kernel.py", (), "explicit kernel beside the core's arithmetic and memory limits"),
    Benchmark("campaign", "coupled_rooms.py", (), "campaign case against real time, and the share of each room"),
    Benchmark("cracks", "closing_cracks.py", ("--seconds", "6"), "closing cracks beside the engine without a crack"),
    Benchmark("rubble", "rubble_speed.py", ("--repeat", "3"), "500 blocks beside plain pymunk with the same pile"),
    Benchmark("recording", "recording_cost.py", (), "a run with its recording beside the same run without"),
    Benchmark(
        "growth",
        "growth.py",
        ("--sizes", "40", "60", "120", "--limit", "60"),
        "breaking only against the number of nodes",
    ),
    Benchmark("implicit", "engine_cost.py", ("--sizes", "60", "--runs", "60"), "what the implicit engine's parts cost"),
    Benchmark("vode", "engine_against_vode.py", ("--budget", "15"), "implicit engine beside VODE on the same floe"),
    Benchmark("startup", "startup.py", ("--quick",), "time until commands and runs have begun"),
)


@dataclass(frozen=True)
class Measured:
    """What a benchmark has printed."""

    benchmark: Benchmark
    text: str
    code: int  #: exit code
    wall: float  #: [s]


def chosen(names: Sequence[str]) -> tuple[Benchmark, ...]:
    """Those of these names in the order of the list; all without names. InputError for one that there is not."""
    known = [b.name for b in BENCHMARKS]
    for name in names:
        if name not in known:
            raise InputError(f"{name}: no such benchmark; {hint(name, known)}")
    return tuple(b for b in BENCHMARKS if not names or b.name in names)


def run(benchmark: Benchmark, line: Callable[[str], None], folder: Path = FOLDER) -> Measured:
    """Run one; ``line`` is given each line that it prints as it comes. InputError without a checkout."""
    script, began, lines = folder / benchmark.script, time.perf_counter(), []
    if not script.is_file():
        raise InputError(f"{script}: no such file; benchmarks come with a checkout of the project, run them there")
    command = [sys.executable, "-u", str(script), *benchmark.arguments]
    root = str(Path(__file__).parents[1])
    path = os.pathsep.join([root, *filter(None, [os.environ.get("PYTHONPATH")])])
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env={**os.environ, "PYTHONPATH": path}
    ) as process:
        for text in process.stdout or ():
            lines.append(text.rstrip())
            line(lines[-1])
    return Measured(benchmark, "\n".join(lines), process.returncode, time.perf_counter() - began)


def machine() -> str:
    """Processor, cores and how busy they are, in a line."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    busy = f", load {os.getloadavg()[0]:.1f} at the start" if hasattr(os, "getloadavg") else ""
    return f"{_processor()}, {cores} cores{busy}, {platform.system()}, Python {platform.python_version()}"


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    if info.is_file():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def page(found: Sequence[Measured], date: str, where: str) -> str:
    """All that was printed as a page; ``date`` and ``where``: of the measurement."""
    lines = ["# Benchmarks of brash", "", f"{date}, version {version()}, commit {commit()}: {where}.", ""]
    for m in found:
        b, failed = m.benchmark, f", **failed with exit code {m.code}**" if m.code else ""
        command = " ".join(["python", f"tests/benchmarks/{b.script}", *b.arguments])
        lines += [
            f"## {b.name}: {b.claim}",
            "",
            f"`{command}`, {m.wall:.0f} s{failed}",
            "",
            "```text",
            m.text,
            "```",
            "",
        ]
    return "\n".join(lines)
