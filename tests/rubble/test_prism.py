"""The wetted edges of a block, and which of them are its top."""

import numpy as np
import pytest

from rubble.geometry import contiguous
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.prism import wetted_edges

WIDTH = 2.8


def tops(polygon):
    own = contiguous(polygon)
    edges = wetted_edges([own], np.array([own[:, 0].min(), own[:, 0].max()]), np.array([WIDTH]))
    return {(float(e["x0"]), float(e["x1"])) for e in edges if e["top"] > 0.0}, edges


@pytest.mark.parametrize(("degrees", "is_top"), [(0.0, True), (20.0, True), (25.0, True), (27.0, False), (45.0, False)])
def test_the_top_ends_at_26_degrees(degrees, is_top):
    """What a cut at the slope has left is no top; its cosine is 0.9 at 25.8 degrees."""
    rise = 4.0 * np.tan(np.radians(degrees))
    found, _ = tops([(-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0 + rise)])
    assert found == ({(2.0, -2.0)} if is_top else set())


def test_edges_go_round_with_the_water_on_their_right():
    _, edges = tops([(-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0)])
    assert edges["width"].tolist() == [WIDTH] * 4
    np.testing.assert_allclose(np.column_stack((edges["t_x"], edges["t_z"])), [(1, 0), (0, 1), (-1, 0), (0, -1)])
    area = 0.5 * (edges["x0"] * edges["z1"] - edges["x1"] * edges["z0"]).sum()
    assert area == pytest.approx(8.0)


def test_a_block_begins_with_the_motion_that_it_is_given():
    """A box of 4 x 2 m at (10, -3): mass with what it displaces, and velocities in all three directions."""
    physics = RubblePhysics(rho_i=850.0, rho_w=1000.0, added_mass=0.2, added_inertia=0.3, restitution=0.09)
    box = np.array([(8.0, -4.0), (12.0, -4.0), (12.0, -2.0), (8.0, -2.0)])
    slab = Slab(box, np.array([8.0, 12.0]), np.array([WIDTH]), 850.0)
    layer = RubbleLayer(physics, 0.5 * WIDTH)
    b = layer.block(layer.add_block(0, slab, (0.1, 0.2, 0.3), 0.4, y=1.5, fragment=7))
    assert (b.id, b.fragment) == (0, 7)
    np.testing.assert_allclose(b.velocity, [0.1, 0.2, 0.3])
    np.testing.assert_allclose(b.omega, [0.0, -0.4, 0.0])
    np.testing.assert_allclose(b.position, [10.0, 1.5, -3.0])
    assert b.mass == pytest.approx(8.0 * WIDTH * 850.0)
    np.testing.assert_allclose(b.momentum, b.mass * np.array([0.1, 0.2, 0.3]))
    assert b.rows.moved[b.row] == pytest.approx(b.mass + 0.2 * 8.0 * WIDTH * 1000.0)
    extents = np.array([2.0**2 + WIDTH**2, 4.0**2 + 2.0**2, 4.0**2 + WIDTH**2])
    moved = 8.0 * WIDTH * extents / 12.0 * (850.0 + 0.3 * 1000.0)
    np.testing.assert_allclose(b.rows.inertia[b.row], np.diag(moved), atol=1e-9 * moved.max())
