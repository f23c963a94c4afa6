"""Pressure on one edge: force and moment against the integral over many small pieces."""

from itertools import pairwise

import numpy as np
import pytest

from rubble.arrays import filled
from rubble.pressure import EDGE, Ends, pressure_on, turned, water_energy, wetted

RHO_G, WIDTH = 9868.86, 2.8
EDGES = [
    Ends(-3.0, -1.0, 4.0, -1.5),  # an underside
    Ends(4.0, 1.0, -3.0, 0.5),  # a top
    Ends(2.0, -2.0, 2.5, 2.0),  # a side
]


def integral(e, z, n=400_000):
    """-p n over the edge, water to its right, p = -rho g depth; moment about the centre, counter-clockwise."""
    s = (np.arange(n) + 0.5) / n
    x, h = e.ax + s * (e.bx - e.ax), e.az + s * (e.bz - e.az)
    p = RHO_G * np.maximum(-(z + h), 0.0)
    nx, nz = e.bz - e.az, -(e.bx - e.ax)  # outward normal times length: to the right of the edge
    fx, fz = -p * nx * WIDTH / n, -p * nz * WIDTH / n
    return fx.sum(), fz.sum(), (x * fz - h * fx).sum()


@pytest.mark.parametrize("z", [-6.0, -1.2, 0.3, 1.2])
@pytest.mark.parametrize("ends", EDGES)
def test_force_and_moment_of_an_edge(ends, z):
    found, exact = pressure_on(ends, WIDTH, z, RHO_G), integral(ends, z)
    scale = np.abs(exact).max()
    np.testing.assert_allclose(found, exact, rtol=1e-6, atol=1e-9 * scale + 1e-9)


def test_a_slanted_edge_has_a_moment_of_its_own():
    """About its middle: rho g l_z (l_x^2 + l_z^2) / 12 per width, from the pressure that grows with depth alone."""
    found = pressure_on(Ends(-3.0, 0.5, 3.0, -0.5), WIDTH, -8.0, RHO_G)
    assert found.moment == pytest.approx(WIDTH * RHO_G * 37.0 / 12.0, rel=1e-12)


@pytest.mark.parametrize(("da", "db"), [(1.0, -3.0), (-3.0, 1.0)])
def test_the_wet_part_ends_at_the_water(da, db):
    whole = Ends(0.0, da, 8.0, db)
    wet = wetted(whole, da, db)
    dry_end = (wet.ax, wet.az) if da > 0 else (wet.bx, wet.bz)
    assert dry_end == pytest.approx((2.0 if da > 0 else 6.0, 0.0))
    assert wetted(Ends(0.0, 1.0, 8.0, 0.0), 1.0, 0.0) == (0.0, 1.0, 0.0, 1.0)
    assert wetted(Ends(0.0, -1.0, 8.0, -2.0), -1.0, -2.0) == (0.0, -1.0, 8.0, -2.0)


def test_an_edge_turns_counter_clockwise():
    edge = filled(EDGE, [[1.0, 2.0, 3.0, -1.0, 1.0, 0.0, 0.0, 0.0]])[0]
    np.testing.assert_allclose(turned(edge, 0.0, 1.0), [-2.0, 1.0, 1.0, 3.0])


@pytest.mark.parametrize("z", [-4.0, -0.4, 0.2])
def test_energy_of_the_water_is_the_depth_of_what_is_under_it(z):
    """A box of 4 x 2 m, turned by a quarter: rho g times the depth of each submerged part, per width."""
    box = [(-2.0, -1.0), (2.0, -1.0), (2.0, 1.0), (-2.0, 1.0), (-2.0, -1.0)]
    edges = filled(EDGE, [[*a, *b, WIDTH, 0.0, 0.0, 0.0] for a, b in pairwise(box)])
    for angle, half_x, half_z in ((0.0, 2.0, 1.0), (np.pi / 2, 1.0, 2.0)):
        top = min(z + half_z, 0.0)
        exact = RHO_G * WIDTH * 2.0 * half_x * 0.5 * ((z - half_z) ** 2 - top**2)
        assert water_energy(edges, 0, 4, z, angle, RHO_G) == pytest.approx(exact, rel=1e-12)
