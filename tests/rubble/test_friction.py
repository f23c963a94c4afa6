"""Friction contact by contact: the rate law, the third dimension, and the memory of pymunk that it is set in."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.friction import rate_dependent
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab

WIDTH = 2.0


@pytest.mark.parametrize(("v", "mu"), [(0.0, 0.7), (1e-6, 0.7), (1e-4, 0.4), (1e-2, 0.1), (-1e-2, 0.1), (1.0, 0.1)])
def test_rate_dependent_friction(v, mu):
    assert rate_dependent(v) == pytest.approx(mu, rel=1e-12)


def sliding(mu, slope, velocity, seconds=0.5):
    """Velocity down an upward slope in air after a while."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=1.0, mu_structure=mu, form_drag=0.0, skin_drag=0.0)
    face = np.array([(0.0, 0.0), (100.0, 100.0 * np.tan(slope))])
    layer = RubbleLayer(physics, WIDTH, solids=lambda y: plane(convex_parts(face, back=300.0)))
    x, c, s = 50.0, np.cos(slope), np.sin(slope)
    z = x * np.tan(slope) - 0.002
    box = place(np.array([(-2.0, 0.0), (2.0, 0.0), (2.0, 1.0), (-2.0, 1.0)]), x, z, slope, 0.0, 0.0)
    layer.add_block(
        0,
        Slab(box, x * c + z * s + np.array([-2.0, 2.0]), np.array([WIDTH]), 846.0, slope),
        (-velocity * c, -velocity * s),
    )
    layer.advance(round(seconds / physics.substep))
    v = layer.table().velocity[0]
    return float(np.hypot(v[0], v[2]))


def test_a_slow_block_holds_where_a_fast_one_slides_on():
    """25 degrees: tan = 0.47 lies between 0.1 of a fast and 0.7 of a slow contact."""
    slope = np.radians(25.0)
    assert sliding("rate-dependent", slope, 0.0, 5.0) < 1e-6
    fast = sliding("rate-dependent", slope, 0.5)
    assert fast == pytest.approx(0.5 + 9.81 * (np.sin(slope) - 0.1 * np.cos(slope)) * 0.5, rel=1e-3)
    slowed = 0.5 - 9.81 * (0.7 * np.cos(slope) - np.sin(slope)) * 0.1
    assert sliding(0.7, slope, 0.5, 0.1) == pytest.approx(slowed, rel=0.01)
