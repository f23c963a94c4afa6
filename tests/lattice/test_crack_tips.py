"""Where a crack ends: drawn, with # broken, T broken and the end of a crack, and o intact beside such an end."""

import numpy as np
import pytest

from lattice.criteria.crack_tips import bending_in_tension, beside_tips, crack_tips, tensile_limits
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice

DRAWINGS = {
    "a crack inside ends twice, not along its flanks": """
        .......
        .......
        ooo.ooo
        oT###To
        ooo.ooo
        .......""",
    "a crack from the edge has no tip at its mouth": """
        .......
        ...ooo.
        ####To.
        ...ooo.
        .......
        .......""",
    "two cells wide it ends in both corners": """
        .......
        ..ooo..
        ###To..
        ###To..
        ..ooo..
        .......""",
    "one cell alone": """
        .......
        ..ooo..
        ..oTo..
        ..ooo..
        .......
        .......""",
    "a straight broken edge has none": """
        #######
        .......
        .......
        .......
        .......
        .......""",
    "a corner that is off has none": """
        #......
        .......
        .......
        .......
        .......
        .......""",
    "a cell at the edge": """
        .......
        .......
        oo.....
        To.....
        oo.....
        .......""",
    "a crack that turns at a right angle": """
        .......
        ooo....
        oT###..
        ooo.#..
        ...oTo.
        ...ooo.""",
}


def drawn(text):
    rows = np.array([list(line.strip()) for line in text.strip().splitlines()])
    grid = Grid(rows.shape[0] + 1, rows.shape[1] + 1, 2.0)
    return grid, rows, ~np.isin(rows, ["#", "T"]).ravel()


@pytest.mark.parametrize("name", DRAWINGS)
def test_tips(name):
    grid, rows, intact = drawn(DRAWINGS[name])
    np.testing.assert_array_equal(crack_tips(grid, intact).reshape(rows.shape), rows == "T")


@pytest.mark.parametrize("name", DRAWINGS)
def test_all_eight_neighbours_of_a_tip_are_beside_it(name):
    grid, rows, intact = drawn(DRAWINGS[name])
    beside = beside_tips(grid, intact).reshape(rows.shape) & intact.reshape(rows.shape)
    tips = np.argwhere(rows == "T")
    near = np.zeros(rows.shape, bool)
    for i, j in tips:
        near[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2] = True
    np.testing.assert_array_equal(beside, near & intact.reshape(rows.shape))


def test_only_cells_beside_a_tip_have_a_limit_of_their_own():
    """(4.31) bounds a bending stress, which counts with sigma_t / sigma_f among the tensile ones."""
    grid, _, intact = drawn(DRAWINGS["one cell alone"])
    ice = Ice(8.7e9, 0.3, 1.2, 846.0, 1006.0, 0.6e6, 0.9e6, 4e6, BeamTest(9.0, 3.0, 0.2e6, 0.8))
    beside = beside_tips(grid, intact)
    limits = tensile_limits(grid, beside, ice)
    np.testing.assert_array_equal(limits[~beside], 0.6e6)
    np.testing.assert_allclose(limits[beside], ice.stress_beside_crack(2.0) * 2.0 / 3.0, rtol=1e-12)
    assert bending_in_tension(ice) == pytest.approx(2.0 / 3.0)
    np.testing.assert_array_equal(tensile_limits(grid, np.zeros(grid.cells, bool), ice), 0.6e6)
