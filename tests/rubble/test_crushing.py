"""Contacts crush: pressure stays below the strength, the ice that is lost is booked."""

import numpy as np
import pytest

from rubble.piece import Slab
from rubble.crushing import depth_for
from rubble.cut import plane
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.rig import lock_rotation, thrust

WIDTH, H, FORCE, STRENGTH = 2.0, 3.0, 2.0e6, 1.0e6
WALL = np.array([(0.0, -50.0), (10.0, -50.0), (10.0, 50.0), (0.0, 50.0)])


def pressed(strength=STRENGTH, angle=np.pi / 4, windows=100, force=FORCE):
    """A block that is pressed on a wall with its corner, without weight or water."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1e-9, g=0.0, thickness=H, contact_strength=strength)
    layer = RubbleLayer(physics, WIDTH, solids=lambda y: plane([WALL]))
    box = place(np.array([(-3.0, -1.5), (3.0, -1.5), (3.0, 1.5), (-3.0, 1.5)]), 0.0, 0.0, angle, 0.0, 0.0)
    x = -float(box[:, 0].max())
    layer.add_block(
        0, Slab(box + np.array([x, 0.0]), x * np.cos(angle) + np.array([-3.0, 3.0]), np.array([WIDTH]), 900.0, angle)
    )
    lock_rotation(layer, 0)
    layer.block(0).body.mass = 1e5
    thrust(layer, 0, force)
    for _ in range(windows):
        layer.advance(10)
    return layer


def face_on_wall(layer):
    """Length of the block's edge along the wall [m]."""
    outline = layer.block(0).outline
    on = outline[outline[:, 0] > outline[:, 0].max() - 1e-6]
    return float(np.ptp(on[:, 1])) if len(on) > 1 else 0.0


def test_a_corner_crushes_until_its_area_carries_the_force():
    layer = pressed()
    before = 6.0 * 3.0 * WIDTH * 900.0
    chord = face_on_wall(layer)
    assert chord == pytest.approx(FORCE / STRENGTH / WIDTH, rel=0.1)
    assert FORCE / (chord * WIDTH) <= 1.05 * STRENGTH
    assert layer.crushed.mass == pytest.approx(chord**2 / 4 * WIDTH * 900.0, rel=0.02)  # the corner, 90 degrees
    assert layer.mass + layer.crushed.mass == pytest.approx(before, rel=1e-12)
    assert layer.load_on_structure[0, 0] == pytest.approx(FORCE, rel=0.02)


def test_without_a_limit_nothing_crushes():
    layer = pressed(float("inf"))
    assert layer.crushed.mass == 0.0
    assert face_on_wall(layer) == 0.0


def test_a_face_that_is_large_enough_does_not_crush():
    assert pressed(angle=0.0).crushed.mass == 0.0


def test_a_whole_face_recedes_when_it_is_too_small():
    layer = pressed(angle=0.0, force=4.0 * STRENGTH * H * WIDTH, windows=20)
    assert layer.crushed.mass > 0.0
    assert layer.mass > 0.0


def test_crushed_ice_takes_its_momentum_along():
    layer = pressed(windows=0)
    layer.block(0).body.velocity, layer.block(0).v_y = (0.3, 1.0), 0.5
    layer.advance(10)
    lost = layer.crushed.mass
    assert lost > 0.1
    assert layer.crushed.momentum == pytest.approx(lost * np.array([*layer.table().velocity[0]]), rel=1e-9, abs=1e-6)


def test_how_deep_a_corner_and_a_face_are_cut():
    ahead, corner, flat = np.array([1.0, 0.0]), pressed(float("inf"), windows=1), pressed(angle=0.0, windows=1)
    lacking, depth = depth_for(corner.block(0), ahead, 1.0, 1e5, 0.05)
    assert lacking == pytest.approx(1.0 / WIDTH / 2.0, rel=1e-6)  # chord = 2 depth at a right angle
    assert depth == pytest.approx(0.5 * 1e5 / 1e5 * 0.05, rel=1e-6)  # 2 MN move 100 t by 25 mm in a window
    assert depth_for(flat.block(0), ahead, 1.0, 1e5, 0.05)[0] == pytest.approx(0.0, abs=1e-6)
    assert depth_for(flat.block(0), ahead, 10.0, 1e5, 0.05)[0] == np.inf


@pytest.mark.parametrize("count", [70, 150])
def test_every_overloaded_block_crushes_however_many_there_are(count):
    """Blocks one above the other, each pressed on the wall with its corner, in one section and one window."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1e-9, g=0.0, thickness=H, contact_strength=STRENGTH)
    wall = np.array([(0.0, -10.0), (10.0, -10.0), (10.0, 4.0 * count), (0.0, 4.0 * count)])
    layer = RubbleLayer(physics, WIDTH, solids=lambda _y: plane([wall]))
    half, ends = 1.0, np.array([-1.0, 1.0])
    diamond = half * np.array([(-1.0, 0.0), (0.0, -1.0), (1.0, 0.0), (0.0, 1.0)])
    for i in range(count):
        layer.add_block(0, Slab(diamond + np.array([-half, 3.0 * i]), ends * half - half, np.array([WIDTH]), 900.0))
        thrust(layer, i, FORCE)
    before = layer.table().mass
    layer.advance(10)
    assert len(layer.section(0).overloads) == count
    assert (layer.table().mass < before - 0.1).all()
    assert layer.mass + layer.crushed.mass == pytest.approx(before.sum(), rel=1e-12)
