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


def test_a_held_piece_stays_however_small():
    """One node cut off all around: it stays where it is held, and leaves where it is not."""
    intact = np.ones((GRID.nx - 1, GRID.ny - 1), bool)
    intact[0, 0] = intact[-1, 0] = False
    held, corner = held_at_back(), GRID.node(GRID.nx - 1, 0)
    pieces, stay = loose_pieces(GRID, intact.ravel(), np.ones(GRID.nodes, bool), held, 0.5)
    assert [p.tolist() for p in pieces] == [[corner]]
    assert stay == 2
    held[corner] = True
    assert loose_pieces(GRID, intact.ravel(), np.ones(GRID.nodes, bool), held, 0.5) == ([], 3)


def test_a_free_piece_leaves_below_its_share_and_not_at_it():
    intact = cracked(columns=[2])  # three columns of nodes on the one side: 2.5 of 6 m
    free, all_there = np.zeros(GRID.nodes, bool), np.ones(GRID.nodes, bool)
    for share, leaving in ((2.5 / 6.0, 0), (2.5 / 6.0 + 1e-9, 1), (3.5 / 6.0 + 1e-9, 2)):
        pieces, stay = loose_pieces(GRID, intact, all_there, free, share)
        assert (len(pieces), stay) == (leaving, 2 - leaving)


def test_a_held_part_leaves_when_all_of_it_has_turned():
    intact, present = cracked(rows=[4]), np.ones(GRID.nodes, bool)
    turned = np.zeros(GRID.nodes, bool)
    turned[: 5 * GRID.ny] = True
    pieces, stay = loose_pieces(GRID, intact, present, held_at_back(), 0.1, turned)
    np.testing.assert_array_equal(pieces[0], np.arange(5 * GRID.ny))
    assert (len(pieces), stay) == (1, 1)
    turned[7] = False
    assert loose_pieces(GRID, intact, present, held_at_back(), 0.1, turned) == ([], 2)


def test_nodes_that_have_left_are_no_piece():
    intact, present = cracked(rows=[4]), np.ones(GRID.nodes, bool)
    present[5 * GRID.ny :] = False
    assert loose_pieces(GRID, intact, present, held_at_back(), 0.9) == ([], 1)
