"""Time until a command does what it is asked to, on a fresh machine and afterwards.

    python tests/benchmarks/startup.py            # all of it: compiles everything twice into folders of its own
    python tests/benchmarks/startup.py --quick    # without what compiles

Each line is a process of its own: wall time and the processor time of it and of its children, which other users of the
machine disturb less. `--kernels N` lists the N kernels of each part that take longest to compile, callees excluded.
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from typing import Any

from cosim.warming import PARTS, compile_part

COSIM = [sys.executable, "-m", "cosim"]
BEGIN = ["run", "first_cone", "-q", "--set", "scenario.duration='0.02 s'"]
EXCLUSIVE = "import sys; from startup import kernels; kernels(sys.argv[1], int(sys.argv[2]))"


def timed(title: str, command: list[str], folder: str) -> None:
    """Run a command with its kernels in ``folder``; prints a line."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
    subprocess.run(command, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{title:45} {wall:7.2f} s   processor {cpu:7.2f} s", flush=True)


def kernels(part: str, count: int) -> None:
    """Compile a part in this process; prints the kernels that take longest, without what they call."""
    from numba.core import event

    own: Counter[str] = Counter()
    under_way: list[list[float]] = []  #: begin, and what callees have taken

    class Listener(event.Listener):
        def on_start(self, _event: Any) -> None:
            under_way.append([time.process_time(), 0.0])

        def on_end(self, event: Any) -> None:
            began, callees = under_way.pop()
            spent, function = time.process_time() - began, event.data["dispatcher"].py_func
            own[f"{function.__module__}.{function.__qualname__}"] += spent - callees
            if under_way:
                under_way[-1][1] += spent

    listener = Listener()
    event.register("numba:compile", listener)
    compile_part(part)
    print(f"{part}: {len(own)} kernels, {sum(own.values()):.1f} s of processor time")
    for name, seconds in own.most_common(count):
        print(f"    {seconds:6.2f} s  {name}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--kernels", type=int, default=0)
    given = parser.parse_args()
    print(f"{os.cpu_count()} processors, load average {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
        timed("cosim --help", [*COSIM, "--help"], one)
        timed("import cosim.simulation", [sys.executable, "-c", "import cosim.simulation"], one)
        if not given.quick:
            timed("first run on a fresh machine, one window", [*COSIM, *BEGIN], other)
            timed("cosim warm", [*COSIM, "warm"], one)
            timed("second run, one window", [*COSIM, *BEGIN], one)
    for part in PARTS if given.kernels else ():
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-c", EXCLUSIVE, part, str(given.kernels)]
            environment = {**os.environ, "NUMBA_CACHE_DIR": folder, "PYTHONPATH": os.path.dirname(__file__)}
            subprocess.run(command, env=environment, check=True)


if __name__ == "__main__":
    main()
