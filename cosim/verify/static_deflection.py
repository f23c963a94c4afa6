"""Figure 2-15: deflected shape of the simply supported plate on water under a static point load."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse.linalg import splu

from cosim.verify.case import CaseResult, Figure, limited, value
from cosim.verify.plate import TABLE_2_1, ice_of, load_node, plate_of
from cosim.verify.settings import meshes
from lattice import continuum
from lattice.grid import Array

PARAMETERS: dict[str, Any] = {**TABLE_2_1, "nodes": [31, 51], "load": [20.0, 50.0], "F": 10.0e3}


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Deflection under the load, lattice and plate."""
    plate = plate_of(p, meshes(p["nodes"])[0])
    node, grid = load_node(p, plate.grid), plate.grid
    force = np.zeros(len(plate.dof))
    force[plate.position(node, 0)] = p["F"]
    q = np.zeros(3 * grid.nodes)
    q[plate.dof] = splu(plate.stiffness).solve(force)
    w = q[::3]
    exact = p["F"] * continuum.navier(ice_of(p), (p["Lx"], p["Ly"]), tuple(p["load"]), grid.xy, 0.0)[0, :, 0].real
    far = np.hypot(*(grid.xy - p["load"]).T) > 2.0 * p["h"]
    error = float(np.abs(w - exact)[far].max() / np.abs(exact).max())
    known = p == PARAMETERS
    at_load = float(w[node] / exact[node] - 1.0)
    source = "Navier solution, van Vliet (2018), Appendix 1 and Figure 2-15"
    quantities = [
        limited("largest difference of w beyond 2 h from the load over the largest w", error, "-", 0.01, source, known),
        limited("difference of w at the load, part of w", at_load, "-", 0.02, source, known),
        value("deflection at the load, lattice", w[node], "m"),
        value("deflection at the load, Navier", exact[node], "m"),
        value("deflection along x at the load, lattice", _line(w, grid, p), "m"),
        value("deflection along x at the load, Navier", _line(exact, grid, p), "m"),
    ]
    return CaseResult("static-deflection", p, quantities, [_figure(grid, w, exact)])


def _line(w: Array, grid: Any, p: dict[str, Any]) -> Array:
    return w.reshape(grid.nx, grid.ny)[:, round(p["load"][1] / grid.d)]


def _figure(grid: Any, w: Array, exact: Array) -> Figure:
    def draw(figure: Any) -> None:
        x, y = (column.reshape(grid.nx, grid.ny) for column in grid.xy.T)
        for place, (name, field) in enumerate((("lattice", w), ("continuum", exact)), 1):
            axes = figure.add_subplot(1, 2, place, projection="3d")
            axes.plot_surface(x, y, -1e3 * field.reshape(x.shape), cmap="viridis", rstride=1, cstride=1)
            axes.set(title=name, xlabel="x [m]", ylabel="y [m]", zlabel="- w [mm]", box_aspect=(60, 100, 50))

    return Figure("figure_2-15", "Figure 2-15: static deflection under the point load", draw)
