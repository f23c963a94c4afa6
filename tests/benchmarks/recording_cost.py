"""What recording costs: processor time of a run with a recording over that of the same run without.

    python tests/benchmarks/recording_cost.py                 # the campaign case, 40 x 40 nodes, 10 s, three pairs
    python tests/benchmarks/recording_cost.py --pairs 5 --set sheet.nodes=[60,60]
    python tests/benchmarks/recording_cost.py --case first_cone --seconds 18

The two runs of a pair follow each other, which is first alternates. All in one process after a short run that loads the
kernels; processor time (`os.times`), which other users of the machine disturb less than the wall's. The asked ratio is
below 1.05. Beside it stands what the recorder itself took of the processor time of its run, which noise hardly touches.
``--profile`` runs once more under cProfile and lists what the recorder spent its time with.
"""

from __future__ import annotations

import argparse
import cProfile
import os
import pstats
import statistics
import tempfile
import time
from pathlib import Path

from cosim.observer import RunInfo
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.scenario.scenario import Scenario
from cosim.simulation import run_scenario
from coupling.interface import Frame

CASE, NODES, SECONDS, ASKED = "basin_2010_floe_165m", "sheet.nodes=[40,40]", 10.0, 0.05  #: nodes are of this case


def processor() -> float:
    """Of this process and all its threads [s]."""
    times = os.times()
    return times.user + times.system


class Timed(Recorder):
    """A recorder that counts its own processor time."""

    own = 0.0  #: [s]

    def on_start(self, run_info: RunInfo) -> None:
        began = time.thread_time()
        super().on_start(run_info)
        self.own += time.thread_time() - began

    def on_frame(self, frame: Frame) -> None:
        began = time.thread_time()
        super().on_frame(frame)
        self.own += time.thread_time() - began


def spent(scenario: Scenario, recording: Path | None) -> float:
    """Processor time of a run [s]; prints a line."""
    before, began, own = processor(), time.perf_counter(), 0.0
    if recording is None:
        run_scenario(scenario)
    else:
        with Timed(recording, force=True) as recorder:
            run_scenario(scenario, [recorder])
        own = recorder.own
    found, wall = processor() - before, time.perf_counter() - began
    what = "without" if recording is None else "with"
    print(
        f"  {what:7} {found:7.2f} s of processor time, the recorder {own:.2f} s ({own / found:.2%}); wall {wall:.1f} s"
    )
    return found


def main() -> None:
    """Prints a line for each pair, then the median of the ratios and the size of the recording."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--case", default=CASE)
    parser.add_argument("--pairs", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=SECONDS)
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--profile", action="store_true")
    asked = parser.parse_args()
    changes = [NODES, *asked.set] if asked.case == CASE else asked.set
    scenario = load_scenario(asked.case, [*changes, f"scenario.duration='{asked.seconds:g} s'"])
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        recording = Path(folder) / "run.mcap"
        spent(load_scenario(asked.case, [*changes, "scenario.duration='100 ms'"]), recording)
        for pair in range(asked.pairs):
            order = (None, recording) if pair % 2 == 0 else (recording, None)
            found = {place is not None: spent(scenario, place) for place in order}
            ratios.append(found[True] / found[False])
            print(f"pair {pair + 1}: ratio {ratios[-1]:.3f}", flush=True)
        size = recording.stat().st_size
    share = statistics.median(ratios) - 1.0
    verdict = "below" if share < ASKED else "NOT below"
    print(f"recording costs {share:+.1%} (median of {asked.pairs}), {verdict} {ASKED:.0%}")
    print(
        f"recording: {size / 1e6:.2f} MB, {size / 1e6 / asked.seconds:.3f} MB per simulated second "
        "(60 pictures for stock viewers in any run: a short one weighs more)"
    )
    if asked.profile:
        _profile(scenario)


def _profile(scenario: Scenario) -> None:
    """Where the time of the recorder goes."""
    with tempfile.TemporaryDirectory() as folder, cProfile.Profile() as profile:
        spent(scenario, Path(folder) / "run.mcap")
    pstats.Stats(profile).sort_stats("cumulative").print_stats("recording|strained|mcap|zstd", 25)


if __name__ == "__main__":
    main()
