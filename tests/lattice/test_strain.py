"""Strains of the connections: a cell that turns has none, whichever way it turns."""

import numpy as np
import pytest

from lattice.grid import Grid
from lattice.strain import CellState, Connections

GRID = Grid(3, 3, 2.0)


def state(gradient):
    """u = gradient x, uniform."""
    return CellState.of(GRID, GRID.xy @ np.asarray(gradient).T, np.zeros((GRID.nodes, 3)))


@pytest.mark.parametrize("turn", [1e-3, -2e-3])
def test_a_sheet_that_turns_in_plane_is_not_strained(turn):
    turned = state([[0.0, -turn], [turn, 0.0]])
    for values in (*vars(turned.membrane).values(), *turned.strains, turned.diagonal):
        np.testing.assert_allclose(values, 0.0, atol=1e-15)


@pytest.mark.parametrize("turn", [0.0, 3e-3, -3e-3])
def test_shear_is_the_same_however_the_cell_turns(turn):
    """gamma_12 = du_x/dy + du_y/dx = 4e-4: each connection keeps half of it, with and without a rotation."""
    m = state([[1e-4, 1e-4 - turn], [3e-4 + turn, -2e-4]]).membrane
    for values, expected in ((m.n11, 1e-4), (m.n22, -2e-4), (m.s12, 2e-4), (m.s21, 2e-4)):
        np.testing.assert_allclose(values, expected, rtol=1e-9)


def test_the_rotation_taken_out_is_the_mean_of_the_cell():
    """Parallel connections that differ keep their difference; the sum of both shears stays."""
    n = np.zeros((1, 2))
    c = Connections(n, n, np.array([[5.0, 7.0]]), np.array([[1.0, -1.0]]))
    out = c.without_rotation()
    np.testing.assert_allclose(out.s12, [[2.0, 4.0]])  # half of 6 - 0 taken off
    np.testing.assert_allclose(out.s21, [[4.0, 2.0]])
