"""When a plate slides: it has once lain along a slope near by, and nothing of the sheet presses on it."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.sheet import SheetMotion

TOLERANCE = 0.0873
FACE = np.array([(0.0, 0.0), (30.0, -30.0), (30.0, 0.0)])  # solid above a face that falls with 45 degrees


def judged(angle, length=4.0, away=1.5):
    """Whether a block whose axis lies at ``angle``, ``away`` from the slope, has aligned with it."""
    physics = RubblePhysics(rho_i=1000.0, rho_w=1000.0, thickness=1.0, g=0.0)
    layer = RubbleLayer(physics, 2.0, solids=lambda _y: plane([FACE]))
    x, z = 15.0 - away / 2**0.5, -15.0 - away / 2**0.5
    outline = place(
        np.array([(-length, -1.0), (length, -1.0), (length, 1.0), (-length, 1.0)]) / 2, x, z, angle, 0.0, 0.0
    )
    middle = x * np.cos(angle) + z * np.sin(angle)
    layer.add_block(
        0, Slab(outline, middle + np.array([-length, length]) / 2, np.array([2.0]), 1000.0, angle), alone=True
    )
    layer.advance(1)
    return layer.block(0).aligned


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_a_block_aligns_within_the_tolerance_on_both_sides(way):
    assert judged(-np.pi / 4 + way * 0.99 * TOLERANCE, away=3.0)
    assert not judged(-np.pi / 4 + way * 1.01 * TOLERANCE, away=3.0)


def test_an_axis_has_two_ends_and_a_square_two_axes():
    assert judged(-np.pi / 4 + np.pi, away=3.0)
    assert not judged(np.pi / 4, away=3.0)
    assert judged(np.pi / 4, length=1.0, away=1.5)


def test_a_slope_out_of_reach_does_not_count():
    """Its own reach, sqrt(2^2 + 0.5^2) m, and one thickness."""
    assert judged(-np.pi / 4, away=3.0)
    assert not judged(-np.pi / 4, away=3.1)


def test_a_block_under_the_sheet_slides_when_the_sheet_is_gone():
    """A gentle slope, with which a nearly flat block is aligned while it floats up against the sheet."""
    solid = np.array([(-20.0, -20.0), (20.0, -20.0), (20.0, -4.0), (-20.0, -8.4)])
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=1.0, form_drag=5.0)
    layer = RubbleLayer(physics, 2.0, solids=lambda y: plane([solid]))
    x = np.array([6.0, 3.0, 0.0, -3.0, -6.0])
    rest = np.zeros((5, 2))
    layer.set_sheet(0, SheetMotion(x, np.full(5, -4.0), 7.5, rest, 1.0))
    box = place(np.array([(-2.0, -0.5), (2.0, -0.5), (2.0, 0.5), (-2.0, 0.5)]), 0.0, -5.05, 0.03, 0.0, 0.0)
    layer.add_block(0, Slab(box, np.array([-2.2, 2.2]), np.array([2.0]), 846.0))
    for _ in range(20):
        layer.advance(10)
    assert layer.sheet_forces(0)[:, 2].sum() > 0.0
    assert (layer.block(0).aligned, layer.block(0).sliding) == (True, False)
    layer.remove_sheet(0)
    layer.advance(10)
    assert layer.block(0).sliding
