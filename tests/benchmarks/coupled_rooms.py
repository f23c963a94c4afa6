"""Where the processor time of a coupled run goes: the 165 m floe of the campaign with its rubble, recorded.

    python tests/benchmarks/coupled_rooms.py [--duration 25] [--after 10] [--initial 3000] [--nodes 60]
                                             [--scenario NAME] [--set A.B=V]

Prints processor seconds per simulated second from ``--after`` on (goal: below 1 on one core) and the share of each
room; what the settling of the initial rubble takes stands apart. Timers stand at the doors of the rooms and count what
happens inside without the rooms that are entered from there. The compiled loops are entered from Python once per
sub-step of the rubble; what is left between them is the room "Python".
"""

from __future__ import annotations

import argparse
import functools
import os
import tempfile
import time
from collections import defaultdict
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

import coupling.rubble_port.initial
import lattice.cracks.engine
import lattice.explicit.engine
import rubble.neighbours
import rubble.sections
import rubble.window
from cosim.build import build, run_info
from cosim.moments import grip_of
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from coupling.rubble_port import RubblePort
from coupling.sheet_port import SheetPort

#: room: doors, (where, name)
DOORS: dict[str, list[tuple[Any, str]]] = {
    "lattice kernels": [(lattice.cracks.engine, "march_cracked"), (lattice.explicit.engine, "march")],
    "rubble kernels": [
        (rubble.window, "advance_substeps"),
        (rubble.neighbours, "find_sides"),
        (rubble.neighbours, "find_banks"),
        (rubble.sections, "_cut_all"),
    ],
    "recording": [(SheetPort, "view"), (RubblePort, "blocks"), (Recorder, "on_frame")],
    "initial rubble": [(coupling.rubble_port.initial, "settle")],
}


class Clock:
    """Processor time spent in each room, without the rooms entered from it [s]."""

    def __init__(self) -> None:
        self.time: dict[str, float] = defaultdict(float)
        self._inside = [0.0]
        for room, doors in DOORS.items():
            for where, name in doors:
                self._door(where, name, room)

    def _door(self, where: Any, name: str, room: str) -> None:
        inner = getattr(where, name)

        @functools.wraps(inner)
        def timed(*args: Any, **kwargs: Any) -> Any:
            start = time.process_time()
            self._inside.append(0.0)
            try:
                return inner(*args, **kwargs)
            finally:
                whole = time.process_time() - start
                self.time[room] += whole - self._inside.pop()
                self._inside[-1] += whole

        setattr(where, name, timed)


def measure(a: argparse.Namespace) -> tuple[float, float, dict[str, float], int]:
    """Processor time of settling and of the seconds that count [s], that by room [s], blocks at the end."""
    scenario = load_scenario(
        a.scenario,
        [
            f"sheet.nodes=[{a.nodes}, {a.nodes}]",
            f"scenario.duration='{a.duration} s'",
            f"rubble.initial_volume='{a.initial} m^3'",
            *a.overrides,
        ],
    )
    clock = Clock()
    with threadpool_limits(1), tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        scheduler, recorder = build(scenario), Recorder(Path(folder) / "run.mcap")
        settling = time.process_time() - start
        recorder.on_start(run_info(scenario))
        counts = False
        while scheduler.t_ns < scenario.duration_ns:
            if not counts and scheduler.t_ns >= a.after * 1e9:
                clock.time.clear()
                counts, start = True, time.process_time()
            frame = scheduler.macro_step()
            grip_of(frame, scenario.moment_point)
            recorder.on_frame(frame)
        busy = time.process_time() - start
        recorder.on_close()
    return settling, busy, dict(clock.time), scheduler.rubble.blocks().count


def main() -> None:
    parser = argparse.ArgumentParser(description="Processor time of a coupled run by rooms")
    parser.add_argument("--duration", type=float, default=25.0, help="simulated time [s]")
    parser.add_argument("--after", type=float, default=10.0, help="simulated time that does not count [s]")
    parser.add_argument("--initial", type=float, default=3000.0, help="initial rubble [m^3]")
    parser.add_argument("--nodes", type=int, default=60, help="along x and y")
    parser.add_argument("--scenario", default="basin_2010_floe_165m")
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="A.B=V")
    a = parser.parse_args()
    settling, busy, rooms, blocks = measure(a)
    counted = a.duration - a.after
    print(
        f"{a.scenario}, {a.nodes} x {a.nodes} nodes, {a.initial:g} m3 of initial rubble, {blocks} blocks at the end, "
        f"load of the machine {os.getloadavg()[0]:.1f}"
    )
    print(f"before the run, most of it settling: {settling:.1f} s of processor time")
    print(f"{counted:g} s from {a.after:g} s on: {busy:.1f} s of processor time, {busy / counted:.2f} per second")
    rooms["Python"] = busy - sum(rooms.values())
    for room, spent in sorted(rooms.items(), key=lambda item: -item[1]):
        print(f"  {room:16s} {spent / counted:6.3f} {spent / busy:6.1%}")


if __name__ == "__main__":
    main()
