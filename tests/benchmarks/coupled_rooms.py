"""Where the time of a coupled run goes: the 165 m floe with its rubble, recorded, room by room.

    python tests/benchmarks/coupled_rooms.py [--duration 40] [--initial 1000] [--nodes 60] [--threads 1]
                                             [--scenario NAME] [--set A.B=V]

Prints simulated over wall time (goal: at least 3 on two cores; beside other work the processor time says more) and the
share of each room. Timers stand at the doors of the rooms and count what happens inside without the rooms that are
entered from there; they cost about 1 %. The compiled loop of the rubble is one room to Python: its water and contact
kernels are timed alone, with warm caches, on the state after every 20th loop, and the rest is the step of pymunk. With
more threads the loops of the sections overlap; their sum is then divided by the number of threads.
"""

from __future__ import annotations

import argparse
import copy
import functools
import os
import tempfile
import threading
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
from rubble.contacts import accumulate
from threadpoolctl import threadpool_limits

import coupling.scheduler
import lattice.sheet
import rubble.layer
from cosim.build import build, run_info
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from coupling.contact import OverlapContact
from coupling.ledger import Ledger
from coupling.rubble_port import RubblePort
from coupling.scheduler import Scheduler
from coupling.sheet_port import SheetPort
from coupling.sheet_port.front import Front
from lattice.criteria.judge import Judge
from lattice.energy import EnergyBooks
from lattice.implicit.edge import Edge
from lattice.implicit.engine import Engine
from lattice.implicit.linear import CrackedSystem
from lattice.sheet import Sheet
from rubble.layer import RubbleLayer
from rubble.section import Section
from rubble.water import apply_water

#: room: doors, (where, name)
DOORS = {
    "lattice solve": [
        (Engine, "step"),
        (Engine, "remove"),
        (Sheet, "answer"),
        (CrackedSystem, "compliance"),
        (CrackedSystem, "response"),
    ],
    "failure checks": [(Sheet, "_utilisation"), (Judge, "standing"), (Sheet, "_release_loose"), (Sheet, "_locate")],
    "edge contact": [
        (OverlapContact, "evaluate"),
        (OverlapContact, "close_window"),
        (Edge, "force"),
        (Front, "crush"),
    ],
    "hand-over": [(Scheduler, "hand_over"), (SheetPort, "_release"), (Front, "renew")],
    "rubble": [(RubbleLayer, "advance")],
    "exchange": [
        (SheetPort, "edges"),
        (RubblePort, "set_sheet"),
        (RubblePort, "advance"),
        (RubblePort, "load"),
        (RubblePort, "sections_in_use"),
    ],
    "books": [
        (EnergyBooks, "book_step"),
        (EnergyBooks, "book_served"),
        (EnergyBooks, "loss_rate"),
        (Ledger, "close_window"),
        (Front, "_crushed_now"),
        (lattice.sheet, "between"),
        (coupling.scheduler, "force_budget"),
        (rubble.layer.table, "budget"),
    ],
    "view and recording": [(SheetPort, "view"), (RubblePort, "blocks"), (Recorder, "on_frame")],
}
EVERY = 20  #: compiled loops from one look into them to the next


class Clock:
    """Time spent in each room, without the rooms entered from it [s]."""

    def __init__(self) -> None:
        self.time: dict[str, float] = defaultdict(float)
        self.kernel: dict[str, float] = defaultdict(float)  #: of the sampled loops: whole, water, contacts
        self.loop = 0.0  #: all compiled loops
        self._inside = [0.0]
        self._lock, self._runs = threading.Lock(), 0

    def door(self, where, name: str, room: str) -> None:
        inner = getattr(where, name)

        @functools.wraps(inner)
        def timed(*args, **kwargs):
            start = time.perf_counter()
            self._inside.append(0.0)
            try:
                return inner(*args, **kwargs)
            finally:
                whole = time.perf_counter() - start
                self.time[room] += whole - self._inside.pop()
                self._inside[-1] += whole

        setattr(where, name, timed)

    def loop_door(self) -> None:
        """At the compiled loop of a section, which may run in a thread."""
        inner = Section._substeps

        def timed(section: Section, n: int) -> int:
            start = time.perf_counter()
            done = inner(section, n)
            whole = time.perf_counter() - start
            with self._lock:
                self.loop += whole
                self._runs += 1
                if len(section.blocks) and self._runs % EVERY == 0:
                    look = time.perf_counter()
                    self.kernel["whole"] += whole
                    for room, per_step in kernels(section).items():
                        self.kernel[room] += done * per_step
                    self._inside[-1] += time.perf_counter() - look  # not part of any room
            return done

        Section._substeps = timed


