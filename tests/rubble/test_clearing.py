"""A steady feed of ice comes to a steady state: what arrives leaves, around the neck and under the toe."""

import numpy as np
import pytest

from coupling.structure import cone
from rubble.cut import revolved
from rubble.domain import Domain
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import thrust

H, WIDTH, WINDOW = 2.0, 4.0, 10
PUSH = 1.2e5  #: thrust on each block, twice what it takes to push one of 50 kN buoyancy down a slope of 45 degrees [N]


def feed(seconds, every=20.0, push=PUSH, rho_w=1006.0):
    """Five sections get a block each time; returns the layer, what was fed, and afloat, cleared, Fx per window."""
    shape = cone(np.radians(45), 10.0, 6.0, top=5.0, toe_depth=8.0)
    physics = RubblePhysics(rho_i=846.0, rho_w=rho_w, thickness=H, added_mass=0.2, added_inertia=0.2)
    layer = RubbleLayer(
        physics,
        WIDTH,
        domain=Domain(x_max=14.0, depth=60.0, y_max=30.0),
        solids=lambda y: revolved(convex_parts(*shape.section(y, shape.bottom, shape.top, 1e-3))),
    )
    random, draft, fed, rows = np.random.default_rng(1), H * 846 / rho_w, [], []
    for window in range(round(seconds / 0.05)):
        if window % round(every / 0.05) == 0:
            for key in range(-2, 3):
                x, y = -32.0 + random.uniform(-1, 1), layer.centre(key)
                outline = np.array([(x - 2, -draft), (x + 2, -draft), (x + 2, H - draft), (x - 2, H - draft)])
                number = layer.add_block(
                    key, Slab(outline, np.array([x - 2, x + 2]), np.array([WIDTH]), 846.0), (0.3, 0.0), y=y
                )
                thrust(layer, number, (push, 0.0, 0.0))
                fed.append(layer.block(number).mass)
        layer.advance(WINDOW)
        rows.append((layer.mass, layer.gone.mass, layer.load_on_structure[:, 0].sum() if layer.blocks else 0.0))
    return layer, np.array(fed), np.array(rows)


def check_steady(layer, fed, rows, tolerance):
    half = len(rows) // 2
    rate = (rows[-1, 1] - rows[half, 1]) / (fed.sum() / 2)
    assert rate == pytest.approx(1.0, abs=tolerance)  # what arrives leaves
    assert rows[half:, 0].max() < 2.0 * rows[:half, 0].max()  # nothing gathers
    assert layer.mass + layer.gone.mass + layer.crushed.mass == pytest.approx(fed.sum(), rel=1e-12)
    assert rows[half:, 2].mean() > 5e4
    return {int(i) for i in layer.cleared}


def test_a_steady_feed_leaves():
    layer, fed, rows = feed(240.0)
    check_steady(layer, fed, rows, 0.4)


@pytest.mark.slow
def test_a_steady_feed_comes_to_a_steady_state():
    layer, fed, rows = feed(1800.0)
    check_steady(layer, fed, rows, 0.03)


def test_a_block_passes_under_the_toe():
    """Below the toe nothing stands in the way; above it the neck does."""
    shape = cone(np.radians(45), 10.0, 6.0, top=5.0, toe_depth=8.0)
    layer = RubbleLayer(
        RubblePhysics(rho_i=1006.0, rho_w=1006.0, thickness=H, form_drag=0.0, skin_drag=0.0),
        WIDTH,
        domain=Domain(x_max=14.0),
        solids=lambda y: revolved(convex_parts(*shape.section(y, shape.bottom, shape.top, 1e-3))),
    )
    for z in (-7.0, -9.1):
        outline = np.array([(-12, z - 1), (-8, z - 1), (-8, z + 1), (-12, z + 1)], dtype=float)
        layer.add_block(0, Slab(outline, np.array([-12.0, -8.0]), np.array([WIDTH]), 1006.0), (0.5, 0.0))
    for _ in range(1200):
        layer.advance(10)
    assert layer.cleared == [1]
    assert layer.table().position[0, 0] < -7.0
