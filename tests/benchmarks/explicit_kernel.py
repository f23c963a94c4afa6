"""Node-steps per second of the explicit kernel, and the share of what one core allows.

    python tests/benchmarks/explicit_kernel.py

Both limits are measured in the same run, each with a loop of its own:

* memory: a triad a = b + s c over three arrays, together as large as the working set of the kernel, so that it lives
  in the same level of the caches. The kernel must move `BYTES` per node and step (y and v of five degrees of freedom
  read and written, three kicks and the cell read once, the threshold of the criterion read once);
* arithmetic: a polynomial of degree `DEGREE` on values in the first-level cache, once with fused multiply-adds (the
  core's peak) and once without, which is what a kernel without fastmath may use. The kernel needs `FLOPS`.

"march" is the kernel with the failure criterion in every sub-step, as the engine runs it; "sweep" leaves that out.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numba import njit

from lattice.contact import no_faces
from lattice.explicit.engine import ExplicitEngine, SubSteps
from lattice.explicit.forces import NOTHING, Touch
from lattice.explicit.kernels import sweep
from lattice.explicit.screen import overloaded
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.stiffness import hrennikoff

SIZES = (60, 120, 240, 480)
ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=750e3, sigma_f=750e3, sigma_c=4e6)
FLOPS = {"sweep": 130, "march": 130 + 69}  #: per node, counted in `lattice.explicit.kernels`: connections 58, gather 72
BYTES = {"sweep": 8 * (4 * 5 + 3 + 1), "march": 8 * (4 * 5 + 3 + 1) + 8 * (2 * 4 + 1)}
REPEATS = 7
DEGREE = 16


def best(f: Callable[[], None]) -> float:
    """Shortest time of several runs [s]."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        f()
        times.append(time.perf_counter() - start)
    return min(times)


@njit
def triad(a, b, c, s, repeats):
    for _ in range(repeats):
        for i in range(a.size):
            a[i] = b[i] + s * c[i]


def polynomial(x, out, repeats):
    """Horner's scheme, 2 x DEGREE operations per value."""
    for _ in range(repeats):
        for i in range(x.size):
            s, p = x[i], 1.0
            p = p * s + 0.5
            p = p * s + 0.25
            p = p * s + 0.125
            p = p * s + 0.06
            p = p * s + 0.03
            p = p * s + 0.02
            p = p * s + 0.01
            p = p * s + 0.005
            p = p * s + 0.51
            p = p * s + 0.26
            p = p * s + 0.13
            p = p * s + 0.07
            p = p * s + 0.04
            p = p * s + 0.021
            p = p * s + 0.011
            out[i] = p * s + 0.006


def bandwidth(size: int) -> float:
    """Of the triad over ``size`` bytes in three arrays, 24 bytes an element [B/s]."""
    n = size // 24
    a, b, c = np.zeros(n), np.ones(n), np.ones(n)
    repeats = max(1, 20_000_000 // n)
    triad(a, b, c, 0.5, 1)
    return 24.0 * n * repeats / best(lambda: triad(a, b, c, 0.5, repeats))


def arithmetic(fused: bool) -> float:
    """Operations per second of one core [1/s]."""
    loop = njit(fastmath={"contract"} if fused else False)(polynomial)
    x, out = np.linspace(0.1, 0.9, 1024), np.zeros(1024)
    loop(x, out, 1)
    return 2.0 * DEGREE * 1024 * 5000 / best(lambda: loop(x, out, 5000))


def engine(n: int) -> ExplicitEngine:
    """A square floe in gentle motion."""
    e = ExplicitEngine(
        Grid(n, n, 165.0 / 59.0),
        ICE,
        hrennikoff(ICE),
        1.0,
        held_in_plane=np.zeros(n * n, bool),
        alpha=1e-3,
        damping=500.0,
        sub_steps=SubSteps(longest=1e-4),
    )
    e.motion.v[:, :n, :n] = 1e-6 * np.random.default_rng(1).standard_normal((5, n, n))
    return e


def working_set(e: ExplicitEngine) -> int:
    """Bytes that a sub-step touches."""
    return sum(a.nbytes for a in (*e.motion, *e.mesh.kick, *e.mesh.intact, e.mesh.threshold))


def rates(n: int) -> dict[str, float]:
    """Node-steps per second."""
    e, steps = engine(n), max(4, 10_000_000 // n**2)
    none = np.zeros((0, 3))
    touch, mesh = (
        Touch(*np.zeros((2, 0), np.int64), *np.zeros((2, 0)), none, none, np.zeros((0, 3, 3)), no_faces(0)),
        e.mesh,
    )

    def sweeps() -> None:
        for _ in range(steps):
            sweep(e.motion, mesh.intact, mesh.kick, mesh.springs, mesh.pace, mesh.rows)

    out = {}
    for name, f in (("sweep", sweeps), ("march", lambda: e.march(steps, NOTHING, touch, False))):
        f()
        out[name] = n * n * steps / best(f)
    assert overloaded(e.motion, mesh.threshold, e.screen, e.alpha) == 0, "the motion of the benchmark broke the floe"
    return out


def main() -> None:
    fused, plain = arithmetic(True), arithmetic(False)
    print(f"arithmetic of one core: {plain / 1e9:.1f} Gflop/s, fused {fused / 1e9:.1f} Gflop/s")
    print(
        f"{'nodes':>11} {'set':>8} {'triad':>10}   {'loop':6} {'node-steps':>12} {'of memory':>10} "
        f"{'of arithmetic':>14} {'of fused':>9}"
    )
    for n in SIZES:
        size = working_set(engine(n))
        memory = bandwidth(size)
        for name, rate in rates(n).items():
            print(
                f"{n:>5} x {n:<3} {size / 2**20:6.2f} MB {memory / 1e9:5.1f} GB/s   {name:6} {rate / 1e6:8.1f} M/s "
                f"{rate * BYTES[name] / memory:9.0%} {rate * FLOPS[name] / plain:13.0%} "
                f"{rate * FLOPS[name] / fused:9.0%}",
                flush=True,
            )


if __name__ == "__main__":
    main()