def best(call, repeat: int = 5) -> float:
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def kernels(s: Section) -> dict[str, float]:
    """Time of water and contacts in one sub-step of a section as it is now, on copies, without the cost of a call."""
    tables, own = s.tables, copy.deepcopy(s.sums)
    own.make_room(s.meeting().pairs.list["room"][0])
    sums = own.for_kernels(None if s.sheet is None else s.sheet.nodes.copy())
    hulls = tables.hulls._replace(flooded=tables.hulls.flooded.copy(), pressure=tables.hulls.pressure.copy())
    meeting, work = s.meeting(), sums.work
    nobody = tables.bodies._replace(blocks=0)
    nothing = meeting._replace(pairs=meeting.pairs._replace(list=np.zeros_like(meeting.pairs.list)))

    def water(bodies):
        apply_water(hulls, bodies, s.water, work.water[0], work.impulse[0])

    def contacts(who):
        accumulate(who, tables.bodies, sums.impulses)

    return {
        "water": max(best(lambda: water(tables.bodies)) - best(lambda: water(nobody)), 0.0),
        "contacts": max(best(lambda: contacts(meeting)) - best(lambda: contacts(nothing)), 0.0),
    }


def measure(a: argparse.Namespace) -> tuple[float, float, dict[str, float], int]:
    """Wall and processor time [s], time by room [s], blocks at the end."""
    scenario = load_scenario(
        a.scenario,
        [
            f"sheet.nodes=[{a.nodes}, {a.nodes}]",
            f"scenario.duration='{a.duration} s'",
            f"rubble.threads={a.threads}",
            f"rubble.initial_volume='{a.initial} m^3'",
            *a.overrides,
        ],
    )
    with threadpool_limits(1), tempfile.TemporaryDirectory() as folder:
        scheduler, recorder = build(scenario), Recorder(Path(folder) / "run.mcap")
        recorder.on_start(run_info(scenario))
        clock = Clock()
        for room, doors in DOORS.items():
            for where, name in doors:
                clock.door(where, name, room)
        clock.loop_door()
        start, busy = time.perf_counter(), time.process_time()
        while scheduler.t_ns < scenario.duration_ns:
            recorder.on_frame(scheduler.macro_step())
        looked = clock._inside[0] - sum(clock.time.values())  # looks into the compiled loop
        wall, busy = time.perf_counter() - start - looked, time.process_time() - busy - looked
        recorder.on_close()
    rooms = dict(clock.time)
    rooms["other"] = wall - sum(rooms.values())
    whole, loop = rooms.pop("rubble", 0.0), clock.loop / a.threads
    if clock.kernel["whole"] > 0.0:
        shares = {room: clock.kernel[room] / clock.kernel["whole"] for room in ("water", "contacts")}
        rooms |= {f"rubble: {room}": share * loop for room, share in shares.items()}
        rooms["rubble: pymunk step"] = (1.0 - sum(shares.values())) * loop
        rooms["rubble: around the loop"] = whole - loop
    return wall, busy, rooms, scheduler.rubble.blocks().count


def main() -> None:
    parser = argparse.ArgumentParser(description="Time of a coupled run by rooms")
    parser.add_argument("--duration", type=float, default=40.0, help="simulated time [s]")
    parser.add_argument("--initial", type=float, default=1000.0, help="initial rubble [m^3]")
    parser.add_argument("--nodes", type=int, default=60, help="along x and y")
    parser.add_argument("--threads", type=int, default=1, help="of the rubble")
    parser.add_argument("--scenario", default="van_vliet_2018_floe_165m")
    parser.add_argument("--set", dest="overrides", action="append", default=[], metavar="A.B=V")
    a = parser.parse_args()
    wall, busy, rooms, blocks = measure(a)
    print(
        f"165 m floe, {a.nodes} x {a.nodes} nodes, {a.initial:g} m3 of initial rubble, {blocks} blocks at the end, "
        f"{a.threads} thread(s), load of the machine {os.getloadavg()[0]:.1f}"
    )
    print(
        f"{a.duration:g} s simulated in {wall:.1f} s: {a.duration / wall:.2f} x real time (goal: 3 on two cores); "
        f"{busy:.1f} s of processor time, {a.duration / busy:.2f}"
    )
    for room, spent in sorted(rooms.items(), key=lambda item: -item[1]):
        print(f"  {room:26s} {spent:7.2f} s {spent / wall:6.1%}")


if __name__ == "__main__":
    main()
