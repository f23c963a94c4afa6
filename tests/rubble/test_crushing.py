"""Contacts crush: no impulse exceeds strength times area times time, whatever presses."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import lock_rotation, thrust

WIDTH, H, STRENGTH = 2.0, 3.0, 1.0e6
WALL = np.array([(0.0, -50.0), (10.0, -50.0), (10.0, 50.0), (0.0, 50.0)])


def box(angle):
    corners = np.array([(-3.0, -1.5), (3.0, -1.5), (3.0, 1.5), (-3.0, 1.5)])
    return place(corners, 0.0, 0.0, angle, 0.0, 0.0)


def pressed(strength, angle, force, windows=1):
    """A block that is pressed on a wall, without weight or water; its largest load in a window, and the layer."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1e-9, g=0.0, thickness=H, contact_strength=strength)
    layer = RubbleLayer(physics, WIDTH, solids=lambda y: plane([WALL]))
    outline = box(angle)
    x = -float(outline[:, 0].max())
    ends = x * np.cos(angle) + np.array([-3.0, 3.0])
    layer.add_block(0, Slab(outline + np.array([x, 0.0]), ends, np.array([WIDTH]), 900.0, angle))
    thrust(layer, 0, (force, 0.0, 0.0))
    loads = []
    for _ in range(windows):
        lock_rotation(layer, 0)  # anew, as ice that comes off leaves another plate
        layer.advance(10)
        loads.append(float(layer.load_on_structure[0, 0]))
    return np.array(loads), layer


def test_a_face_carries_its_strength_times_its_area_and_no_more():
    most = STRENGTH * H * WIDTH
    loads, _ = pressed(STRENGTH, 0.0, 4.0 * most)
    assert loads == pytest.approx(most, rel=1e-6)


def test_a_face_that_is_large_enough_carries_all():
    loads, layer = pressed(STRENGTH, 0.0, 0.5 * STRENGTH * H * WIDTH, windows=20)
    assert loads[-1] == pytest.approx(0.5 * STRENGTH * H * WIDTH, rel=1e-3)
    assert layer.block(0).outline[:, 0].max() < 0.01 * H


def test_a_corner_goes_in_until_its_area_carries_the_force():
    """A corner of 90 degrees is twice as wide as it is deep: F = 2 strength w depth carries the force at rest.

    Crushed from rest it comes to twice that depth, where the work of the force is used up, if nothing else brakes it.
    """
    force = 1.0e6
    loads, layer = pressed(STRENGTH, np.pi / 4, force, windows=60)
    ahead = float(np.ptp(box(np.pi / 4)[:, 0]))  # of its rearmost corner
    depth = float(layer.block(0).outline[:, 0].min()) + ahead
    assert loads[-1] == pytest.approx(force, rel=0.05)
    still = force / (2.0 * STRENGTH * WIDTH)
    assert 0.95 * still < depth < 2.0 * still
    assert layer.crushed.mass == pytest.approx(
        900.0 * WIDTH * depth**2, rel=0.1
    )  # the corner, less what the slop leaves


def test_without_a_limit_nothing_crushes():
    loads, layer = pressed(float("inf"), np.pi / 4, 1.0e6, windows=20)
    assert loads[-1] == pytest.approx(1.0e6, rel=0.02)
    assert layer.block(0).outline[:, 0].max() < 0.01 * H
