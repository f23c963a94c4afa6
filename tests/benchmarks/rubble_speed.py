"""Speed of the rubble: 500 blocks in 15 sections, beside plain pymunk with the same pile in the same run.

    python tests/benchmarks/rubble_speed.py [--settle 40] [--seconds 2] [--repeat 10]

Plain pymunk is the limit: its sections do not know of each other, may be stepped on two threads, and solve three
degrees of freedom with friction in the plane. The layer solves all sections together, six degrees of freedom and a
cone of friction in three dimensions, on one thread and on two. All piles settle first, so that they have the same
contacts. Layers and peers alternate, and the best of the repeats counts: other work on the machine only ever slows a
run down.
"""

from __future__ import annotations

import argparse
import os
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pymunk

from rubble.cut import plane
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

SECTIONS, BLOCKS, WIDTH, SIZE = 15, 500, 5.6, (4.0, 2.0)
PHYSICS = RubblePhysics(
    rho_i=846.0,
    rho_w=1006.0,
    thickness=SIZE[1],
    mu_ice_ice=0.1,
    mu_structure=0.1,
    restitution=0.1,
    added_mass=0.2,
    added_inertia=0.2,
    contact_strength=4e6,
)
WINDOW = 10  #: sub-steps, the default coupling window of 50 ms
#: an upturned bin with a sloping side: blocks pile up in it as between sheet and structure
BIN = [
    np.array([(-14.0, -4.0), (14.0, -4.0), (14.0, -2.0), (-14.0, -2.0)]),
    np.array([(2.0, -4.0), (12.0, -14.0), (12.0, -4.0)]),
    np.array([(-14.0, -150.0), (-10.0, -150.0), (-10.0, -2.0), (-14.0, -2.0)]),
    np.array([(10.0, -150.0), (14.0, -150.0), (14.0, -2.0), (10.0, -2.0)]),
]


def outlines(section: int) -> list[tuple[np.ndarray, float]]:
    """Outlines and tilts of the blocks of one section."""
    random = np.random.default_rng(section)
    box = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * np.array(SIZE) / 2.0
    count = BLOCKS // SECTIONS + (section < BLOCKS % SECTIONS)
    places = [(-5.0 + 5.0 * (i % 3), -16.0 - 4.6 * (i // 3), random.uniform(-0.4, 0.4)) for i in range(count)]
    return [(place(box, x, z, angle, 0.0, 0.0), angle) for x, z, angle in places]


def our_layer(threads: int = 1) -> RubbleLayer:
    layer = RubbleLayer(replace(PHYSICS, threads=threads), WIDTH, solids=lambda y: plane(BIN))
    for key in range(SECTIONS):
        for outline, angle in outlines(key):
            middle = float(outline.mean(axis=0) @ [np.cos(angle), np.sin(angle)])
            layer.add_block(
                key, Slab(outline, middle + np.array([-0.5, 0.5]) * SIZE[0], np.array([WIDTH]), 846.0, angle)
            )
    return layer


def plain_space() -> pymunk.Space:
    """A space with the solver's settings of the layer."""
    space = pymunk.Space()
    space.collision_persistence, space.collision_slop = 1, PHYSICS.slop
    space.iterations = PHYSICS.iterations
    return space


class Plain:
    """The same pile in pymunk alone: net buoyancy as gravity, water as damping, no loads, no water forces."""

    def __init__(self, threads: int) -> None:
        self.spaces = [self._space(key) for key in range(SECTIONS)]
        self.pool = ThreadPoolExecutor(threads) if threads > 1 else None

    @staticmethod
    def _space(key: int) -> pymunk.Space:
        space = plain_space()
        space.gravity, space.damping = (0.0, 9.81 * (1006.0 / 846.0 - 1.0)), 0.6
        for solid in BIN:
            space.add(pymunk.Poly(space.static_body, solid.tolist()))
        mass = 846.0 * SIZE[0] * SIZE[1] * WIDTH
        for outline, angle in outlines(key):
            body = pymunk.Body(mass, mass * (SIZE[0] ** 2 + SIZE[1] ** 2) / 12.0)
            body.position, body.angle = tuple(outline.mean(axis=0).tolist()), angle
            shape = pymunk.Poly(
                body, [(x * SIZE[0] / 2, z * SIZE[1] / 2) for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            )
            shape.friction = 0.1**0.5
            space.add(body, shape)
        for shape in space.static_body.shapes:
            shape.friction = 0.1**0.5
        return space

    def advance(self, n: int) -> None:
        def steps(space: pymunk.Space) -> None:
            for _ in range(n):
                space.step(PHYSICS.substep)

        list((self.pool.map if self.pool else map)(steps, self.spaces))


def settled(what, seconds: float):
    """The same, run until its pile has formed."""
    for _ in range(round(seconds / PHYSICS.substep / WINDOW)):
        what.advance(WINDOW)
    return what


def factor(what, seconds: float) -> float:
    """Simulated over wall time."""
    start = time.perf_counter()
    for _ in range(round(seconds / PHYSICS.substep / WINDOW)):
        what.advance(WINDOW)
    return seconds / (time.perf_counter() - start)


def tables_over_window(layer: RubbleLayer, repeat: int) -> float:
    """Time of laying out the tables of all plates, as after each break, over that of a window."""
    clocks = []
    for what in (layer.store.lay_out, lambda: layer.advance(WINDOW)):
        start = time.process_time()
        for _ in range(repeat):
            what()
        clocks.append(time.process_time() - start)
    return clocks[0] / clocks[1]


def measure(settle: float, seconds: float, repeat: int) -> dict[str, float]:
    """Best factors of the layer and of the peer, with one thread and two."""
    kinds = {"layer": our_layer, "plain": Plain}
    made = {f"{name}_{threads}": settled(kind(threads), settle) for name, kind in kinds.items() for threads in (1, 2)}
    best = dict.fromkeys(made, 0.0)
    for _ in range(repeat):
        for name, what in made.items():
            best[name] = max(best[name], factor(what, seconds))
    contacts = int(made["layer_1"].runner.contacts)
    pairs = (
        sum(len(s._get_arbiters()) for s in made["plain_1"].spaces),
        sum(len(s.space._get_arbiters()) for s in made["layer_1"].sections.values()),
    )
    return {
        **best,
        "share": best["layer_1"] / best["plain_1"],
        "second": best["layer_2"] / best["layer_1"],
        "tables": tables_over_window(made["layer_1"], repeat),
        "contacts": contacts,
        "pairs_plain": pairs[0],
        "pairs_layer": pairs[1],
    }


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--settle", type=float, default=40.0, help="simulated time until the pile has formed [s]")
    parser.add_argument("--seconds", type=float, default=2.0, help="simulated time of one measurement [s]")
    parser.add_argument("--repeat", type=int, default=10)
    a = parser.parse_args()
    r = measure(a.settle, a.seconds, a.repeat)
    print(
        f"{BLOCKS} blocks in {SECTIONS} sections, settled for {a.settle:g} s, load of the machine "
        f"{os.getloadavg()[0]:.1f}; {r['contacts']:.0f} contacts, pairs {r['pairs_layer']:.0f} (layer) and "
        f"{r['pairs_plain']:.0f} (plain)"
    )
    print(
        f"layer {r['layer_1']:.2f} x real time, on two threads {r['layer_2']:.2f}, {r['second']:.2f} times that; "
        f"plain pymunk {r['plain_1']:.2f} and {r['plain_2']:.2f}"
    )
    print(
        f"share of plain pymunk's speed on one thread {r['share']:.0%}; tables anew take {r['tables']:.0%} of a window"
    )


if __name__ == "__main__":
    main()
