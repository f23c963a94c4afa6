"""Pieces are components of nodes: they partition the ice, and a crack costs none."""

import numpy as np

from lattice.fragments import components, front_rows, loose_pieces
from lattice.grid import Grid

GRID = Grid(8, 7, 1.0)


def cracked(*, rows=(), columns=()):
    intact = np.ones((GRID.nx - 1, GRID.ny - 1), bool)
    intact[list(rows)], intact[:, list(columns)] = False, False
    return intact.ravel()


def test_a_crack_across_parts_the_floe_and_costs_no_ice():
    intact = cracked(rows=[4])
    pieces, stay = loose_pieces(GRID, intact, np.ones(GRID.nodes, bool), held_at_back(), 0.5)
    assert stay == 1
    assert len(pieces) == 1
    np.testing.assert_array_equal(pieces[0], np.arange(5 * GRID.ny, GRID.nodes))
    rest = np.setdiff1d(np.arange(GRID.nodes), pieces[0])
    assert GRID.area[pieces[0]].sum() + GRID.area[rest].sum() == 7.0 * 6.0


def held_at_back():
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    return held


def test_a_large_free_part_stays_and_floats():
    intact = cracked(columns=[2])
    free = np.zeros(GRID.nodes, bool)
    assert loose_pieces(GRID, intact, np.ones(GRID.nodes, bool), free, 0.2) == ([], 2)


def test_a_node_without_an_intact_cell_is_a_piece_of_its_own():
    intact = np.ones((GRID.nx - 1, GRID.ny - 1), bool)
    intact[2:4, 2:4] = False
    label = components(GRID, intact.ravel())
    alone = GRID.node(3, 3)
    assert (label == label[alone]).sum() == 1
    pieces, stay = loose_pieces(GRID, intact.ravel(), np.ones(GRID.nodes, bool), held_at_back(), 0.2)
    assert [p.tolist() for p in pieces] == [[alone]]
    assert stay == 1


def test_front_rows_follow_what_is_present():
    present = np.ones((GRID.nx, GRID.ny), bool)
    present[6:, 2] = False
    present[:, 3] = False
    np.testing.assert_array_equal(front_rows(GRID, present.ravel()), [7, 7, 5, -1, 7, 7, 7])
