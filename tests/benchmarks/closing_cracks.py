"""What cracks that close cost: the 165 m floe of the basin without rubble, 60 x 60 nodes, on the explicit engine.

Three runs of the same seconds in one process: the engine without a crack (layers too strong to begin), with cracks that
close, and the thesis's open cracks with true inertia. Prints processor times, their ratios, and the share of the
crack law: what closing cracks cost beyond the engine without a crack.

    uv run python tests/benchmarks/closing_cracks.py --seconds 12
"""

from __future__ import annotations

import argparse
import time

from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.scenario.loading import load_scenario

COMMON = ["rubble.enabled=false", "rubble.initial_volume='0 m^3'", "recording.every='1 s'"]
CASES = {
    "no crack": ["fracture.layer_strength='100 GPa'"],
    "closing": [],
    "open, dynamic": [
        "fracture.cracks='open'",
        "fracture.propagation='dynamic'",
        "ice.tensile_strength='750 kPa'",
        "ice.flexural_strength='750 kPa'",
    ],
}


def timed(overrides: list[str], seconds: float) -> tuple[float, float]:
    """Processor time of a run without its building [s], and its largest Fx [N]."""
    scenario = load_scenario("basin_2010_floe_165m", [*COMMON, f"scenario.duration='{seconds:g} s'", *overrides])
    scheduler, peak = build(scenario), 0.0
    scheduler.macro_step()  # compiled
    began = time.process_time()
    while scheduler.t_ns < scenario.duration_ns:
        peak = max(peak, float(scheduler.macro_step().load.sum(axis=0)[0]))
    return time.process_time() - began, peak


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=12.0, help="simulated [s]")
    seconds = parser.parse_args().seconds
    with threadpool_limits(1):
        found = {name: timed(overrides, seconds) for name, overrides in CASES.items()}
    for name, (spent, peak) in found.items():
        print(
            f"{name:14s} {spent:6.2f} s for {seconds:g} s, {seconds / spent:5.2f} x real time, "
            f"largest Fx {peak / 1e6:.2f} MN"
        )
    plain, closing, opened = (found[name][0] for name in CASES)
    print(f"closing / no crack {closing / plain:.2f}, share of the crack law {1.0 - plain / closing:.0%}")
    print(f"closing / open on the explicit engine with true inertia {closing / opened:.2f}")


if __name__ == "__main__":
    main()
