"""Friction contact by contact: the rate law, the third dimension, and the memory of pymunk that it is set in."""

import numpy as np
import pymunk
import pytest
from pymunk import batch

from rubble.arrays import filled, rows
from rubble.piece import Slab
from rubble.cut import FACE, RADIAL, plane
from rubble.friction import law_of, rate_dependent, split, tilt
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics

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


@pytest.mark.parametrize(("y", "v_s", "v_y"), [(0.0, 1.0, 0.0), (8.0, 0.3, 0.0), (-8.0, -0.3, 0.4), (9.0, 0.0, 0.2)])
def test_forces_are_three_dimensional_statics(y, v_s, v_y):
    """p, n_y and the factors against vectors: normal, slip and friction on a cone of 45 degrees and radius 10 m."""
    mu, radius = 0.25, 10.0
    x = -np.sqrt(radius**2 - y**2)
    n = np.array([x / radius, y / radius, -1.0]) / 2**0.5
    plane = np.hypot(n[0], n[2])
    m, t = np.array([n[0], 0.0, n[2]]) / plane, np.array([-n[2], 0.0, n[0]]) / plane
    e = np.cross(t, n) * np.sign(np.cross(t, n)[1])
    slip = v_s * t + v_y / e[1] * e
    force = n - mu * slip / np.linalg.norm(slip)
    on_cone = filled(FACE, [0.0, 0.0, 1.0, 1.0, *RADIAL])
    p, n_y = face = tilt(on_cone[0], x, float(m[0]), y, y)
    assert (p, n_y) == pytest.approx((plane, n[1]), rel=1e-12)
    assert n @ slip == pytest.approx(0.0, abs=1e-12)
    found, true, lateral = split(law_of(mu)[0], face, v_s, v_y)
    assert found == mu
    assert 1.0 / true == pytest.approx(force @ m, rel=1e-5)
    assert n_y - mu * p * lateral == pytest.approx(force[1], rel=1e-5, abs=1e-9)


def test_the_noted_contacts_are_pymunks_impulses():
    """Fails if another pymunk keeps its contacts elsewhere, or calls back in another way."""
    assert pymunk.version.startswith("7.3")
    face = np.array([(-20.0, -20.0), (-8.0, -8.0), (20.0, -8.0)])
    layer = RubbleLayer(RubblePhysics(thickness=1.0), WIDTH, solids=lambda y: plane([face]))
    for i in range(3):
        x, z = -15.0 - 2.5 * i, -22.0 - 2.6 * i
        box = np.array([(x - 1, z - 1), (x + 1, z - 1), (x + 1, z + 1), (x - 1, z + 1)])
        layer.add_block(0, Slab(box, np.array([x - 1, x + 1]), np.array([WIDTH]), 900.0), (0.5, 2.0), 0.1)
    section, seen = layer.section(0), 0
    for _ in range(600):
        layer.advance(1)
        buffer = batch.Buffer()
        fields = batch.ArbiterFields.BODY_A_ID | batch.ArbiterFields.BODY_B_ID | batch.ArbiterFields.TOTAL_IMPULSE
        batch.get_space_arbiters(section.space, fields, buffer)
        pair = np.frombuffer(buffer.int_buf(), np.uintp).reshape(-1, 2)
        impulse = np.frombuffer(buffer.float_buf(), np.float64).reshape(-1, 2)
        static = section.space.static_body.id
        expected = impulse[pair[:, 0] == static].sum(axis=0) - impulse[pair[:, 1] == static].sum(axis=0)
        got = rows(section.sums.block, "structure_x", 2).sum(axis=0)
        seen += np.abs(expected).max() > 0.0
        assert got == pytest.approx(expected, rel=1e-12, abs=1e-9)
    assert seen > 100
