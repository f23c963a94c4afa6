"""Crushed ice: cut area against numerical integration, rows behind the front, and a column that is used up."""

import numpy as np
import pytest

from coupling.sheet_port.crushed_edge import CrushedEdge

NX, NY, D, H = 6, 4, 2.0, 3.0


def edge(tan=1.0):
    return CrushedEdge((NX, NY), D, H, np.full(NY, tan))


@pytest.mark.parametrize("tan", [0.6, 1.0, 2.0])
@pytest.mark.parametrize("depth", [0.3, 1.7, 4.4])
def test_crushed_area_is_the_area_of_the_cut(tan, depth):
    e = edge(tan)
    e.crush(np.array([1]), np.full((1, 8), depth))
    row = np.arange(NX)
    area = e.crushed_area(row, np.ones(NX, int))
    s = (np.arange(200000) + 0.5) * (9.0 / 200000)  # distance behind the front
    removed = np.minimum(H, np.maximum(depth - s, 0.0) * tan)
    ends = 5 * D - np.concatenate(([0.0], np.cumsum(e.length(row))))  # place of the rows' rear and front ends
    for r in row:
        inside = (s >= ends[r + 1]) & (s < ends[r])
        assert area[r] == pytest.approx(removed[inside].sum() * 9.0 / 200000, rel=1e-3, abs=1e-4)


def test_the_cut_only_grows_and_a_new_front_starts_uncut():
    e = edge()
    e.crush(np.array([0, 1]), np.array([[1.0], [2.0]]))
    e.crush(np.array([0, 1]), np.array([[0.5], [2.5]]))
    np.testing.assert_allclose(e.depth, [1.0, 2.5, 0.0, 0.0])
    e.set_front(np.array([NX - 1, NX - 3, NX - 1, NX - 1]))
    np.testing.assert_allclose(e.depth, [1.0, 0.0, 0.0, 0.0])


def test_a_column_is_spent_when_its_front_node_has_no_ice():
    e = edge()
    e.crush(np.array([2]), np.full((1, 8), 0.5 * D + H - 0.01))
    assert not len(e.spent())
    e.crush(np.array([2]), np.full((1, 8), 0.5 * D + H + 0.01))
    np.testing.assert_array_equal(e.spent(), [2])


@pytest.mark.parametrize("behind", [1, 2])
@pytest.mark.parametrize("depth", [0.7, 2.6, 5.1])
def test_the_cut_of_a_front_behind_the_first_row(behind, depth):
    """From the second row on the ice begins d/2 ahead of its node: all of the first node's length d is cut first."""
    e = edge()
    e.set_front(np.full(NY, NX - 1 - behind))
    e.crush(np.array([1]), np.full((1, 8), depth))
    row = NX - 1 - behind - np.arange(3)
    np.testing.assert_allclose(e.cut(row, np.ones(3, int)), np.maximum(depth - D * np.arange(3), 0.0), rtol=1e-12)
    s = (np.arange(300000) + 0.5) * (6.0 / 300000)
    removed = np.minimum(H, np.maximum(depth - s, 0.0))
    area = [removed[(s >= k * D) & (s < (k + 1) * D)].sum() * 6.0 / 300000 for k in range(3)]
    np.testing.assert_allclose(e.crushed_area(row, np.ones(3, int)), area, rtol=1e-3, atol=1e-4)


def test_a_column_behind_the_first_row_is_spent_after_its_whole_cell():
    e = edge()
    e.set_front(np.full(NY, NX - 2))
    for depth, gone in ((D + H - 0.01, []), (D + H + 0.01, [2])):
        e.crush(np.array([2]), np.full((1, 8), depth))
        np.testing.assert_array_equal(e.spent(), gone)


def test_the_mean_cut_area_is_kept():
    """Points of 1 and 3 m cut as one of sqrt(5) m: the area goes with the square."""
    e = edge()
    e.crush(np.array([1]), np.array([[1.0, 3.0]]))
    assert e.depth[1] == pytest.approx(5.0**0.5, rel=1e-12)


def test_columns_without_ice_are_not_spent():
    e = edge()
    e.set_front(np.array([-1, NX - 1, NX - 1, NX - 1]))
    e.crush(np.array([0, 1]), np.full((2, 8), 50.0))
    np.testing.assert_array_equal(e.spent(), [1])
