"""This engine against the solver family of the thesis: VODE, relative tolerance 1e-8, absolute 1e-10 (section 4.2.1).

    python tests/benchmarks/engine_against_vode.py                # a few minutes
    python tests/benchmarks/engine_against_vode.py --budget 600   # VODE as far as 600 s of processor reach, each time

Same floe (165 m, 60 x 60 nodes), same lattice, contact law and damping, one thread. The thesis used DVODE F90 with the
sparsity of the stiffness matrix given; `scipy.integrate.ode("vode")` is the Fortran solver it descends from, which
takes a band instead (half width 619 for this floe, node by node). Compared are ``adams``, explicit enough to need no
matrix, and ``bdf`` with the band. The right-hand side is compiled: springs, mass, foundation, both dampings, contact.

VODE needs minutes (adams) to hours (bdf) for the 25.6 s to the circumferential failure and removes no cells. So this
engine runs once, its state at the start of four windows is handed to VODE, and VODE runs from there to the end of the
window or of its budget: two windows of slow loading, and the last moments before the first failure and before the
circumferential failure, in which VODE goes on until a cell reaches its limit. Loads are compared at equal times, and
at the failure. The ratio of a whole approach is *extrapolated* from VODE's time per simulated second in the windows of
slow loading; the engine's time is that of its whole run up to the failure, cells removed. Times are processor times of
one thread, which are wall times on a machine that does nothing else.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import argparse
import time
from pathlib import Path

import numpy as np
from engine_cost import machine
from numba import njit
from scipy.integrate import ode
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.scenario.loading import load_scenario
from lattice.criteria.laws import combined_tension
from lattice.strain import CellState

FLOE = Path(__file__).parents[2] / "scenarios" / "van_vliet_2018_floe_165m"
RTOL, ATOL = 1e-8, 1e-10
WINDOWS = {
    "slow loading, little contact": (3.0, 0.5),
    "slow loading": (9.0, 0.5),
    "to the first failure": (13.30, 0.2),
    "to the circumferential failure": (25.50, 0.2),
}  #: start, longest [s]
OUTPUT = 0.005  #: interval at which the load and the utilisation are read off VODE [s]


@njit(cache=True)
def add_springs(dof, place, value, live, y, f):
    """f -= K y, spring by spring; a spring touches up to four dof of its cell."""
    for c in range(dof.shape[0]):
        if live[c]:
            for k in range(place.shape[0]):
                e = 0.0
                for i in range(place.shape[1]):
                    e += value[k, i] * y[dof[c, place[k, i]]]
                for i in range(place.shape[1]):
                    f[dof[c, place[k, i]]] -= e * value[k, i]


@njit(cache=True)
def add_contact(t, nodes, x0, y0, width, z0, profile_z, profile_r, law, y, f):
    """The contact law of `coupling.contact` at a cone; law is strength, friction, thickness, velocity, face."""
    strength, mu, h, velocity, side = law
    for k in range(len(nodes)):
        n = 5 * nodes[k]
        z = z0 + y[n + 2]
        p = 0
        while p < len(profile_z) - 2 and z >= profile_z[p + 1]:
            p += 1
        slope = (profile_r[p + 1] - profile_r[p]) / (profile_z[p + 1] - profile_z[p])
        r = profile_r[p] + slope * (z - profile_z[p])
        sin, cos = 1.0 / np.sqrt(1.0 + slope**2), abs(slope) / np.sqrt(1.0 + slope**2)
        nz = -slope * sin
        for s in range(y0.shape[1]):
            across = y0[k, s] + y[n + 1]
            if across**2 < r**2:
                face = -np.sqrt(r**2 - across**2)
                overlap = min(x0[k] + velocity * t + y[n] - face, h * cos / sin)
                if overlap > 0.0:
                    force = strength * width[k] / y0.shape[1] / cos * overlap
                    along = force * (1.0 - mu * side * nz / sin) * sin / r
                    f[n] += along * face
                    f[n + 1] += along * across
                    f[n + 2] += force * (nz + mu * side * (1.0 - nz**2) / sin)


def sparse_rows(rows):
    """Place and value of the entries of a spring table that are not zero, (springs, 4)."""
    place, value = np.zeros((len(rows), 4), np.int64), np.zeros((len(rows), 4))
    for k, row in enumerate(rows):
        at = np.flatnonzero(row)
        place[k, : len(at)], value[k, : len(at)] = at, row[at]
    return place, value


def node_by_node(u, q):
    """(5 n,) from fields of u_x, u_y and w, phi_x, phi_y."""
    return np.hstack((u.reshape(-1, 2), q.reshape(-1, 3))).ravel()


class Floe:
    """y' = (v, (contact - C v - K (x + alpha v) - k_f x) / M), y = (x, v) node by node, for a sheet as it is now."""

    def __init__(self, port):
        sheet, e, c = port.sheet, port.sheet.engine, port.contact
        nodes, self.grid, self.ice, self.alpha = sheet.grid.cell_nodes, sheet.grid, sheet.ice, e.alpha
        self.live, self.limits = sheet.live_cells.copy(), sheet.standing.limit
        self.springs = [
            ((nodes[:, :, None] * 5 + part).reshape(len(nodes), -1), *sparse_rows(rows))
            for part, rows in ((np.arange(2), e.rows_u), (np.arange(2, 5), e.rows_q))
        ]
        self.k_f, self.c = node_by_node(0.0 * e.M_u, e.k_f), node_by_node(0.0 * e.M_u, e.C_q)
        held = np.broadcast_to(sheet.held[:, None], (sheet.grid.nodes, 2)).astype(float)
        self.kick = node_by_node((1.0 - held.ravel()) / e.M_u, 1.0 / e.M_q)
        self.contact, self.calls = c, 0
        law = np.array([c._law.strength, c._law.friction, c._h, c._v, c.face])
        self.touch = (
            c.nodes.copy(),
            c._x.copy(),
            c._sample_y.copy(),
            c._width.copy(),
            c.touching_z,
            np.array(c._s.profile.z),
            np.array(c._s.profile.r),
            law,
        )
        s = sheet.state
        self.start = np.hstack((s.u, s.q, s.u_dot, s.q_dot)).ravel()

    def parts(self, y):
        both = y.reshape(-1, 10)
        return np.ascontiguousarray(both[:, :5]).ravel(), np.ascontiguousarray(both[:, 5:]).ravel()

    def load(self, t, y):
        """Fx of the ice on the structure [N]."""
        x, f = self.parts(y)[0], np.zeros(len(y) // 2)
        add_contact(t, *self.touch, x, f)
        return -f[::5].sum()

    def rate(self, t, y):
        """The right-hand side."""
        self.calls += 1
        x, v = self.parts(y)
        f = -self.k_f * x - self.c * v
        add_contact(t, *self.touch, x, f)
        z = x + self.alpha * v
        for dof, place, value in self.springs:
            add_springs(dof, place, value, self.live, z, f)
        return np.hstack((v.reshape(-1, 5), (f * self.kick).reshape(-1, 5))).ravel()

    def utilisation(self, y):
        """Largest of the live cells."""
        x = self.parts(y)[0].reshape(-1, 5)
        state = CellState.of(self.grid, x[:, :2], x[:, 2:], limit=self.limits)
        return float((combined_tension(state, self.ice) * self.live).max())


def engine_run():
    """This engine up to the circumferential failure: floes at the starts, Fx at window ends, time, failures."""
    scheduler = build(load_scenario(FLOE, ["rubble.enabled=false"]))
    port, floes, loads, failures, cpu = scheduler.sheet, {}, {0.0: 0.0}, {}, 0.0
    starts = {round(start, 3) for start, _ in WINDOWS.values()}
    while "circumferential" not in failures:
        began = time.process_time()
        frame = scheduler.macro_step()
        cpu += time.process_time() - began
        t = round(scheduler.t_ns / 1e9, 3)
        y = np.hstack((port.sheet.state.u, port.sheet.state.q[:, :1]))[port.contact.nodes]
        loads[t] = -port.contact.evaluate(t, y)[0][:, 0].sum()
        for event in frame.events:
            failures.setdefault(event.kind, (event.t_ns / 1e9, event.force[0]))
        if t in starts:
            floes[t] = Floe(port)
            assert abs(floes[t].load(t, floes[t].start) / loads[t] - 1.0) < 1e-9, "not the same contact law"
    return floes, loads, failures, cpu


def vode_run(floe, method, start, longest, budget):
    """Times, loads and utilisation of VODE until a cell reaches its limit, and its processor time."""
    band = {"lband": 10 * (floe.grid.ny + 1) + 9, "uband": 10 * (floe.grid.ny + 1) + 9} if method == "bdf" else {}
    solver = ode(floe.rate).set_integrator("vode", method=method, rtol=RTOL, atol=ATOL, nsteps=10**8, **band)
    solver.set_initial_value(floe.start, start)
    floe.calls, began = 0, time.process_time()
    series = [(start, floe.load(start, floe.start), floe.utilisation(floe.start))]
    while solver.successful() and time.process_time() - began < budget and series[-1][0] < start + longest - 1e-9:
        solver.integrate(series[-1][0] + OUTPUT)
        series.append((solver.t, floe.load(solver.t, solver.y), floe.utilisation(solver.y)))
        if series[-1][2] >= 1.0:
            break
    return np.array(series), time.process_time() - began, solver.successful()


def at_failure(series):
    """Time and load at which the utilisation reaches 1, linear between two outputs; nan without failure."""
    if series[-1, 2] < 1.0 or len(series) < 2:
        return np.nan, np.nan
    a, b = series[-2:]
    return tuple(a[:2] + (1.0 - a[2]) / (b[2] - a[2]) * (b[:2] - a[:2]))


def report(name, method, floe, loads, failures, budget):
    """One line; returns processor time per simulated second."""
    start, longest = WINDOWS[name]
    series, cpu, fine = vode_run(floe, method, start, longest, budget)
    done = series[-1, 0] - start
    common = [(fx, loads[round(t, 3)]) for t, fx, _ in series[1:] if round(t, 3) in loads]
    off = max((abs(a / b - 1.0) for a, b in common), default=np.nan)
    t, fx = at_failure(series)
    kind = "cell_failure" if "first" in name else "circumferential"
    reference = failures[kind] if "failure" in name else (np.nan, np.nan)
    note = "" if fine else ", VODE gave up"
    print(
        f"| {name} | {method} | {done:.3f} | {cpu:.1f} | {floe.calls} | {off:.1e} | {t:.4f} / {reference[0]:.4f} "
        f"| {fx / 1e6:.4f} / {reference[1] / 1e6:.4f}{note} |",
        flush=True,
    )
    if np.isfinite(fx):
        assert abs(fx / reference[1] - 1.0) < 0.01, "failure loads differ by more than 1 %"
    return cpu / done if done > 0.0 else np.inf


def main() -> None:
    """Prints the table and the extrapolated ratio."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--budget", type=float, default=120.0, help="longest processor time of VODE in a window [s]")
    parser.add_argument("--methods", nargs="*", default=("adams", "bdf"))
    options = parser.parse_args()
    with threadpool_limits(1):
        build(load_scenario(FLOE, ["rubble.enabled=false", "sheet.nodes=[16, 16]"])).macro_step()  # compiles
        floes, loads, failures, cpu = engine_run()
        end = failures["circumferential"][0]
        print(f"165 m floe, 60 x 60 nodes, to the circumferential failure. {machine()}\n")
        print(f"This engine: {end:.2f} s in {cpu:.2f} s\n")
        print(
            "| window | VODE | simulated [s] | processor [s] | right-hand sides | load off by "
            "| failure at, VODE / here [s] | Fx then, VODE / here [MN] |\n|---|---|---|---|---|---|---|---|"
        )
        for method in options.methods:
            pace = {
                name: report(name, method, floes[WINDOWS[name][0]], loads, failures, options.budget) for name in WINDOWS
            }
            slow = [pace[name] for name in WINDOWS if "slow" in name]
            print(
                f"\n{method}: {min(slow):.0f} to {max(slow):.0f} s per simulated second in slow "
                f"loading; extrapolated to {end:.1f} s: {min(slow) * end / 60:.1f} to {max(slow) * end / 60:.1f} "
                f"min, {min(slow) * end / cpu:.0f} to {max(slow) * end / cpu:.0f} times this engine\n"
            )


if __name__ == "__main__":
    main()
