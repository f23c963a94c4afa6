"""The outline of the sheet turns as its contacts say that it moves: sections stay plane, as those of a thin plate."""

import numpy as np
import pytest

from rubble.edges import deeper_on_sheet, locate, still_edges
from rubble.rows import POINT
from rubble.sheet import NODE, sheet_polygons

H, D = 3.0, 2.8
X = -13.0 - D * np.arange(8)


def turned(points, angle):
    """Points (n, 2) turned about the rearmost node of the line."""
    c, s = np.cos(angle), np.sin(angle)
    return (points - [X[-1], 0.0]) @ np.array([[c, s], [-s, c]]) + [X[-1], 0.0]


def test_a_sheet_that_turns_is_the_same_sheet_turned():
    """To second order in the angle; with an end that stays upright its corners would miss by h/2 times the angle."""
    level = sheet_polygons(X, 0.0 * X, X[0], H, 1e-3)
    for angle in (0.02, -0.04):
        line = turned(np.column_stack((X, 0.0 * X)), angle)
        found = sheet_polygons(line[:, 0], line[:, 1], line[0, 0], H, 1e-3)
        expected = turned(level.reshape(-1, 2), angle).reshape(level.shape)
        assert found.shape == level.shape == (1, 4, 2)
        assert np.abs(found - expected).max() < 0.6 * H * angle**2
        assert np.abs(found[0, 1, 0] - line[0, 0]) > 0.4 * H * abs(angle)  # the front leans


def test_pieces_of_a_bent_sheet_meet_without_gaps():
    z = -0.02 * (X - X[-1]) ** 2 / D
    found = sheet_polygons(X, z, X[0], H, 1e-3)
    assert len(found) > 3
    np.testing.assert_allclose(found[:-1, [0, 3]], found[1:, [1, 2]], rtol=0, atol=1e-12)


@pytest.mark.parametrize("height", [-1.5, 0.0, 1.5])
def test_within_a_window_the_outline_turns_with_its_nodes(height):
    """A contact at the front gets deeper by -height times the turn, as the speed of the sheet there has it."""
    nodes, turn = np.zeros(len(X), NODE), 1e-4
    nodes["x"], nodes["outline_x"] = X, X - X[0]
    nodes["z"] = turn * (X - X[-1])
    edges = still_edges(nodes, np.array([0, len(X)]), yielding=False)
    point = np.zeros(1, POINT)
    point["x"], point["z"] = X[0], height + nodes["z"][0]
    locate(point[0], nodes, 0, len(X))
    assert deeper_on_sheet(edges, 0, point[0], 1.0, 0.0) == pytest.approx(-turn * height, rel=1e-9, abs=1e-15)
