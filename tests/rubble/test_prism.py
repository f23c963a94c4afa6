"""The wetted edges of a block, and which of them are its top."""

import numpy as np
import pytest

from rubble.piece import Slab, make_block
from rubble.geometry import contiguous
from rubble.physics import RubblePhysics
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
    b = make_block(5, 7, physics, slab, (0.1, 0.2, 0.3), 0.4, 1.5)
    assert (b.id, b.fragment, b.y, b.body.angular_velocity) == (5, 7, 1.5, 0.4)
    np.testing.assert_allclose(b.velocity, [0.1, 0.2, 0.3])
    np.testing.assert_allclose([b.body.position.x, b.body.position.y], [10.0, -3.0])
    assert b.mass == pytest.approx(8.0 * WIDTH * 850.0)
    np.testing.assert_allclose(b.momentum, b.mass * np.array([0.1, 0.2, 0.3]))
    assert b.body.mass == pytest.approx(b.mass + 0.2 * 8.0 * WIDTH * 1000.0)
    assert b.body.moment == pytest.approx(8.0 * WIDTH * (16.0 + 4.0) / 12.0 * (850.0 + 0.3 * 1000.0))
    assert b.shape.elasticity**2 == pytest.approx(0.09)
