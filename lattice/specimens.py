"""Test pieces cut from a plate: edge-cracked square (4.2.1), cantilever (4.2.2) and L-shaped beam (chapter 5).

A cut is one cell wide. The load of a specimen is a unit force; everything is linear until the first cell fails.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lattice.criteria.mohr import circle_of_connections, mohr_factors
from lattice.grid import Array, BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.statics import all_around, held_out_of_plane, in_plane_stiffness, out_of_plane_stiffness, solve
from lattice.stiffness import hrennikoff
from lattice.strain import CellState


@dataclass(frozen=True)
class EdgeCrack:
    """Free square plate, crack from the middle of the edge x = 0, opened by a force at its mouth (Figure 4-11)."""

    ice: Ice
    L: float  #: side of the plate [m]
    cells: int  #: cells along a side
    cut: int  #: length of the crack [cells]

    def __post_init__(self) -> None:
        if not 1 <= self.cut < self.cells:
            raise ValueError(
                f"a crack of {self.cut} cells ({self.cut * self.L / self.cells:g} m) does not end inside "
                f"the plate of {self.cells} cells ({self.L:g} m): use 1 to {self.cells - 1} cells"
            )

    @property
    def grid(self) -> Grid:
        """Mesh of the whole plate, cells of the cut included."""
        return Grid(self.cells + 1, self.cells + 1, self.L / self.cells)

    @property
    def row(self) -> int:
        """Column of cells along which the crack runs, counted along y."""
        return self.cells // 2

    def displacement(self) -> Array:
        """U per newton at the crack mouth, (nodes, 2) [m/N]."""
        grid, n, row = self.grid, self.cells, self.row
        intact = np.ones((n, n), dtype=bool)
        intact[: self.cut, row] = False
        load = np.zeros(2 * grid.nodes)
        load[2 * grid.node(0, row) + 1], load[2 * grid.node(0, row + 1) + 1] = -1.0, 1.0
        held = 2 * np.array([grid.node(n, 0), grid.node(n, 0), grid.node(n, n)]) + [0, 1, 0]  # rigid motion
        return solve(in_plane_stiffness(grid, hrennikoff(self.ice), intact.ravel()), load, held).reshape(-1, 2)

    def tip_state(self, u: Array) -> CellState:
        """Strain of the first intact cell ahead of the crack."""
        cell = self.cut * self.cells + self.row
        return CellState.of(self.grid, u, np.zeros((self.grid.nodes, 3)), np.array([cell]))

    def opening(self, u: Array) -> Array:
        """Distance that the faces of the crack move apart, at x = 0, d, ... L, (cells + 1,) [m/N]."""
        uy = u[:, 1].reshape(self.cells + 1, self.cells + 1)
        return uy[:, self.row + 1] - uy[:, self.row]


@dataclass(frozen=True)
class Piece:
    """Beam in a clamped plate on water, loaded downwards by 1 N spread over the nodes of its tip."""

    ice: Ice
    grid: Grid
    intact: BoolArray  #: (nx - 1, ny - 1), False where cut
    tip: IntArray  #: loaded nodes
    root: tuple[int, int, int]  #: first row of cells inside the beam: its column, first cell and number of cells

    def load(self) -> Array:
        """One newton downwards, spread over the tip, (3 nodes,) [N]."""
        F = np.zeros(3 * self.grid.nodes)
        F[3 * self.tip] = -1.0 / len(self.tip)
        return F

    def held(self) -> IntArray:
        """Degrees of freedom that the clamped edges hold."""
        return held_out_of_plane(self.grid, all_around("clamped"))

    def deflection(self) -> Array:
        """(w, phi_x, phi_y) per newton at the tip, (nodes, 3)."""
        K = out_of_plane_stiffness(self.grid, self.ice, hrennikoff(self.ice), self.intact.ravel())
        return solve(K, self.load(), self.held()).reshape(-1, 3)

    def row_state(self, q: Array, row: int = 0) -> CellState:
        """Strain of the cells of the row'th row inside the beam, counted from the root."""
        column, first, count = self.root
        cells = (column + row) * (self.grid.ny - 1) + first + np.arange(count)
        return CellState.of(self.grid, np.zeros((self.grid.nodes, 2)), q, cells)


