"""The mesh: numbers, places and areas of nodes and cells, by hand."""

import numpy as np
import pytest

from lattice.grid import Grid

GRID = Grid(4, 3, 2.0, 10.0, -1.0)


def test_nodes_count_along_y_first():
    assert (GRID.nodes, GRID.cells) == (12, 6)
    np.testing.assert_array_equal(GRID.xy[[0, 1, 3, 11]], [[10.0, -1.0], [10.0, 1.0], [12.0, -1.0], [16.0, 3.0]])
    assert GRID.node(2, 1) == 7
    np.testing.assert_array_equal(
        GRID.cell_nodes[[0, 1, 2, 5]], [[0, 3, 1, 4], [1, 4, 2, 5], [3, 6, 4, 7], [7, 10, 8, 11]]
    )


def test_edges():
    for side, nodes in (("x-", [0, 1, 2]), ("x+", [9, 10, 11]), ("y-", [0, 3, 6, 9]), ("y+", [2, 5, 8, 11])):
        np.testing.assert_array_equal(GRID.edge_nodes(side), nodes)


def test_every_node_owns_its_share_of_the_cells():
    np.testing.assert_allclose(GRID.area.reshape(4, 3), [[1, 2, 1], [2, 4, 2], [2, 4, 2], [1, 2, 1]])


@pytest.mark.parametrize("shape", [(1, 2), (2, 1)])
def test_a_lattice_without_a_cell_is_refused(shape):
    with pytest.raises(ValueError, match="no cell"):
        Grid(*shape, 1.0)
    with pytest.raises(ValueError, match="no cell"):
        Grid.rectangle(1.0, 1.0, *shape)
    assert Grid(2, 2, 1.0).cells == 1


def test_cells_are_square_to_a_millionth():
    g = Grid.rectangle(6.0, 4.0 * (1.0 + 0.9e-6), 4, 3, 10.0, -1.0)
    assert (g.nx, g.ny, g.d, g.x0, g.y0) == (4, 3, 2.0, 10.0, -1.0)
    with pytest.raises(ValueError, match="for example 4 x 3 nodes"):
        Grid.rectangle(6.0, 4.0 * (1.0 + 1.2e-6), 4, 3)
    with pytest.raises(ValueError, match="greater than 0"):
        Grid(2, 2, 0.0)
