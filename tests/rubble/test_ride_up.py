"""Blocks on slopes that lean back: the slope carries their weight, they ride over the crest or clear sideways."""

import numpy as np
import pytest

from coupling.structure import cone, plane_slope
from rubble.cut import plane, revolved
from rubble.domain import Domain
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import thrust
from rubble.sheet import SheetMotion

H, L, WIDTH, G, RHO = 0.5, 1.5, 1.0, 9.81, 916.2
SLOPE = np.radians(30)


def on_slope(mu=0.1, top=3.0, foot=0.6):
    """A layer with one block that lies on the slope, its lower end at the height ``foot``."""
    shape = plane_slope(SLOPE, top=top, toe_depth=10.0, breaking="upward")
    physics = RubblePhysics(rho_i=RHO, rho_w=999.8, thickness=H, mu_structure=mu, iterations=60)
    crest = top / np.tan(SLOPE)
    layer = RubbleLayer(
        physics,
        WIDTH,
        domain=Domain(x_max=crest + 2 * H),
        solids=lambda y: plane(convex_parts(shape.section(y, -10.0, top, 0.01)[0], back=crest + 100.0)),
    )
    along, out = np.array([np.cos(SLOPE), np.sin(SLOPE)]), np.array([-np.sin(SLOPE), np.cos(SLOPE)])
    start = foot / np.sin(SLOPE) * along + 1e-4 * out
    outline = np.array([start, start + L * along, start + L * along + H * out, start + H * out])
    ends = np.array([outline[0] @ along, outline[1] @ along])
    number = layer.add_block(0, Slab(outline, ends, np.array([WIDTH]), RHO, SLOPE))
    return layer, number, RHO * G * H * L * WIDTH


def test_the_slope_carries_the_weight_of_dry_ice():
    """Held by H = W tan(a), the block rests on the normal force alone: Fx = H, Fz = -W."""
    layer, number, weight = on_slope()
    thrust(layer, number, (weight * np.tan(SLOPE), 0.0, 0.0))
    for _ in range(40):
        layer.advance(10)
    load = layer.load_on_structure.sum(axis=0)
    assert load == pytest.approx([weight * np.tan(SLOPE), 0.0, -weight], rel=1e-3, abs=1e-9)


def test_friction_holds_it_back_on_its_way_up():
    """Pushed up slowly: H = W (sin a + mu cos a) / (cos a - mu sin a) = W xi, and Fz = -W still."""
    layer, number, weight = on_slope()
    xi = (np.sin(SLOPE) + 0.1 * np.cos(SLOPE)) / (np.cos(SLOPE) - 0.1 * np.sin(SLOPE))
    layer.block(number).velocity[:] = (0.1 * np.cos(SLOPE), 0.0, 0.1 * np.sin(SLOPE))
    thrust(layer, number, (weight * xi, 0.0, 0.0))
    for _ in range(20):
        layer.advance(10)
    assert layer.load_on_structure.sum(axis=0) == pytest.approx([weight * xi, 0.0, -weight], rel=1e-2, abs=1e-9)
    assert layer.table().velocity[0, 0] == pytest.approx(0.1 * np.cos(SLOPE), rel=0.05)


def test_a_block_that_lies_on_the_slope_is_sliding():
    layer, number, weight = on_slope()
    assert not layer.block(number).sliding
    thrust(layer, number, (weight * np.tan(SLOPE), 0.0, 0.0))
    layer.advance(10)
    assert layer.block(number).sliding


def test_over_the_crest_is_away():
    layer, number, weight = on_slope(top=2.0)
    mass = layer.mass
    thrust(layer, number, (1.3 * weight, 0.0, 0.0))
    for _ in range(200):
        if layer.cleared:
            break
        layer.advance(10)
    assert layer.cleared == [number]
    assert layer.mass + layer.gone.mass == pytest.approx(mass, rel=1e-12)


def test_without_a_push_it_slides_back_into_the_water_and_floats():
    layer, _, _ = on_slope()
    for _ in range(600):
        layer.advance(10)
    t = layer.table()
    assert t.position[0, 2] == pytest.approx(H / 2 - H * RHO / 999.8, abs=0.02)
    assert t.position[0, 0] < 0.0
    assert not layer.cleared


@pytest.mark.parametrize("y", [1.0, -1.0])
def test_on_an_upward_cone_ice_clears_sideways(y):
    shape = cone(np.radians(60), 2.5, 0.75, toe_depth=4.0, top=8.0, breaking="upward")
    physics = RubblePhysics(rho_i=RHO, rho_w=999.8, thickness=H, mu_structure=0.1)
    layer = RubbleLayer(
        physics,
        WIDTH,
        domain=Domain(x_max=3.5, y_max=20.0),
        solids=lambda at: revolved(convex_parts(*shape.section(at, -4.0, 8.0, 1e-3))),
    )
    draft = H * RHO / 999.8
    outline = np.array([(-5.0, -draft), (-3.5, -draft), (-3.5, H - draft), (-5.0, H - draft)])
    number = layer.add_block(
        int(np.sign(y)), Slab(outline, np.array([-5.0, -3.5]), np.array([WIDTH]), RHO), (0.3, 0.0), y=y
    )
    thrust(layer, number, (3.0 * RHO * G * H * L * WIDTH, 0.0, 0.0))
    highest = 0.0
    for _ in range(1200):
        if layer.cleared:
            break
        layer.advance(10)
        highest = max(highest, float(layer.table().position[0, 2])) if layer.blocks else highest
    assert layer.cleared == [number]
    assert layer.gone.momentum[1] * y > 0.0
    assert highest > 0.3  # it has ridden up on its way


def test_the_sheets_body_follows_the_row_that_comes_to_the_front():
    """Where ice has just broken off a new block lies: the edge behind it must not stand in it."""
    layer = RubbleLayer(RubblePhysics(rho_i=RHO, rho_w=999.8, thickness=H), WIDTH)
    draft = H * RHO / 999.8
    z, speed = H / 2 - draft, (0.2, 0.0)

    def edge(front):
        x = np.arange(front - 0.5, front - 20.0, -1.0)
        layer.set_sheet(0, SheetMotion(x, np.full(len(x), z), front, np.tile(speed, (len(x), 1)), H))

    edge(0.0)
    layer.advance(10)
    outline = np.array([(-5.0, -draft), (0.0, -draft), (0.0, H - draft), (-5.0, H - draft)])
    layer.add_block(0, Slab(outline, np.array([-5.0, 0.0]), np.array([WIDTH]), RHO), speed, alone=False)
    edge(-5.0)
    layer.advance(10)
    mass = RHO * H * 5.0 * WIDTH
    impulse = layer.sheet_forces(0) * 0.05
    assert np.abs(impulse).max() < 0.05 * mass * 0.2  # drag on the block, not more
    assert layer.table().velocity[0] == pytest.approx([0.2, 0.0, 0.0], abs=0.02)