def cantilever(ice: Ice, L_b: float, w: float, cells: int, side: float | None = None) -> Piece:
    """Beam of length L_b and width w, ``cells`` over the width, in the middle of a plate of ``side`` (2 L_b)."""
    if cells < 3:
        raise ValueError(f"{cells} cells over the width of the beam: (4.30) needs at least 3")
    d = w / cells
    long, n = round(L_b / d), round((side or 2.0 * L_b) / d)
    n += (n - cells) % 2
    if long + 2 > n:
        raise ValueError(f"a beam of {L_b:g} m does not fit into a plate of {n * d:g} m")
    grid, first, root = Grid(n + 1, n + 1, d), (n - cells) // 2, (n - long) // 2
    intact = np.ones((n, n), dtype=bool)
    intact[root : root + long, [first - 1, first + cells]] = False
    intact[root + long, first - 1 : first + cells + 1] = False
    tip = (root + long) * grid.ny + first + np.arange(cells + 1)
    return Piece(ice, grid, intact, tip, (root, first, cells))


def beam_strain(piece: Piece, q: Array, L_b: float, w: float, ratio: float = 5.0) -> tuple[Array, Array, Array]:
    """Left side of (4.29) in the cells of the root [-], with mean and radius of the curvature there [1/m], (cells,).

    ``q`` per newton at the tip; ``ratio`` is sigma_c / sigma_f.
    """
    ice = piece.ice
    mean, radius = circle_of_connections(piece.row_state(q).bending)
    F_1, F_2 = mohr_factors(ice.nu, ratio)
    left = (F_1 * np.abs(mean) + radius) * 0.5 * ice.h / F_2 * ice.E * w * ice.h**2 / (6.0 * L_b)
    return left, mean, radius


def factor_f(ice: Ice, L_b: float, w: float, cells: int, ratio: float = 5.0) -> float:
    """Factor f of (4.30) from the edge cell x = (w - d) / 2 of a simulated beam; (4.31)."""
    piece = cantilever(ice, L_b, w, cells)
    left = float(beam_strain(piece, piece.deflection(), L_b, w, ratio)[0][0])
    d_w = 1.0 / cells
    return float(left / (0.5 * (1.0 / np.sqrt(d_w) + 1.0 / np.sqrt(2.0 - d_w))))


def l_beam(ice: Ice, L_1: float, L_2: float, width: float, d: float, margin: float) -> Piece:
    """L-shaped beam: a leg of clear length L_1 from the root, then one of clear length L_2 sideways, loaded at its end.

    Figure 5-1 is read with the lengths of the inner edges, so that the outer edges are one width longer; both legs
    are ``width`` wide; ``margin`` of intact plate all around [m].
    """
    lengths = L_1 + width, L_2 + width, width
    toe, free, b, m = (round(length / d) for length in (*lengths, margin))
    if max(abs(n * d - length) for n, length in zip((toe, free, b), lengths, strict=True)) > 0.01 * d:
        raise ValueError(f"cell size {d:g} m does not divide {L_1:g}, {L_2:g} and {width:g} m")
    grid = Grid(2 * m + toe + 2, 2 * m + free + 2, d)
    intact = np.ones((grid.nx - 1, grid.ny - 1), dtype=bool)
    x1, y0, y1 = m + toe, m, m + free  # outer edge of the free leg; outer side of the first leg; loaded end
    intact[m:x1, y0 - 1] = intact[m : x1 - b, y0 + b] = False  # sides of the first leg
    intact[x1 - b - 1, y0 + b : y1] = intact[x1, y0 - 1 : y1 + 1] = False  # sides of the free leg
    intact[x1 - b - 1 : x1 + 1, y1] = False  # end of the free leg
    return Piece(ice, grid, intact, np.arange(x1 - b, x1 + 1) * grid.ny + y1, (m, y0, b))
