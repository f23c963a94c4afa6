"""A plan by roofline, no measurement: the explicit engine's sub-steps for 10^6 nodes on one graphics card.

    python tests/benchmarks/card_plan.py

Counted, per node and sub-step:

* bytes: arrays that each pass of `lattice.cuda.kernels` over the nodes reads and writes, each entry once (neighbours
  are in the card's caches);
* operations: those of double precision in the assembly of these passes for compute capability 8.0, a fused one as two.
  Passes over points of contact and held nodes are left out: they have as many entries as an edge has nodes.

Cards by what their maker publishes, all of it reached. The length of sub-steps is that of the 165 m floe, from a mesh
of 120 x 120 nodes: without material damping it goes with the cells' size, with it with the square. What the host does
between the sub-steps of a window is measured here, on the engine of the host, and taken as proportional to the nodes.
"""

from __future__ import annotations

import re
import time
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from engine_cost import machine
from numba import cuda, typeof
from numba.cuda import dispatcher
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.scenario.loading import load_scenario
from lattice.cuda import kernels as k
from lattice.explicit.engine import SHARE_OF_CRITICAL
from lattice.explicit.layout import HalfSprings, Intact, Motion, Pace, PerNode
from lattice.explicit.screen import Screen

NODES, SIDE, COARSE, HOST = 10**6, 1000, 120, 240
WIDTH = 8  #: bytes of a number
#: numbers that a pass reads and writes per node
MOVE = (5 + 5 + 2 + 3) + (5 + 5)  #: y, v, shares of cells, kicks; v, y after
OVERLOADED = 4 + 4 + 1 + 1  #: y and v without the deflection, threshold, fibre
BOOKED = 5 + (5 + 5 + 2 + 1 + 1 + 1)  #: v before, kept; v before and after, shares, mass, loss read and written
#: numbers per node that cross between host and card in a window without a failure: motion both ways, lattice, path
CROSS = 2 * 10 + 8 + 3 * 3


class Card(NamedTuple):
    """What its maker publishes."""

    name: str
    flops: float  #: double precision, without tensor cores [1/s]
    bandwidth: float  #: [B/s]
    link: float  #: to the host, one way [B/s]
    source: str


CARDS = (
    Card("A100 80 GB PCIe", 9.7e12, 1935e9, 32e9, "NVIDIA A100 datasheet, r4 (2021)"),
    Card(
        "GeForce RTX 4090", 82.6e12 / 64, 1008e9, 32e9, "NVIDIA Ada architecture whitepaper (2022): FP64 1/64 of FP32"
    ),
)


def operations() -> dict[str, int]:
    """Of double precision per node, in the assembly of each pass."""
    dispatcher.get_current_device = lambda: SimpleNamespace(compute_capability=(8, 0))
    two, three, whole = np.zeros((1, 1)), np.zeros((1, 1, 1)), np.zeros(1, np.int64)
    lattice = k.Lattice(
        Intact(two, two),
        PerNode(two, two, two),
        two,
        two,
        Screen(1.0, two),
        HalfSprings(*[1.0] * 8),
        Pace(*[1.0] * 4),
    )
    motion = Motion(three, three)
    calls = {
        k.move: (1, whole, motion, three, three, 1, lattice),
        k.overloaded: (1, whole, motion, lattice),
        k.dissipate: (1, whole, three, three, lattice, two),
    }
    found = {}
    for kernel, arguments in calls.items():
        assembly, _ = cuda.compile_ptx(kernel.py_func, tuple(map(typeof, arguments)), cc=(8, 0))
        single = re.findall(r"\t(?:add|sub|mul|neg)\.(?:rn\.)?f64", assembly)
        found[kernel.py_func.__name__] = len(single) + 2 * len(re.findall(r"\tfma\.rn\.f64", assembly))
    return found


def floe(n: int, *overrides: str):
    """The 165 m floe with n x n nodes on the host's explicit engine, alone."""
    common = ("rubble.enabled=false", "fracture.propagation='dynamic'", f"sheet.nodes=[{n}, {n}]")
    return build(load_scenario("van_vliet_2018_floe_165m", [*common, *overrides]))


def on_the_host(n: int) -> tuple[float, float]:
    """Processor time per node outside the loop of sub-steps in a window, and in it per sub-step [s]."""
    scheduler = floe(n, "ice.material_damping='0 s'")
    engine, inside = scheduler.sheet.sheet.engine, [0.0]
    loop = engine.loop

    def timed(*arguments):
        began = time.process_time()
        made = loop(*arguments)
        inside[0] += time.process_time() - began
        return made

    scheduler.macro_step()
    engine.loop = timed
    began = time.process_time()
    for _ in range(3):
        scheduler.macro_step()
    between = time.process_time() - began - inside[0]
    return between / 3 / n**2, inside[0] / 3 / engine.sub_steps / n**2


def main() -> None:
    """Prints the counts and the plan."""
    done = operations()
    quiet, booked = MOVE + OVERLOADED, MOVE + OVERLOADED + BOOKED
    flops = done["move"] + done["overloaded"]
    flops_booked = flops + done["dissipate"]
    print(f"A plan for {NODES:.0e} nodes, not a measurement. {machine()}\n")
    print(f"per node and sub-step: {WIDTH * quiet} B, {flops} operations ({done})")
    print(f"with damping taken stock of: {WIDTH * booked} B, {flops_booked} operations\n")
    with threadpool_limits(1):
        engines = [floe(COARSE, *more).sheet.sheet.engine for more in (("ice.material_damping='0 s'",), ())]
        between, core = (NODES * t for t in on_the_host(HOST))
    share = (COARSE - 1) / (SIDE - 1)
    dt, damped = (SHARE_OF_CRITICAL * e.critical * share**p for e, p in zip(engines, (1, 2), strict=True))
    window = engines[0].window
    steps = window / dt
    print(
        f"sub-steps of {1e6 * dt:.1f} us, with material damping {1e6 * damped:.2f} us; window of {1e3 * window:g} ms\n"
    )
    print(
        "| | sub-step by memory [ms] | by arithmetic [ms] | window: sub-steps [s] | link [s] | between sub-steps [s] |"
    )
    print("|---|---|---|---|---|---|")
    print(f"| one core of this host | | | {steps * core:.2f} | | {between:.2f} |")
    for card in CARDS:
        memory, arithmetic = NODES * WIDTH * quiet / card.bandwidth, NODES * flops / card.flops
        marched, crossing = steps * max(memory, arithmetic), NODES * WIDTH * CROSS / card.link
        print(
            f"| {card.name} | {1e3 * memory:.3f} | {1e3 * arithmetic:.3f} | {marched:.2f} | {crossing:.3f} "
            f"| {between:.2f}, on the host |"
        )
    print("\n" + "\n".join(f"{card.name}: {card.source}" for card in CARDS))


if __name__ == "__main__":
    main()
