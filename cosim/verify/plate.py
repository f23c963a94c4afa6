"""The floating plate of Table 2-1, simply supported, 60 m x 100 m: common to the cases of chapters 2 and 3."""

from __future__ import annotations

from typing import Any

from lattice.grid import Grid
from lattice.ice import Ice
from lattice.spectrum import Plate
from lattice.statics import all_around
from lattice.stiffness import STIFFNESS_SETS, Springs

TABLE_2_1: dict[str, Any] = {
    "Lx": 60.0,
    "Ly": 100.0,
    "E": 3.0e9,
    "nu": 0.3,
    "h": 1.5,
    "rho_i": 900.0,
    "rho_w": 1025.0,
    "g": 9.81,
    "stiffness": "equations-matching",
}


def ice_of(p: dict[str, Any]) -> Ice:
    """Ice of Table 2-1."""
    return Ice(E=p["E"], nu=p["nu"], h=p["h"], rho_i=p["rho_i"], rho_w=p["rho_w"], g=p["g"])


def springs_of(p: dict[str, Any], ice: Ice) -> Springs:
    """Stiffnesses of the set that p["stiffness"] names."""
    if p["stiffness"] not in STIFFNESS_SETS:
        raise ValueError(f"unknown stiffness set {p['stiffness']!r}: use {' or '.join(STIFFNESS_SETS)}")
    return STIFFNESS_SETS[p["stiffness"]](ice)


def plate_of(p: dict[str, Any], nodes: tuple[int, int]) -> Plate:
    """Simply supported lattice of nx x ny nodes."""
    ice = ice_of(p)
    return Plate.build(Grid.rectangle(p["Lx"], p["Ly"], *nodes), ice, springs_of(p, ice), all_around("simple"))


def load_node(p: dict[str, Any], grid: Grid) -> int:
    """Node at the load point p["load"] = [x, y]."""
    x, y = (round((a / grid.d), 6) for a in p["load"])
    if x != int(x) or y != int(y) or not (0 < x < grid.nx - 1 and 0 < y < grid.ny - 1):
        raise ValueError(
            f"load point {p['load']} is not an inner node of the {grid.nx} x {grid.ny} mesh "
            f"(cell size {grid.d:g} m): choose multiples of the cell size"
        )
    return grid.node(int(x), int(y))


def is_table_2_1(p: dict[str, Any]) -> bool:
    """Whether the parameters are those of the thesis, for which there are references."""
    return all(p[key] == standard for key, standard in TABLE_2_1.items())
