"""Ice that is broken before a run begins: cracks, and an edge of which parts are gone.

From a table of places, as `cosim run --ice` writes it at the end of a run or as people draw it, or from a recording. A
row says ``crack``: the cell there is cracked through, but closed; or ``gone``: the ice of the node next to it is not
there. Places count from the rear corner y_min of the whole sheet, so that meshes may differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet
from scipy import optimize, sparse

from cosim.errors import InputError
from cosim.ice.columns import numbers, read_table
from cosim.ice.fields import middles
from cosim.recording.reader import last_sheet, read_run
from coupling.interface import Array, BoolArray, IntArray
from lattice.cracks.hinges import DEEP
from lattice.cracks.sheet import CrackingSheet
from lattice.floe import Floe
from lattice.grid import Grid

CRACK, GONE = "crack", "gone"
NEAR = 2  #: cells around a cracked one from which its direction is told where it is not given


@dataclass(frozen=True)
class Broken:
    """What is not whole."""

    gone: BoolArray  #: (nodes,)
    cracked: IntArray  #: cells whose nodes are all there
    angle: Array  #: (cracked,) of the normal of each crack from the x axis [rad]


def broken(path: Path, grid: Grid) -> Broken:
    """From a table or a recording, for this grid."""
    gone, cracked, angle = _recorded(path, grid) if path.suffix == ".mcap" else _tabled(path, grid)
    cracked = cracked & ~gone[grid.cell_nodes].any(axis=1)
    if gone.all():
        raise InputError(f"{path}: nothing of the sheet is left; leave sheet.broken out")
    cells = np.flatnonzero(cracked)
    unknown = np.isnan(angle[cells])
    angle[cells[unknown]] = directions(grid, cracked, cells[unknown])
    return Broken(gone, cells, angle[cells])


def directions(grid: Grid, cracked: BoolArray, cells: IntArray) -> Array:
    """Normal of the crack that runs through each of these cells and its cracked neighbours, (cells,) [rad].

    It is across the longest extent of the neighbours; of a cell on its own it is along x.
    """
    ij = np.column_stack(np.divmod(np.arange(grid.cells), grid.ny - 1))
    every = ij[cracked]
    found = np.zeros(len(cells))
    for k, at in enumerate(ij[cells]):
        near = every[(np.abs(every - at) <= NEAR).all(axis=1)] - at
        (xx, xy), (_, yy) = near.T @ near
        found[k] = 0.5 * np.arctan2(2.0 * xy, xx - yy) + 0.5 * np.pi if near.any() else 0.0
    return found


def _tabled(path: Path, grid: Grid) -> tuple[BoolArray, BoolArray, Array]:
    table = read_table(path, ("x", "y", "what"))
    xy = np.column_stack([numbers(path, table, name) for name in ("x", "y")])
    what = np.array(table["what"].to_pylist(), object)
    for row, word in enumerate(what):
        if word not in (CRACK, GONE):
            raise InputError(f"{path}: row {row + 1} has what = {word!r}; write {CRACK} or {GONE}")
    span = np.array([grid.nx - 1, grid.ny - 1]) * grid.d
    outside = np.flatnonzero(((xy < -1e-9 * span) | (xy > (1.0 + 1e-9) * span)).any(axis=1))
    if len(outside):
        x, y = xy[outside[0]]
        raise InputError(
            f"{path}: row {outside[0] + 1} lies at x = {x:g} m, y = {y:g} m, outside of the sheet of {span[0]:g} m x "
            f"{span[1]:g} m; count from the rear corner y_min"
        )
    gone, cracked, angle = np.zeros(grid.nodes, bool), np.zeros(grid.cells, bool), np.full(grid.cells, np.nan)
    i, j = np.rint(xy[what == GONE] / grid.d).astype(np.int64).T
    gone[i * grid.ny + j] = True
    i, j = np.minimum(np.floor(xy[what == CRACK] / grid.d), (grid.nx - 2, grid.ny - 2)).astype(np.int64).T
    cells = i * (grid.ny - 1) + j
    cracked[cells] = True
    if "angle" in table.column_names:
        given = table.filter(pa.compute.equal(table["what"], CRACK))["angle"].to_pylist()
        angle[cells] = np.deg2rad(np.array([np.nan if a is None else a for a in given], np.float64))
    return gone, cracked, angle


def _recorded(path: Path, grid: Grid) -> tuple[BoolArray, BoolArray, Array]:
    """Of the last picture of a recording: nodes that are not there, cells cracked deeper than to the middle."""
    run = read_run(path)  # refuses what is no recording
    last = last_sheet(path)
    if last is None:
        raise InputError(f"{path}: holds no picture of the ice; record a run with recording.every below its duration")
    spacing = float(run.metadata["spacing_m"])
    if not np.isclose(spacing, grid.d, rtol=1e-6) or last.shape != (grid.nx, grid.ny):
        raise InputError(
            f"{path}: its sheet has cells of {spacing:g} m, this one of {grid.d:g} m; give the same sheet.nodes, "
            "length and width, or a table by `cosim run --ice`"
        )
    return ~last.present, cell_damage(grid, last.present, last.damage) >= DEEP, np.full(grid.cells, np.nan)


def cell_damage(grid: Grid, present: BoolArray, damage: Array) -> Array:
    """Damage of cells, 0 to 1, of which nodes that are present know the mean over their cells, (cells,).

    Cells of nodes that are not there count as whole; a sheet from which nothing has gone is known to the last digit.
    """
    share = np.bincount(grid.cell_nodes.ravel(), minlength=grid.nodes)
    rows, cols = grid.cell_nodes.ravel(), np.repeat(np.arange(grid.cells), 4)
    mean = sparse.csr_matrix((1.0 / share[rows], (rows, cols)), shape=(grid.nodes, grid.cells))
    whole = optimize.lsq_linear(mean[present], damage[present], bounds=(0.0, 1.0), tol=1e-10)
    return np.where(present[grid.cell_nodes].all(axis=1), whole.x, 0.0)


# ---- at the end of a run --------------------------------------------------------------------------------------------


def as_table(sheet: Floe) -> pa.Table:
    """The state of a sheet as `broken` reads it: cracks that are deeper than to the middle, nodes that have gone."""
    g = sheet.grid
    live = sheet.present[g.cell_nodes].all(axis=1)
    cracked, angle = np.asarray(~sheet.intact & live), np.full(g.cells, np.nan)
    if isinstance(sheet, CrackingSheet):
        layered = sheet.engine.layered
        angle[layered.cell] = layered.angle
        cracked[layered.cell] &= layered.depth >= DEEP
    cells, gone = np.flatnonzero(cracked), np.flatnonzero(~sheet.present)
    i, j = np.divmod(gone, g.ny)
    xy = np.concatenate((middles(g)[cells], np.column_stack((i, j)) * g.d))
    degrees = np.concatenate((np.rad2deg(angle[cells]), np.full(len(gone), np.nan)))
    return pa.table(
        {
            "x": xy[:, 0],
            "y": xy[:, 1],
            "what": [CRACK] * len(cells) + [GONE] * len(gone),
            "angle": pa.array(degrees, mask=np.isnan(degrees)),
        }
    )


def write(sheet: Floe, path: Path) -> None:
    """`as_table` as CSV, or as Parquet by its name."""
    table = as_table(sheet)
    if path.suffix == ".parquet":
        pa.parquet.write_table(table, path)
    else:
        pa.csv.write_csv(table, path)
