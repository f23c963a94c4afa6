"""The top of a block that is pushed down: dry, flooded, or filling with time."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.energy import mechanical_energy
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab

RHO_I, RHO_W, G, H, LENGTH, WIDTH, TIME = 846.0, 1006.0, 9.81, 3.0, 10.0, 2.8, 4.0
AREA = LENGTH * WIDTH


def held(backfill, depth, seconds, **physics):
    """A block whose top is held ``depth`` under water by a lid; the force on the lid, and the layer."""
    lid = np.array([(-20.0, -depth), (20.0, -depth), (20.0, 30.0), (-20.0, 30.0)])
    layer = RubbleLayer(
        RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, backfill=backfill, filling_time=TIME, **physics),
        WIDTH,
        solids=lambda y: plane([lid]),
    )
    outline = np.array([(-5.0, -depth - H), (5.0, -depth - H), (5.0, -depth), (-5.0, -depth)])
    layer.add_block(0, Slab(outline, np.array([-5.0, 5.0]), np.array([WIDTH]), RHO_I))
    for _ in range(round(seconds / 0.05)):
        layer.advance(10)
    return float(layer.load_on_structure[0, 2]), layer


def lift(depth, share):
    """Water from below on the underside, the share of the head on the top, weight [N]."""
    return (RHO_W * G * (depth + H - share * depth) - RHO_I * G * H) * AREA


@pytest.mark.parametrize(("backfill", "share"), [("full", 1.0), ("none", 0.0)])
@pytest.mark.parametrize("depth", [0.5, 4.0])
def test_lift_of_a_dry_and_of_a_flooded_block(backfill, share, depth):
    force, _ = held(backfill, depth, 4.0)
    assert force == pytest.approx(lift(depth, share), rel=1e-3)


@pytest.mark.parametrize("seconds", [1.0, 2.0, 3.0, 6.0])
def test_a_top_fills_in_its_time(seconds):
    force, layer = held("filling", 2.0, seconds)
    share = min(1.0, (seconds - 0.025) / TIME)
    assert force == pytest.approx(lift(2.0, share), rel=3e-3)
    assert layer.block(0).flooded == pytest.approx(min(1.0, seconds / TIME), rel=1e-9)


def test_a_top_out_of_the_water_drains():
    layer = RubbleLayer(RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, backfill="filling"), WIDTH)
    outline = np.array([(-5.0, -2.5), (5.0, -2.5), (5.0, 0.5), (-5.0, 0.5)])
    layer.add_block(0, Slab(outline, np.array([-5.0, 5.0]), np.array([WIDTH]), RHO_I), flooded=True)
    layer.advance(10)
    assert layer.block(0).flooded == 0.0


def test_old_rubble_is_flooded_and_new_pieces_are_dry():
    layer = RubbleLayer(RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, backfill="none"), WIDTH)
    outline = np.array([(-5.0, -5.0), (5.0, -5.0), (5.0, -2.0), (-5.0, -2.0)])
    for i, flooded in enumerate((None, True)):
        layer.add_block(
            0, Slab(outline - [0.0, 20.0 * i], np.array([-5.0, 5.0]), np.array([WIDTH]), RHO_I), flooded=flooded
        )
    assert [b.flooded for b in layer.blocks] == [0.0, 1.0]


def books(sign=1.0):
    """Energy of a dry block that bobs without drag: start and end, with the work of its dry top."""
    layer = RubbleLayer(
        RubblePhysics(
            rho_i=RHO_I, rho_w=RHO_W, thickness=H, backfill="none", form_drag=0.0, skin_drag=0.0, substep=0.001
        ),
        WIDTH,
    )
    outline = np.array([(-5.0, -4.5), (5.0, -4.5), (5.0, -1.5), (-5.0, -1.5)])
    layer.add_block(0, Slab(outline, np.array([-5.0, 5.0]), np.array([WIDTH]), RHO_I), (0.0, 0.0), 0.02)
    start = mechanical_energy(layer)
    layer.advance(2000)
    end = mechanical_energy(layer)
    return start["kinetic"] + start["potential"], end["kinetic"] + end["potential"] - sign * end["dry"], end["dry"]


def test_the_work_of_a_dry_top_closes_the_energy():
    start, end, work = books()
    assert work > 1e5
    assert abs(end - start) < 0.01 * work
    assert abs(books(-1.0)[1] - start) > work
