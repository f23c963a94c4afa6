"""Case `pressed-edge`: what a sheet carries that is pressed down at its edge must not know of its lattice.

A square sheet on water, held in its plane on three sides, is pressed down by a soft indenter that spreads its load over
a half-disk of fixed size. Cracks open, close and turn into hinges; the largest load is compared between meshes, and
with a lattice that is turned by 45 degrees, whose edge is a staircase of nodes. The load at which a first cell begins
to crack is compared too: under a load of fixed size it does not fall as cells get smaller.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cosim.verify.case import CaseResult, Figure, near, value
from lattice.cracks.beam import Beam, layer_strength
from lattice.cracks.engine import SLOW, CrackingEngine
from lattice.cracks.law import law_of
from lattice.explicit.forces import NOTHING, indenter
from lattice.explicit.layout import W
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import hrennikoff

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "nu": 1.0 / 3.0,
    "h": 3.0,
    "length": 112.0,
    "radius": 10.0,
    "beam": [18.0, 6.0, 375.0e3],
    "fracture_energy": 300.0,
    "sigma_c": 4.0e6,
    "stiffness": 30.0e6,
    "way": 1.8,
    "seconds": 18.0,
    "d": [4.0, 2.8, 2.0],
    "turned": 2.8,
}
MU = 0.3
SOURCE = "mean over the meshes"


class Pressed(NamedTuple):
    """A sheet that is pressed down at its edge."""

    w: Array  #: deflection under the indenter, mean over its area [m]
    force: Array  #: [N]
    first: float  #: force at which a first cell begins to crack [N]
    strength: float  #: of the layers [Pa]

    @property
    def peak(self) -> float:
        """Largest force [N]."""
        return float(self.force.max())


class Laid(NamedTuple):
    """A square sheet on a lattice."""

    grid: Grid
    live: BoolArray  #: (cells,) that belong to the sheet
    held: BoolArray  #: (nodes,) on the three sides that hold it
    share: Array  #: (nodes,) of the indenter's load


def laid(p: dict[str, Any], d: float, turned: bool) -> Laid:
    """The sheet, x from its free edge inwards, y along it; a ``turned`` one is cut out of a larger lattice."""
    L, c = p["length"], np.sqrt(0.5)
    n = round(L / d)
    if turned:
        m = 2 * int(np.ceil(0.5 * np.sqrt(2.0) * L / d)) + 4
        grid = Grid(m + 1, m + 1, d, -0.5 * m * d, -0.5 * m * d)
        row = c * d  # between rows of cells; the teeth of the edge lie evenly about x = 0
        x = c * (grid.xy[:, 0] + grid.xy[:, 1]) + (round(0.5 * L / row - 0.5) + 0.5) * row
        y = c * (grid.xy[:, 1] - grid.xy[:, 0])
    else:
        grid = Grid(n + 1, n + 1, L / n, 0.0, -0.5 * L)
        x, y = grid.xy.T
    middle_x, middle_y = x[grid.cell_nodes].mean(axis=1), y[grid.cell_nodes].mean(axis=1)
    live = (middle_x > 0.0) & (middle_x < L) & (np.abs(middle_y) < 0.5 * L)
    area = np.bincount(grid.cell_nodes[live].ravel(), minlength=grid.nodes).astype(float)
    near_side = grid.d if turned else 1e-6 * d
    held = (area > 0.0) & ((x > L - near_side) | (np.abs(y) > 0.5 * L - near_side))
    share = area * np.clip(0.5 + (p["radius"] - np.hypot(x, y)) / d, 0.0, 1.0)  # a rim of one cell
    return Laid(grid, live, held, share / share.sum())


def ice_of(p: dict[str, Any], d: float) -> Ice:
    """Ice whose layers have the strength with which the simulated beam, in cells of size d, breaks at its load."""
    beam = Beam(*p["beam"])
    ice = Ice(E=p["E"], nu=p["nu"], h=p["h"], rho_i=846.0, rho_w=1006.0, sigma_c=p["sigma_c"])
    strength = layer_strength(ice, MU, p["fracture_energy"], beam, d)
    return replace(ice, sigma_t=strength, sigma_f=strength)


def pressed(p: dict[str, Any], d: float, *, turned: bool = False) -> Pressed:
    """Down by the way of the indenter, at a steady speed."""
    sheet = laid(p, d, turned)
    g, live, blocks = sheet.grid, sheet.live.copy(), 360
    ice = ice_of(p, g.d)
    law, damping = law_of(ice, p["fracture_energy"], MU, g.d), 0.1 * np.sqrt(ice.k_f * ice.rho_i * ice.h)
    e = CrackingEngine(g, ice, hrennikoff(ice), p["seconds"] / blocks, law=law, held_in_plane=sheet.held,
                       damping=float(damping), alpha=1e-4, sub_steps=SLOW)  # fmt: skip
    everything = np.ones(g.nodes, bool)
    e.set_cells(live, np.full(g.cells, ice.sigma_t), everything)
    e.start(State.rest(g.nodes), everything, ())
    tip = np.flatnonzero(sheet.share)
    touch = indenter(tip, g.ny, p["stiffness"] * sheet.share[tip])
    w, force, first = [], [], np.nan
    for block in range(blocks):
        touch.at[:, W] = -p["way"] * (block + 0.5) / blocks
        done, impulse = 0, 0.0
        while done < e.sub_steps:
            made = e.march(e.sub_steps - done, NOTHING, touch, lively=False)
            done, impulse = done + made.steps, impulse - made.steps * float(made.contact[:, W].sum())
            if made.failed:
                first = first if np.isfinite(first) else -float(made.contact[:, W].sum())
                e.crack(live)
        w.append(-float(sheet.share[tip] @ e.displacement()[1][tip, 0]))
        force.append(impulse / done)
    mean = np.convolve(force, np.full(10, 0.1), "valid")  # over half a second
    return Pressed(np.convolve(w, np.full(10, 0.1), "valid"), mean, first, ice.sigma_t)


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """All meshes and the turned lattice; ``quick``: a smaller sheet on coarser meshes."""
    if quick:
        p = {**p, "length": 84.0, "d": [4.0, 3.4], "turned": 4.0, "way": 1.2, "seconds": 12.0}
    straight, turned = [pressed(p, d) for d in p["d"]], pressed(p, p["turned"], turned=True)
    beside = straight[list(p["d"]).index(p["turned"])]
    peaks, all_four = np.array([each.peak for each in straight]), (*straight, turned)
    first = np.array([each.first / (each.strength * p["h"] ** 2) for each in all_four])
    mean, finer = np.full(len(first), first.mean()), peaks[-2:]
    return CaseResult(
        "pressed-edge",
        p,
        [
            value("cell size", p["d"], "m"),
            value("strength of the layers", [each.strength for each in all_four], "Pa"),
            value("largest load", peaks, "N"),
            near("largest load, the two finer meshes", finer, "N", np.full(2, finer.mean()), 0.08, "their mean"),
            near("largest load, lattice turned by 45 deg", turned.peak, "N", beside.peak, 0.10, "lattice not turned"),
            near("load at which a first cell begins to crack, over strength h^2", first, "-", mean, 0.05, SOURCE),
        ],
        [_figure(p, straight, turned)],
    )


def _figure(p: dict[str, Any], straight: list[Pressed], turned: Pressed) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for d, each in zip(p["d"], straight, strict=True):
            axes.plot(each.w, 1e-6 * each.force, label=f"cells of {d:g} m")
        axes.plot(turned.w, 1e-6 * turned.force, "k--", label=f"cells of {p['turned']:g} m, turned by 45 degrees")
        axes.set(xlabel="deflection under the load [m]", ylabel="load [MN]", ylim=(0, None))
        axes.legend()

    return Figure("load", "A sheet that is pressed down at its edge", draw)
