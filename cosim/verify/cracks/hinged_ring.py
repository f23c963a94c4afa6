"""Case `hinged-ring`: a segment of the sheet, hinged at its back and pushed down at its tip, lifts the sheet behind it.

A rigid segment between the rim r = a and the hinge r = a + L, of half-angle psi, turns about the hinge. Water presses
on it with k w (1 - (r - a) / L), w the deflection of the tip. Moments about the hinge and the vertical sum give

    F_tip = 2 psi k w (a L / 3 + L^2 / 12),        F_hinge = 2 psi k w (a L / 6 + L^2 / 12),

the latter upwards on the sheet. On the lattice: the nodes of a sector with straight rim and hinge (2 tan(psi) in place
of 2 psi), a sheet behind it that is held far away, and between the two one row of cells that carry shear and no
moment. A crack of our law cannot be this hinge: what carries its shear is friction under thrust, and thrust has an arm.
The ice is made stiff, so that nothing bends; with the elastic ice of the case it gives way by the share that is shown.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp

from cosim.verify.case import CaseResult, Figure, near, value
from lattice.assembly import assemble, out_of_plane_springs
from lattice.grid import Array, BoolArray, Grid
from lattice.ice import Ice
from lattice.statics import solve
from lattice.stiffness import hrennikoff

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "nu": 1.0 / 3.0,
    "h": 3.0,
    "a": 15.0,
    "L": [10.0, 20.0, 30.0],
    "psi": 20.0,
    "w": 0.5,
    "d": 1.0,
    "stiff": 1.0e5,
    "sheet": 40.0,
}
SOURCE = "statics of a rigid segment on water"


class Segment(NamedTuple):
    """A segment and the sheet behind it."""

    grid: Grid
    piece: BoolArray  #: (nodes,)
    sheet: BoolArray  #: (nodes,)


def segment(p: dict[str, Any], L: float) -> Segment:
    """Nodes in the middle of their areas: x = a + d/2 ... in the piece; the sheet begins at a + L."""
    d, half_angle = p["d"], np.tan(np.radians(p["psi"]))
    along, behind = round(L / d), round(p["sheet"] / d)
    half = int(np.ceil(half_angle * (p["a"] + L) / d)) + 5
    grid = Grid(along + behind, 2 * half, d, p["a"] + 0.5 * d, -(half - 0.5) * d)
    x, y = grid.xy.T
    sheet = x > p["a"] + L
    return Segment(grid, ~sheet & (np.abs(y) < half_angle * x), sheet)


def forces(p: dict[str, Any], L: float, E: float) -> tuple[float, float]:
    """Force down on the tip for the deflection w [N], force up on the sheet through the hinge [N]."""
    ice = Ice(E=E, nu=p["nu"], h=p["h"], rho_i=846.0, rho_w=1006.0)
    grid, piece, sheet = segment(p, L)
    springs, corners = hrennikoff(ice), grid.cell_nodes
    whole = piece[corners].all(axis=1) | sheet[corners].all(axis=1)
    hinge = ~whole & (piece | sheet)[corners].all(axis=1)
    no_moment = replace(springs, G_r_axi=0.0, G_t_axi=0.0, G_dia=0.0)
    through = assemble(grid, out_of_plane_springs(no_moment, grid.d), np.asarray(hinge))
    K = assemble(grid, out_of_plane_springs(springs, grid.d), np.asarray(whole)) + through
    water = np.zeros(3 * grid.nodes)
    water[::3] = np.where(piece | sheet, ice.k_f * grid.d**2, 0.0)
    held = 3 * np.flatnonzero(sheet & (grid.xy[:, 0] > grid.xy[:, 0].max() - 0.5 * grid.d))
    tip = np.flatnonzero(piece & (grid.xy[:, 0] < p["a"] + grid.d))
    load = np.zeros(3 * grid.nodes)
    load[3 * tip] = -1.0 / len(tip)
    load[3 * tip + 1] = 0.5 * grid.d * load[3 * tip]  # at the rim, half a cell ahead of the nodes
    q = solve((K + sp.diags(water)).tocsc(), load, np.concatenate((held, held + 1, held + 2)))
    rim = -float((q[3 * tip] + 0.5 * grid.d * q[3 * tip + 1]).mean())
    up = -float((through @ q)[::3][sheet].sum())
    return p["w"] / rim, up * p["w"] / rim


def exact(p: dict[str, Any], L: float) -> Array:
    """Both forces of the rigid segment [N]."""
    scale = 2.0 * np.tan(np.radians(p["psi"])) * 1006.0 * 9.81 * p["w"]
    both: Array = scale * np.array([p["a"] * L / 3.0 + L**2 / 12.0, p["a"] * L / 6.0 + L**2 / 12.0])
    return both


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Stiff and elastic segments; ``quick``: the first two lengths."""
    lengths = p["L"][:2] if quick else p["L"]
    tip, hinge = np.array([forces(p, L, p["E"] * p["stiff"]) for L in lengths]).T
    soft_tip, soft_hinge = np.array([forces(p, L, p["E"]) for L in lengths]).T
    F_tip, F_hinge = np.array([exact(p, L) for L in lengths]).T
    return CaseResult(
        "hinged-ring",
        p,
        [
            value("length of the segment", lengths, "m"),
            near("force at the tip", tip, "N", F_tip, 0.03, SOURCE),
            near("force that lifts the sheet", hinge, "N", F_hinge, 0.03, SOURCE),
            value("force at the tip over that of the rigid segment, elastic ice", soft_tip / F_tip, "-"),
            value("force that lifts the sheet over that of the rigid segment, elastic ice", soft_hinge / F_hinge, "-"),
        ],
        [_figure(p, np.array(lengths), tip, hinge)],
    )


def _figure(p: dict[str, Any], lengths: Array, tip: Array, hinge: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        L = np.linspace(0.0, 1.1 * lengths.max(), 100)
        F_tip, F_hinge = np.array([exact(p, x) for x in L]).T
        axes.plot(L, 1e-6 * F_tip, "k-", label="tip")
        axes.plot(L, 1e-6 * F_hinge, "k--", label="hinge, upwards on the sheet")
        axes.plot(lengths, 1e-6 * tip, "o", lengths, 1e-6 * hinge, "s", mfc="none")
        axes.set(xlabel="length of the segment [m]", ylabel="force [MN]")
        axes.legend()

    return Figure("force", "A hinged segment pushed down at its tip", draw)
