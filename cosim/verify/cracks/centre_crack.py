"""Case `centre-crack`: a sheet with a crack through its middle along the drift, loaded at the middle of its edge.

Three sheets: intact; cut in two by a crack that carries nothing; and cut by a crack that closes. Pushed down, the two
halves turn about the crack, which closes at its top; where the sides hold the sheet in its plane the crack is pressed
together and carries a moment again (compressive membrane action, Rankin and Long 1997; part-through radial cracks in
ice, Bazant and Kim 1998). What counts is the force at a given deflection of the loaded edge, which must not depend on
the mesh, and the force at which a first cell beside the crack begins to fail, by two criteria and two strengths.
The last is the stress beside a load, and rises with refinement as stresses beside loads do: it is shown, not judged.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, at_most, near, value
from lattice.cracks.engine import SLOW, CrackingEngine
from lattice.cracks.law import CrackLaw, N
from lattice.criteria.table import CRITERIA
from lattice.explicit.forces import NOTHING, indenter
from lattice.explicit.layout import W
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import hrennikoff
from lattice.strain import CellState

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "nu": 1.0 / 3.0,
    "h": 3.0,
    "length": 165.0,
    "sigma_c": 4.0e6,
    "w": 0.3,
    "width": 16.8,
    "nodes": [40, 60, 80],
    "strength": [750.0e3, 967.0e3],
    "sides": "held",
}
CRACKS = ("intact", "open", "closing")
JUDGES = ("principal-stress", "combined-tension")
SECONDS, LOOKS = 12.0, 60  #: time to the deflection of the case [s]; looks at the criteria on the way


class Pushed(NamedTuple):
    """A sheet that is pushed down at its edge."""

    w: Array  #: (looks,) deflection of the loaded nodes [m]
    force: Array  #: (looks,) [N]
    use: Array  #: (looks, judges, strengths) largest utilisation of the elastic cells


def engine_of(p: dict[str, Any], nodes: int, crack: str) -> tuple[CrackingEngine, BoolArray]:
    """The sheet at rest with its crack, and its elastic cells."""
    grid = Grid.rectangle(p["length"], p["length"], nodes, nodes, 0.0, -0.5 * p["length"])
    ice = ice_of(p, p["strength"][0])
    held = np.zeros(grid.nodes, bool)
    for side in ("x+", "y-", "y+") if p["sides"] == "held" else ("x+",):
        held[grid.edge_nodes(side)] = True
    e_0 = p["strength"][0] / p["E"]
    law = CrackLaw(E=p["E"], nu=p["nu"], sigma_c=p["sigma_c"], cohesion=700e3, mu=0.3, e_0=e_0, e_f=e_0)
    damping = 0.5 * np.sqrt(ice.k_f * ice.rho_i * ice.h)  # waves of the push die out within it
    e = CrackingEngine(grid, ice, hrennikoff(ice), SECONDS / LOOKS, law=law, held_in_plane=held, damping=float(damping),
                       alpha=1e-4, sub_steps=SLOW)  # fmt: skip
    live, on = np.ones((nodes - 1, nodes - 1), bool), np.ones(grid.nodes, bool)
    if crack != "intact":
        live[:, (nodes - 1) // 2] = False
    e.set_cells(live.ravel(), np.full(grid.cells, np.inf), on)
    e.start(State.rest(grid.nodes), on, ())
    if crack == "closing":
        for cell in np.flatnonzero(~live.ravel()):
            e.begin(int(cell), 0.5 * np.pi)
        e.layered.view().cells.damage[: e.layered.count, :, N] = 1.0
    return e, live.ravel()


def ice_of(p: dict[str, Any], strength: float) -> Ice:
    """Ice of one strength in tension and bending [Pa]."""
    return Ice(E=p["E"], nu=p["nu"], h=p["h"], rho_i=846.0, rho_w=1006.0, sigma_t=strength, sigma_f=strength,
               sigma_c=p["sigma_c"])  # fmt: skip


def pushed(p: dict[str, Any], nodes: int, crack: str) -> Pushed:
    """Down to the deflection of the case at a steady speed."""
    e, live = engine_of(p, nodes, crack)
    g = e.grid
    tip = np.flatnonzero((g.xy[:, 0] == 0.0) & (np.abs(g.xy[:, 1]) < 0.5 * p["width"]))
    spring = 0.1 * float(e.inertia_q[3 * tip].min()) / e.dt**2
    touch, blocks = indenter(tip, g.ny, spring), 4
    cells, ices = np.flatnonzero(live), [ice_of(p, s) for s in p["strength"]]
    w, force, use = [0.0], [0.0], [np.zeros((len(JUDGES), len(ices)))]
    for look in range(LOOKS):
        total = 0.0
        for part in range(blocks):
            touch.at[:, W] = -p["w"] * (look + (part + 0.5) / blocks) / LOOKS
            total -= float(e.march(e.sub_steps // blocks, NOTHING, touch, lively=False).contact[:, W].sum())
        state = CellState.of(g, *e.displacement(), cells, lean=e.lean_strain()[:, cells])
        w.append(-float(e.displacement()[1][tip, 0].mean()))
        force.append(total / blocks)
        use.append(np.array([[float(CRITERIA[j].judge(state, ice).max()) for ice in ices] for j in JUDGES]))
    return Pushed(np.array(w), np.array(force), np.array(use))


def at_first_failure(found: Pushed) -> Array:
    """Force at which the utilisation reaches 1, (judges, strengths) [N]; in proportion where it did not get so far."""
    out = np.empty(found.use.shape[1:])
    for index in np.ndindex(*out.shape):
        use = np.maximum.accumulate(found.use[(slice(None), *index)])
        out[index] = np.interp(1.0, use, found.force) if use[-1] >= 1.0 else found.force[-1] / use[-1]
    return out


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """All sheets on all meshes; ``quick``: the first mesh alone, which has no other to be compared with."""
    if p["sides"] not in ("held", "free"):
        raise ValueError(f"sides = {p['sides']!r}: held or free")
    meshes = [int(n) for n in p["nodes"]][: 1 if quick else None]
    if any(n % 2 for n in meshes):
        raise ValueError(f"nodes = {meshes}: use even numbers, so that a row of cells lies in the middle")
    found = {crack: [pushed(p, n, crack) for n in meshes] for crack in CRACKS}
    load = {crack: np.array([np.interp(0.95 * p["w"], f.w, f.force) for f in found[crack]]) for crack in CRACKS}
    share = (load["closing"] - load["open"]) / (load["intact"] - load["open"])
    name = "force at 95 % of the deflection"
    quantities: list[Quantity] = [value("nodes", meshes, "-")]
    for crack in CRACKS:
        finest = np.full(len(meshes), load[crack][-1])
        quantities.append(near(f"{name}, {crack}", load[crack], "N", finest, 0.15, "finest mesh"))
    order = float(
        np.maximum(load["open"] - load["closing"], load["closing"] - load["intact"]).max() / load["intact"][0]
    )
    quantities += [
        at_most("open below closing below intact, by how much not", max(order, 0.0), "-", 0.0, "unilateral contact"),
        value("share of what the open crack lost that the closing one carries", share, "-"),
    ]
    for crack in CRACKS:
        first = np.array([at_first_failure(f) for f in found[crack]])
        for j, judge in enumerate(JUDGES):
            quantities.append(value(f"force at first failure by {judge}, {crack}", first[:, j], "N"))
    return CaseResult("centre-crack", p, quantities, [_figure(found)])


def _figure(found: dict[str, list[Pushed]]) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for crack, runs in found.items():
            for f, style in zip(runs, (":", "--", "-"), strict=False):
                axes.plot(f.w, 1e-6 * f.force, style, label=crack)
        axes.set(xlabel="deflection of the loaded edge [m]", ylabel="force [MN]")
        axes.legend()

    return Figure("force", "Sheet with a crack through its middle, loaded at its edge", draw)
