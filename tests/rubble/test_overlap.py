"""Overlap: what a contact gives back is what its ends have moved into, and no harder than the contact pushes."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.halves import halves
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.plates import orient_all
from rubble.rows import STRUCTURE
from rubble.solver import begin, solve
from rubble.team import ALONE

WIDTH, H, LENGTH = 2.0, 3.0, 6.0
RIGHT = np.array([(0.0, -50.0), (10.0, -50.0), (10.0, 50.0), (0.0, 50.0)])
LEFT = RIGHT - np.array([10.0 + LENGTH - 0.2, 0.0])  #: 0.2 m too near for a block between both
ABOVE = 100.0  #: where blocks are made, as none is made inside of a wall [m]


def beside(depth, speed=0.0, walls=(RIGHT,), **options):
    """A block without weight or water that stands so deep in the wall and moves towards it."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1e-9, g=0.0, thickness=H, restitution=0.0, **options)
    layer = RubbleLayer(physics, WIDTH, solids=lambda y: plane(walls))
    box = np.array([(-LENGTH, -H / 2), (0.0, -H / 2), (0.0, H / 2), (-LENGTH, H / 2)]) + np.array([0.0, ABOVE])
    layer.add_block(0, Slab(box, np.array([-LENGTH, 0.0]), np.array([WIDTH]), 900.0, 0.0), velocity=(speed, 0.0))
    layer.store.plates.position[0] += (depth, 0.0, -ABOVE)
    return layer


def depth_of(layer):
    return float(layer.block(0).outline[:, 0].max())


def test_overlap_that_is_found_stays_and_costs_nothing():
    layer = beside(0.3)
    layer.advance(200)
    assert depth_of(layer) == pytest.approx(0.3, abs=1e-9)
    assert float(layer.runner.books["correction"][0]) == 0.0
    layer.store.plates.position[0, 0] += 0.1  # as a slice that is cut anew is found deeper
    layer.advance(200)
    assert depth_of(layer) == pytest.approx(0.4, abs=1e-9)


def pressed(layer, force):
    """The same with a force that presses its block to the right [N]."""
    plate = layer.store.list[0]
    layer.store.take(plate)
    plate.thrust[0] = force
    layer.store.add(plate)
    return layer


def test_overlap_that_was_moved_into_is_given_back_as_fast_as_the_contact_pushes():
    """By what its force F moves a mass m in a sub-step from rest, F dt / m, down to the slop; not at all without F."""
    for force in (1e5, 0.0):
        layer = pressed(beside(-0.01, speed=20.0), force)
        layer.advance(3)  # it has been stopped
        deep, speed = depth_of(layer), force * layer.physics.substep / layer.store.list[0].mass
        assert deep > 0.08
        layer.advance(200)
        assert deep - depth_of(layer) == pytest.approx(200 * layer.physics.substep * speed, rel=1e-3, abs=1e-4)
        layer.advance(2000)
        assert depth_of(layer) < 1.1 * layer.physics.slop or force == 0.0


def shifted(force, speed_right, speed_left):
    """Solved sub-step of a block in a gap 0.2 m too narrow, which a force presses to the right [N].

    Returns shift and impulse on both walls together, right first, and the speed to the right with which it moves [m/s].
    """
    layer = pressed(beside(0.1, walls=(RIGHT, LEFT)), force)
    layer.advance(1)
    rows, count = layer.runner._rows[int(layer.runner._counted[1]) % 2], layer.runner.contacts
    point, normal = rows.point[:count], rows.way["x"][:count, 0]
    assert (point["kind"] == STRUCTURE).all()
    assert (np.abs(normal) > 0.99).all()
    point["shift_speed"] = np.where(normal < 0.0, speed_right, speed_left)
    plates, mass = layer.store.plates, layer.store.list[0].mass
    rows.way["impulse"][:count], plates.motion["x"][0] = 0.0, force * layer.physics.substep / mass
    parts = halves(count)
    begin(rows, count, plates, layer.runner.edges, parts)
    solve(ALONE, rows, parts, plates, layer.runner.edges, 100)
    sides = [normal < 0.0, normal > 0.0]
    shift = [point["shift"][side].sum() for side in sides]
    impulse = [rows.way["impulse"][:count, 0][side].sum() for side in sides]
    return shift, impulse, plates.shift["x"][0], mass


@pytest.mark.parametrize("force", [1e4, 1e6])
def test_a_shift_pushes_no_harder_than_its_contact(force):
    """Both walls would push the block out, in vain and ever harder."""
    shift, impulse, _, _ = shifted(force, 0.5, 0.5)
    assert max(shift) <= sum(impulse)  # its own, and what holds against the other one
    assert max(shift) > 0.5 * force * RubblePhysics().substep


@pytest.mark.parametrize("force", [1e4, 1e6])
def test_no_shift_moves_a_block_deeper_into_the_structure(force):
    """The right wall gives back what it is owed; the left one carries little, and holds against it all the same.

    If it pushed no harder than it carries the block would go into it with nine tenths of F dt / m.
    """
    (right, left), impulse, speed, mass = shifted(force, 0.5, 0.0)
    assert impulse[1] < 0.11 * impulse[0]
    assert left == pytest.approx(right, rel=1e-6)
    assert abs(speed) < 1e-6 * force * RubblePhysics().substep / mass


def test_plates_that_slide_along_an_oblique_face_come_no_nearer():
    """Both are yawed by 30 degrees and one slides along the other: within a window their slices move aside, the face
    of the other recedes, and nothing is to be given back. In the planes of the sections alone they come 0.12 m nearer.
    """
    physics = RubblePhysics(rho_i=900.0, rho_w=1e-9, g=0.0, thickness=H, restitution=0.0, mu_ice_ice=0.0)
    layer = RubbleLayer(physics, WIDTH)
    box = np.array([(-LENGTH / 2, -H / 2), (LENGTH / 2, -H / 2), (LENGTH / 2, H / 2), (-LENGTH / 2, H / 2)])
    yaw = np.radians(30.0)
    n, t = np.array([np.cos(yaw), np.sin(yaw), 0.0]), np.array([-np.sin(yaw), np.cos(yaw), 0.0])
    for i in range(2):
        away = np.array([20.0 * i, 0.0])
        layer.add_block(0, Slab(box + away, away[0] + np.array([-3.0, 3.0]), np.array([6.0]), 900.0, 0.0))
    plates = layer.store.plates
    plates.quaternion[:2], plates.position[1] = (np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)), (LENGTH - 1e-3) * n
    orient_all(plates)
    plates.velocity[1, :3] = 0.5 * t
    layer.advance(100)
    assert layer.runner.contacts > 0
    assert plates.position[1] == pytest.approx((LENGTH - 1e-3) * n + 100 * physics.substep * 0.5 * t, abs=1e-9)
