"""Rules of [sheet]: a square lattice that the machine can hold, fine enough for the structure and for the criterion."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.scenario.lengths import width_at_waterline
from cosim.scenario.section import fault

Faults = Iterator[PydanticCustomError]
MOST_NODES = 1_000_000  #: of a sheet: about 20 GB, see `cosim.scenario.cost`


def is_a_square_lattice(m: Any) -> Faults:
    """Cells with equal sides, and a structure in front of them."""
    s = m.sheet
    if min(s.nodes) < 3:
        yield fault("sheet.nodes", "a sheet needs at least 3 nodes along x and y")
        return
    if s.nodes[0] * s.nodes[1] > MOST_NODES:
        yield fault(
            "sheet.nodes",
            f"{s.nodes[0] * s.nodes[1]} nodes are more than a machine holds; use {MOST_NODES} at most",
        )
        return
    d, e = s.spacing, s.width / (s.nodes[1] - 1)
    if not math.isclose(d, e, rel_tol=1e-6):
        nearest = max(3, round(s.width / d) + 1)
        yield fault(
            "sheet.nodes",
            f"cells must be square, these are {d:.4g} m x {e:.4g} m; "
            f'use [{s.nodes[0]}, {nearest}] or set width = "{d * (nearest - 1):.6g} m"',
        )


def structure_is_before_the_sheet(m: Any) -> Faults:
    """The axis lies between the side edges."""
    if m.sheet.axis > m.sheet.width:
        yield fault("sheet.axis_from_side", f"the structure's axis misses the sheet; use 0 to {m.sheet.width:g} m")


def beam_test_holds_for_the_mesh(m: Any) -> Faults:
    """(4.31) ends where cells are twice as wide as the beam; it is judged in sheets with open cracks."""
    test, d = m.ice.beam_test, m.sheet.length / max(m.sheet.nodes[0] - 1, 1)
    if test is not None and m.fracture.cracks == "open" and d >= 2.0 * test.width:
        least = math.floor(m.sheet.length / (2.0 * test.width)) + 2
        yield fault(
            "sheet.nodes",
            f"cells of {d:.4g} m are not below twice the width of the beam test ({test.width:g} m), where (4.31) "
            f"ends; use at least {least} nodes along x",
        )


def structure_is_wider_than_a_cell(m: Any) -> Faults:
    """What is narrower passes between two nodes and is never touched."""
    width, d = width_at_waterline(m), m.sheet.length / max(m.sheet.nodes[0] - 1, 1)
    if width is not None and width < d:
        least = math.floor(m.sheet.length / max(width, 1e-3)) + 2
        yield fault(
            "sheet.nodes",
            f"cells of {d:.4g} m are wider than the structure of {width:g} m, which passes between two nodes; "
            f"use at least {least} nodes along x, better five times as many",
        )


RULES = (
    is_a_square_lattice,
    structure_is_before_the_sheet,
    beam_test_holds_for_the_mesh,
    structure_is_wider_than_a_cell,
)
