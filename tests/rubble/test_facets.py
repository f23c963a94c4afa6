"""Faces that look out of the section's plane: force balance on them by hand, and where a contact looks for its face."""

import numpy as np
import pytest

from rubble.cut import Bearing, faceted, plane, revolved
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import lock_rotation, thrust

WIDTH, H, PUSH = 2.0, 1.0, 2e4  # so that friction does not stop a block in a window
LOWER, UPPER = np.radians(20.0), np.radians(-35.0)  #: horizontal bearings of the two facets of a wall
BELOW = np.array([(0.0, -20.0), (5.0, -20.0), (5.0, 0.0), (0.0, 0.0)])
ABOVE = BELOW + np.array([0.0, 20.0])


def wall(_y):
    """A vertical wall that looks to one side below z = 0 and to the other above it."""
    return faceted([BELOW, ABOVE], lambda _x, z: Bearing(np.tan(LOWER if z < 0.0 else UPPER), 0.0))


def pressed(mu, along, *, turns=False):
    """Loads (2, 3) on the wall by a plate below and one above, pressed on it with `PUSH` while they slip along it."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1e-9, g=0.0, thickness=H, mu_structure=mu, form_drag=0.0, skin_drag=0.0)
    layer = RubbleLayer(physics, WIDTH, solids=wall)
    for z, psi in ((-10.0, LOWER), (10.0, UPPER)):
        box = np.array([(-2.0, z - 1.0), (0.0, z - 1.0), (0.0, z + 1.0), (-2.0, z + 1.0)])
        velocity = along * np.sign(-psi) * np.array([-np.sin(psi), np.cos(psi), 0.0])
        slab = Slab(box, np.array([-2.0, 0.0]), np.array([WIDTH]), 900.0)
        number = layer.add_block(0, slab, velocity.tolist())
        thrust(layer, number, (PUSH, 0.0, 0.0))
    for block in [] if turns else layer.blocks:
        lock_rotation(layer, block.id)
    for _ in range(4):
        layer.advance(10)
    return layer, layer.load_on_structure


@pytest.mark.parametrize("mu", [0.0, 0.2])
@pytest.mark.parametrize("along", [0.5, 0.8])
def test_force_balance_on_a_facet(mu, along):
    """Outward normal is n = -(cos psi, sin psi, 0), slip along t = (-sin psi, cos psi, 0) to where it recedes.

    A plate is free to slide, so N = PUSH cos psi; on the structure act -N n and mu N t to the side of the slip.
    """
    _, load = pressed(mu, along)
    for (fx, fy, fz), psi in zip(load, (LOWER, UPPER), strict=True):
        c, s, side = np.cos(psi), np.sin(psi), np.sign(-psi)
        normal = PUSH * c
        assert fx == pytest.approx(normal * (c - mu * s * side), rel=1e-3)
        assert fy == pytest.approx(normal * (s + mu * c * side), rel=2e-3)
        assert abs(fz) < 1e-3 * PUSH


def test_a_facet_that_looks_along_the_drift_pushes_nobody_aside():
    assert plane([BELOW]).faces["constant"].any() == revolved([BELOW]).faces["constant"].any() == 0.0
    _, load = pressed(0.0, 0.0)
    assert load[:, 1] == pytest.approx(0.5 * PUSH * np.sin([2 * LOWER, 2 * UPPER]), rel=2e-3)


def test_one_face_stands_for_all_of_the_same_bearing():
    assert len(plane([BELOW, ABOVE]).bearings) == len(revolved([BELOW, ABOVE]).bearings) == 1
    assert len(wall(0.0).bearings) == len(wall(0.0).faces) == 6
    assert len(plane(()).bearings) == 1


def test_where_a_block_presses_is_kept():
    """The mean place of its contacts: on the wall, at the height of the block's middle; nan far from the wall."""
    layer, _ = pressed(0.0, 0.0, turns=True)
    layer.add_block(
        0, Slab(np.array([(-9.0, 0.0), (-7.0, 0.0), (-7.0, 2.0)]), np.array([-9.0, -7.0]), np.ones(1), 900.0)
    )
    layer.advance(10)
    centres = layer.contact_centres()
    assert centres[:2, [0, 2]] == pytest.approx(np.array([(0.0, -10.0), (0.0, 10.0)]), abs=0.02)
    assert centres[:2, 1] == pytest.approx(layer.table().position[:2, 1], abs=0.02)
    assert np.isnan(centres[2]).all()
