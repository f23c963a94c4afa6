"""Where the processor time of a coupled run goes: the 165 m floe of the campaign with its rubble, recorded.

    python tests/benchmarks/coupled_rooms.py [--duration 25] [--after 10] [--initial 3000] [--nodes 60]
                                             [--scenario NAME] [--set A.B=V]

Prints seconds of processor and of wall per simulated second from ``--after`` on (goal: below 1) and the share of each
room; what the settling of the initial rubble takes stands apart. Windows are done by one thread and by two in turn,
which is the same run because the bits are the same: so both see the same ice and the same load of the machine. Timers
stand at the doors of the rooms and count what happens inside without the rooms that are entered from there. The
compiled loops are entered from Python once per sub-step of the rubble; what is left between them is the room "Python".
"""

from __future__ import annotations

import argparse
import functools
import os
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

import coupling.rubble_port.initial
import rubble.neighbours
import rubble.sections
import rubble.window
from cosim.build import build, run_info
from cosim.moments import grip_of
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from coupling.rubble_port import RubblePort
from coupling.sheet_port import SheetPort
from lattice.cracks.engine import CrackingEngine
from lattice.explicit.engine import ExplicitEngine
from lattice.team import TILES

Spent = tuple[float, float]  #: time of the processor, both cores of it, and of the wall [s]
#: room: doors, (where, name)
DOORS: dict[str, list[tuple[Any, str]]] = {
    "lattice kernels": [(CrackingEngine, "loop"), (ExplicitEngine, "loop")],
    "rubble kernels": [
        (rubble.window, "advance_substeps"),
        (rubble.neighbours, "find_sides"),
        (rubble.neighbours, "find_banks"),
        (rubble.sections, "_cut_all"),
    ],
    "recording": [(SheetPort, "view"), (RubblePort, "blocks"), (Recorder, "on_frame")],
    "initial rubble": [(coupling.rubble_port.initial, "settle")],
}


def now() -> Spent:
    """What has been spent so far."""
    return time.process_time(), time.perf_counter()


def added(a: Spent, b: Spent, sign: float = 1.0) -> Spent:
    """A and, with this sign, b."""
    return a[0] + sign * b[0], a[1] + sign * b[1]


class Clock:
    """Time spent in each room by each number of threads, without the rooms entered from it."""

    def __init__(self) -> None:
        self.threads = 1
        self.time: dict[tuple[str, int], Spent] = defaultdict(lambda: (0.0, 0.0))
        self._inside: list[Spent] = [(0.0, 0.0)]
        for room, doors in DOORS.items():
            for where, name in doors:
                self._door(where, name, room)

    def _door(self, where: Any, name: str, room: str) -> None:
        inner = getattr(where, name)

        @functools.wraps(inner)
        def timed(*args: Any, **kwargs: Any) -> Any:
            start = now()
            self._inside.append((0.0, 0.0))
            try:
                return inner(*args, **kwargs)
            finally:
                whole = added(now(), start, -1.0)
                key = room, self.threads
                self.time[key] = added(self.time[key], added(whole, self._inside.pop(), -1.0))
                self._inside[-1] = added(self._inside[-1], whole)

        setattr(where, name, timed)


@dataclass
class Measured:
    """What was spent."""

    settling: float  #: of the processor before the run [s]
    rooms: dict[tuple[str, int], Spent]  #: by room and threads
    busy: dict[int, Spent]  #: in all, by threads
    windows: dict[int, int]  #: that count, by threads
    window: float  #: their length [s]
    blocks: int  #: at the end


def measure(a: argparse.Namespace) -> Measured:
    """Runs the case; its windows are done by one thread and by two in turn where its cracks close."""
    scenario = load_scenario(
        a.scenario,
        [
            f"sheet.nodes=[{a.nodes}, {a.nodes}]",
            f"scenario.duration='{a.duration} s'",
            f"rubble.initial_volume='{a.initial} m^3'",
            *a.overrides,
        ],
    )
    clock, busy, windows = Clock(), defaultdict[int, Spent](lambda: (0.0, 0.0)), defaultdict[int, int](int)
    with threadpool_limits(1), tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        scheduler, recorder = build(scenario), Recorder(Path(folder) / "run.mcap")
        settling = time.process_time() - start
        recorder.on_start(run_info(scenario))
        assert isinstance(scheduler.sheet, SheetPort)
        engine: Any = scheduler.sheet.sheet.engine
        sides, done = range(1, (TILES if isinstance(engine, CrackingEngine) else 1) + 1), 0
        while scheduler.t_ns < scenario.duration_ns:
            counts = scheduler.t_ns >= a.after * 1e9
            clock.threads = engine.threads = sides[done % len(sides)] if counts else 1
            if not counts:
                clock.time.clear()
            before = now()
            frame = scheduler.macro_step()
            grip_of(frame, scenario.moment_point)
            recorder.on_frame(frame)
            done += 1
            if counts:
                busy[clock.threads] = added(busy[clock.threads], added(now(), before, -1.0))
                windows[clock.threads] += 1
        recorder.on_close()
    blocks = scheduler.rubble.blocks().count
    return Measured(settling, dict(clock.time), dict(busy), dict(windows), scenario.window_ns / 1e9, blocks)


def main() -> None:
    parser = argparse.ArgumentParser(description="Processor time of a coupled run by rooms")
    parser.add_argument("--duration", type=float, default=25.0, help="simulated time [s]")
    parser.add_argument("--after", type=float, default=10.0, help="simulated time that does not count [s]")
    parser.add_argument("--initial", type=float, default=3000.0, help="initial rubble [m^3]")
    parser.add_argument("--nodes", type=int, default=60, help="along x and y")
    parser.add_argument("--scenario", default="basin_2010_floe_165m")
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="A.B=V")
    a = parser.parse_args()
    m = measure(a)
    print(
        f"{a.scenario}, {a.nodes} x {a.nodes} nodes, {a.initial:g} m3 of initial rubble, {m.blocks} blocks at the end, "
        f"load of the machine {os.getloadavg()[0]:.1f}"
    )
    print(f"before the run, most of it settling: {m.settling:.1f} s of processor time")
    for threads, busy in m.busy.items():
        counted, left = m.windows[threads] * m.window, busy
        rooms = {room: spent for (room, n), spent in m.rooms.items() if n == threads}
        for spent in rooms.values():
            left = added(left, spent, -1.0)
        rooms["Python"] = left
        print(
            f"{threads} thread(s), {counted:.2f} s from {a.after:g} s on, per second: "
            f"{busy[0] / counted:.2f} s of processor, {busy[1] / counted:.2f} s of wall"
        )
        for room, spent in sorted(rooms.items(), key=lambda item: -item[1][1]):
            print(f"  {room:16s} {spent[0] / counted:6.3f} {spent[1] / counted:6.3f} {spent[1] / busy[1]:6.1%} of wall")


if __name__ == "__main__":
    main()
