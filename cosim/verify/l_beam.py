"""Table 5-1 and Figures 5-2 to 5-4: L-shaped beam under bending, torsion and shear.

Figure 5-1 is read with clear lengths (inner edges): only then every cell of the first row is beyond its strength, as
section 5.2 reports. The thesis gives neither sigma_c nor the mesh: sigma_c = 5 sigma_f as in Table 4-2, d = 0.05 m.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, limited, near, value
from lattice.criteria.laws import bending_bottom, bending_top, out_of_plane_shear
from lattice.grid import Array
from lattice.ice import Ice
from lattice.specimens import Piece, l_beam
from lattice.strain import CellState

PARAMETERS: dict[str, Any] = {
    "L_1": 1.05,
    "L_2": 1.95,
    "width": 0.55,
    "h": 0.565,
    "F": 6.0e3,
    "E": 1.4e9,
    "nu": 0.3,
    "sigma_f": 0.339e6,
    "sigma_shear": 0.7e6,
    "ratio": 5.0,
    "rho_i": 920.0,
    "rho_w": 1025.0,
    "d": 0.05,
    "margin": 1.5,
}
SOURCE = "van Vliet (2018), sections 5.2 and 5.3"


def utilisation(state: CellState, ice: Ice) -> Array:
    """Left side of (5.1): the worse of top and bottom."""
    return np.maximum(bending_top(state, ice), bending_bottom(state, ice))


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """States of the first row under the three loads, and which cells are beyond their strength."""
    ice = Ice(
        E=p["E"],
        nu=p["nu"],
        h=p["h"],
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        sigma_t=p["sigma_f"],
        sigma_f=p["sigma_f"],
        sigma_c=p["ratio"] * p["sigma_f"],
        sigma_shear=p["sigma_shear"],
    )
    known = p == PARAMETERS
    piece = l_beam(ice, p["L_1"], p["L_2"], p["width"], p["d"], p["margin"])
    q = p["F"] * piece.deflection()
    rows = [piece.row_state(q, row) for row in range(3)]
    bending = np.array([utilisation(state, ice) for state in rows])
    shear = np.array([out_of_plane_shear(state, ice) for state in rows])
    field = _field(piece, q, ice)
    quantities = [
        *_place(p, piece, field, known),
        *_rows(bending, shear, known),
        value("deflection of the free end", -float(q[piece.tip, 0].mean()), "m"),
        value("place along the root, from its centre", _across(p, bending.shape[1]), "m"),
        value("bending utilisation (5.1), rows 1 to 3", bending, "-"),
        value("shear over shear strength, rows 1 to 3", shear, "-"),
    ]
    x = _across(p, bending.shape[1])
    return CaseResult(
        "l-beam",
        p,
        quantities,
        [
            _figure_2(piece, q, field),
            _figure("figure_5-3", "Figure 5-3: bending utilisation (5.1)", x, bending),
            _figure("figure_5-4", "Figure 5-4: out-of-plane shear over the shear strength", x, shear),
        ],
    )


def _across(p: dict[str, Any], cells: int) -> Array:
    """Centres of the cells across the root; positive on the side to which the L turns [m]."""
    return np.asarray((np.arange(cells) + 0.5) * p["d"] - 0.5 * p["width"])


def _field(piece: Piece, q: Array, ice: Ice) -> Array:
    """Utilisation of all intact cells, nan where cut, (nx - 1, ny - 1)."""
    state = CellState.of(piece.grid, np.zeros((piece.grid.nodes, 2)), q)
    return np.where(piece.intact, utilisation(state, ice).reshape(piece.intact.shape), np.nan)


def _place(p: dict[str, Any], piece: Piece, field: Array, known: bool) -> list[Quantity]:
    """Where the highest value lies, from the root and from its centre line; the inner corner of the L is expected."""
    i, j = np.unravel_index(np.nanargmax(field), field.shape)
    column, first, count = piece.root
    place = [(i + 0.5 - column) * p["d"], (j + 0.5 - first - 0.5 * count) * p["d"]]
    corner = [p["L_1"], 0.5 * p["width"]]
    pattern = f"{SOURCE}: inner corner of the L (crack pattern 2)"
    return [
        near(
            "place of the highest bending utilisation: from the root, to the side",
            place,
            "m",
            corner if known else None,
            1.01 * p["d"],
            pattern,
            "absolute",
        ),
        value("highest bending utilisation", float(np.nanmax(field)), "-"),
    ]


def _rows(bending: Array, shear: Array, known: bool) -> list[Quantity]:
    first = float(1.0 / bending[0].min())
    side_a = float(np.argmax(bending[0]))
    quiet = "inverse of the smallest utilisation in the first row (every cell beyond its strength: below 1)"
    return [
        limited(quiet, first, "-", 1.0, SOURCE, known),
        near(
            "cell of the first row with the highest utilisation (corner A, outer side: 0)",
            side_a,
            "-",
            0.0 if known else None,
            0.0,
            SOURCE,
            "absolute",
        ),
        value("largest shear over shear strength in the three rows", float(shear.max()), "-"),
    ]


def _figure(name: str, title: str, x: Array, rows: Array) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for i, row in enumerate(rows, 1):
            axes.plot(x, row, "o-", label=f"row {i}")
        axes.set(xlabel="x from the centre of the root [m]", ylabel="utilisation [-]", ylim=(0, None))
        axes.legend()

    return Figure(name, title, draw)


def _figure_2(piece: Piece, q: Array, field: Array) -> Figure:
    def draw(figure: Any) -> None:
        deflection, strain = figure.subplots(1, 2)
        grid = piece.grid
        w = -1e3 * q[:, 0].reshape(grid.nx, grid.ny)[:-1, :-1]
        for axes, values, label in (
            (deflection, np.where(piece.intact, w, np.nan), "deflection downwards [mm]"),
            (strain, field, "bending utilisation (5.1) [-]"),
        ):
            image = axes.imshow(values.T, origin="lower", extent=(0, grid.nx * grid.d, 0, grid.ny * grid.d))
            axes.set(xlabel="x [m]", ylabel="y [m]")
            figure.colorbar(image, ax=axes, label=label, shrink=0.6)

    return Figure("figure_5-2", "Figure 5-2: L-beam under its load", draw)
