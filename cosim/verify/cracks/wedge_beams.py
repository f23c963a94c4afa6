"""Case `wedge-beams`: a wedge of the sheet on water, loaded at its rim, bears in proportion to its angle.

A wedge between two radial cracks that carry nothing is a beam whose width b = 2 psi r grows with the distance from the
apex: (E h^3 / 12 b w'')'' + k b w = 0, load F at the rim r = a where it has no moment, rest far away (Nevel 1961, "The
narrow free infinite wedge on an elastic foundation", CRREL research report 79; 1972). Every term is proportional to
psi, so is the load at which the largest bending stress reaches the strength. The ODE is solved by collocation.

The lattice has the cells whose middle is in a wedge with a straight rim, of width 2 tan(psi) x; its flanks are
staircases and two-dimensional stiffness makes it a plate. So the beam's measure is taken first, the moment summed over
the width; and beside it the load at which a first cell reaches the strength, which the corners of the staircase lower
in narrow wedges, and the moment along the rim in wide ones: those are no beams any more.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_bvp

from cosim.verify.case import CaseResult, Figure, near, value
from lattice.cracks.begin import face_stresses
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.statics import out_of_plane_stiffness, solve
from lattice.stiffness import hrennikoff
from lattice.strain import CellState

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "nu": 1.0 / 3.0,
    "h": 3.0,
    "a": 15.0,
    "strength": 750.0e3,
    "psi": [30.0, 45.0, 60.0, 75.0, 90.0],
    "lattice": [5.0, 10.0, 20.0, 30.0],
    "d": 1.5,
}
KNOWN = [2.4e6, 3.7e6, 4.9e6, 6.1e6, 7.3e6]  #: at the half-angles of the case [N]
FAR = 6.0  #: end of the wedge behind its rim, in characteristic lengths
SOURCE = "Nevel (1961), wedge as a beam of growing width"


def ice_of(p: dict[str, Any]) -> Ice:
    """Ice of the case."""
    return Ice(E=p["E"], nu=p["nu"], h=p["h"], rho_i=846.0, rho_w=1006.0)


def stress_of_beam(p: dict[str, Any]) -> tuple[Array, Array]:
    """Distance from the apex [m] and bending stress per load and half-angle [Pa rad/N] of the wedge as a beam."""
    ice = ice_of(p)
    EI, k, a = ice.E * ice.h**3 / 12.0, ice.k_f, p["a"]

    def slope(r: Array, y: Array) -> Array:  # w, w', M, Q of half-angle 1
        w, turn, M, Q = y
        return np.array([turn, M / (EI * 2.0 * r), Q, -k * 2.0 * r * w])

    def ends(rim: Array, far: Array) -> Array:  # no moment and unit force at the rim, rest far away
        return np.array([rim[2], rim[3] - 1.0, far[0], far[1]])

    r = np.linspace(a, a + FAR * ice.l_c, 400)
    found = solve_bvp(slope, ends, r, np.zeros((4, len(r))), tol=1e-8, max_nodes=20000)
    if not found.success:
        raise ValueError(f"the wedge beam was not solved: {found.message}")
    M = found.sol(r)[2]
    return r, 6.0 * np.abs(M) / (2.0 * r * ice.h**2)


def wedge_of_lattice(p: dict[str, Any], degrees: float) -> tuple[Grid, BoolArray, float]:
    """Grid from the rim x = a on, cells whose middle is in the wedge, and tan(psi) by their area."""
    ice, d, slope = ice_of(p), p["d"], float(np.tan(np.radians(degrees)))
    along = int(FAR * ice.l_c / d)
    half = int(np.ceil((p["a"] + along * d) * slope / d)) + 1
    grid = Grid(along + 1, 2 * half + 1, d, p["a"], -half * d)
    x, y = grid.xy[grid.cell_nodes].mean(axis=1).T
    live = np.abs(y) < slope * x
    return grid, live, float(live.sum()) * d**2 / ((p["a"] + along * d) ** 2 - p["a"] ** 2)


def loads_of_lattice(p: dict[str, Any], degrees: float) -> tuple[float, float, float]:
    """Loads at which the mean stress over the width, and that of a first cell, reach the strength [N]; tan(psi)."""
    ice = ice_of(p)
    grid, live, slope = wedge_of_lattice(p, degrees)
    rim = np.intersect1d(grid.edge_nodes("x-"), grid.cell_nodes[live])
    load = np.zeros(3 * grid.nodes)
    load[3 * rim] = -1.0 / len(rim)
    K = out_of_plane_stiffness(grid, ice, hrennikoff(ice), live)
    q = solve(K, load, np.empty(0, np.int64)).reshape(-1, 3)
    state = CellState.of(grid, np.zeros((grid.nodes, 2)), q)
    stress, curvature = face_stresses(state, ice)[0][live], state.strains
    across = ice.E / (1.0 - ice.nu**2) * 0.5 * ice.h * (curvature.k11 + ice.nu * curvature.k22) * live
    x = p["a"] + (np.arange(grid.nx - 1) + 0.5) * grid.d
    mean = across.reshape(grid.nx - 1, -1).sum(axis=1) * grid.d / (2.0 * slope * x)
    return p["strength"] / float(np.abs(mean).max()), p["strength"] / float(stress.max()), slope


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Loads of wedge beams of all angles, and of wedges of the lattice; ``quick``: cells twice as large."""
    if quick:
        p = {**p, "d": 2.0 * p["d"], "lattice": p["lattice"][1:3]}
    r, stress = stress_of_beam(p)
    per_angle = p["strength"] / float(stress.max())  # [N/rad]
    angles = np.radians(p["psi"])
    known = {k: v for k, v in p.items() if k not in ("d", "lattice")} == {
        k: v for k, v in PARAMETERS.items() if k not in ("d", "lattice")
    }
    lattice, first, slope = np.array([loads_of_lattice(p, degrees) for degrees in p["lattice"]]).T
    return CaseResult(
        "wedge-beams",
        p,
        [
            near("load of wedge beams", per_angle * angles, "N", KNOWN if known else None, 0.02, "plate model, Nevel"),
            value("distance from the apex at which the wedge beam breaks", r[np.argmax(stress)], "m"),
            value("half-angle of the lattice's wedges", np.degrees(np.arctan(slope)), "deg"),
            near(
                "load of the lattice's wedges, mean stress over the width",
                lattice,
                "N",
                per_angle * slope,
                0.05,
                SOURCE,
            ),
            value("load of the lattice's wedges at their first failure", first, "N"),
        ],
        [_figure(p, per_angle, np.stack((slope, lattice, first)))],
    )


def _figure(p: dict[str, Any], per_angle: float, wedges: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        end = max(p["psi"])
        axes.plot([0.0, end], [0.0, 1e-6 * per_angle * np.radians(end)], "k-", label="beam of growing width")
        slope, mean, first = wedges
        axes.plot(
            np.degrees(slope),
            1e-6 * mean,
            "o",
            mfc="none",
            label="lattice, mean stress over the width",
        )
        axes.plot(np.degrees(slope), 1e-6 * first, "x", label="lattice, first cell")
        axes.set(xlabel="half-angle; of the lattice, with a straight rim, its tangent [degrees]", ylabel="load [MN]")
        axes.legend()

    return Figure("load", "Load of a wedge of the sheet at its rim", draw)
