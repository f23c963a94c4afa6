"""The wet part of an edge, and the energy of the water around a piece."""

import numpy as np
import pytest

from rubble.arrays import filled
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.pressure import EDGE, on_waterline, wet_part

WIDTH = 2.8


def edge(x0, z0, x1, z1):
    length = np.hypot(x1 - x0, z1 - z0)
    return filled(EDGE, [[x0, z0, x1, z1, WIDTH, 0.0, (x1 - x0) / length, (z1 - z0) / length]])[0]


@pytest.mark.parametrize(("za", "zb"), [(1.0, -3.0), (-3.0, 1.0)])
def test_the_wet_part_ends_at_the_water(za, zb):
    wet = wet_part(edge(0.0, za, 8.0, zb), 0.0, 0.0, 1.0)
    dry_end = (wet.ax, wet.az) if za > 0 else (wet.bx, wet.bz)
    assert dry_end == pytest.approx((2.0 if za > 0 else 6.0, 0.0))
    assert wet.length == pytest.approx(0.75 * np.hypot(8.0, 4.0))
    assert wet.depth == pytest.approx(1.5)
    assert wet_part(edge(0.0, 1.0, 8.0, 2.0), 0.0, 0.0, 1.0).length == 0.0


def test_the_nearest_point_of_the_waterline():
    x, z = on_waterline(-2.0, 0.6, 0.8, 1e3)
    assert -2.0 + 0.6 * x + 0.8 * z == pytest.approx(0.0, abs=1e-12)
    assert x * 0.8 == pytest.approx(z * 0.6)


@pytest.mark.parametrize("z", [-4.0, -0.4, 0.2])
def test_energy_of_the_water_is_the_depth_of_what_is_under_it(z):
    """A box of 4 x 2 m, upright and on its side: rho g times the depth of each submerged part, per width."""
    physics = RubblePhysics(rho_i=900.0, rho_w=1000.0, g=10.0)
    for half_x, half_z in ((2.0, 1.0), (1.0, 2.0)):
        corners = [(-half_x, -half_z), (half_x, -half_z), (half_x, half_z), (-half_x, half_z)]
        layer = RubbleLayer(physics, WIDTH)
        slab = Slab(np.array(corners) + np.array([0.0, z]), np.array([-half_x, half_x]), np.array([WIDTH]), 900.0)
        layer.add_block(0, slab)
        top = min(z + half_z, 0.0)
        water = 1e4 * WIDTH * 2.0 * half_x * 0.5 * ((z - half_z) ** 2 - top**2)
        weight = layer.mass * (10.0 * z - physics.afloat)
        assert layer.runner.parts_of(layer.block(0))[1] == pytest.approx(water + weight, rel=1e-12)
