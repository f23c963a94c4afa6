"""When a block slides: it has once lain along a slope near by, and nothing of the sheet presses on it."""

import numpy as np
import pytest

from rubble.arrays import filled
from rubble.piece import Slab
from rubble.bodies import STATE
from rubble.contacts import ON_BLOCK
from rubble.cut import FACE, plane
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.phases import AXIS, STATUS, update_phases
from rubble.physics import RubblePhysics
from rubble.sheet import SheetMotion

TOLERANCE = 0.0873
SLOPE = filled(FACE, [[0.0, 0.0, -10.0, 10.0, 0.0, 0.0]])  # a face that falls from left to right with 45 deg


def judged(angle, sheet=0.0, x=-7.0, z=5.0, aligned=0, period=np.pi, direction=0.0, reach=3.0):
    """A block whose axis lies at ``angle``, sqrt(2) m from the slope's middle: (aligned, sliding) and what changed."""
    status = np.zeros(1, STATUS)
    status["aligned"] = aligned
    impulse = np.zeros(1, ON_BLOCK)
    impulse["sheet"] = sheet
    axis = filled(AXIS, [[reach, direction, period]])
    changed = update_phases(SLOPE, axis, filled(STATE, [[x, z, angle, 0, 0, 0]]), impulse, TOLERANCE, status)
    return bool(status["aligned"][0]), bool(status["sliding"][0]), changed


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_a_block_aligns_within_the_tolerance_on_both_sides(way):
    assert judged(-np.pi / 4 + way * 0.99 * TOLERANCE) == (True, True, True)
    assert judged(-np.pi / 4 + way * 1.01 * TOLERANCE) == (False, False, False)


def test_an_axis_has_two_ends():
    assert judged(-np.pi / 4 + np.pi) == (True, True, True)
    assert judged(-np.pi / 4 - 5 * np.pi) == (True, True, True)
    assert judged(np.pi / 4) == (False, False, False)
    assert judged(np.pi / 4, period=np.pi / 2) == (True, True, True)  # a square has two long axes


def test_the_axis_counts_not_the_body():
    assert judged(0.0, direction=-np.pi / 4) == (True, True, True)
    assert judged(-np.pi / 4, direction=-np.pi / 4) == (False, False, False)


def test_a_slope_out_of_reach_does_not_count():
    """5 / sqrt(2) = 3.54 m away."""
    assert judged(-np.pi / 4, x=-10.0, z=5.0, reach=3.55) == (True, True, True)
    assert judged(-np.pi / 4, x=-10.0, z=5.0, reach=3.52) == (False, False, False)


def test_a_block_that_the_sheet_presses_on_has_not_left_it():
    assert judged(-np.pi / 4, sheet=1e-6) == (True, False, True)
    assert judged(-np.pi / 4, sheet=1e-6, aligned=1) == (True, False, False)
    assert judged(-np.pi / 4, sheet=0.0, aligned=1) == (True, True, True)


def test_a_block_that_has_aligned_once_slides_when_it_leaves_the_sheet():
    assert judged(0.5, sheet=0.0, aligned=1) == (True, True, True)


def test_a_block_under_the_sheet_slides_when_the_sheet_is_gone():
    """A gentle slope, with which a nearly flat block is aligned while it floats up against the sheet."""
    solid = np.array([(-20.0, -20.0), (20.0, -20.0), (20.0, -4.0), (-20.0, -8.4)])
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=1.0, form_drag=5.0)
    layer = RubbleLayer(physics, 2.0, solids=lambda y: plane([solid]))
    x = np.array([6.0, 3.0, 0.0, -3.0, -6.0])
    rest = np.zeros((5, 2))
    layer.set_sheet(0, SheetMotion(x, np.full(5, -4.0), 7.5, rest, 1.0, (1e8, 1e8), (5e4, 5e4)))
    box = place(np.array([(-2.0, -0.5), (2.0, -0.5), (2.0, 0.5), (-2.0, 0.5)]), 0.0, -5.05, 0.03, 0.0, 0.0)
    layer.add_block(0, Slab(box, np.array([-2.2, 2.2]), np.array([2.0]), 846.0))
    for _ in range(20):
        layer.advance(10)
    assert layer.sheet_forces(0)[:, 1].sum() > 0.0
    assert (layer.block(0).aligned, layer.block(0).sliding) == (True, False)
    layer.remove_sheet(0)
    layer.advance(10)
    assert layer.block(0).sliding
