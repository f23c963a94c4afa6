"""Pieces meet a body of revolution in three dimensions: depths, points and normals by sampling, and a flank passed."""

import itertools

import numpy as np
import pytest

from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.plates import orient_all
from rubble.round import closed, deepest, depth_at, is_beside, spot_at, widest_between
from tests.rubble.cone_scene import WIDTH, H, cone_cut, rectangle

GENERATOR = np.array([(-20.0, 5.0), (-10.0, 5.0), (5.0, 20.0)])  #: of `cone_scene.cone_cut`
BODY = closed(GENERATOR)
STILL = RubblePhysics(rho_i=846.0, rho_w=846.0, g=1e-9, form_drag=0.0, skin_drag=0.0, thickness=H, mu_structure=0.0)


def radius(z):
    return np.interp(z, *GENERATOR.T)


def sampled(rho, z):
    """Distance to the surface by brute force."""
    a = np.concatenate([np.column_stack(np.linspace(p, q, 20001).T) for p, q in itertools.pairwise(BODY)])
    return float(np.hypot(a[:, 0] - rho, a[:, 1] - z).min())


@pytest.mark.parametrize(
    ("rho", "z"), [(14.0, 0.0), (10.0, -4.0), (4.0, -15.0), (4.9, -9.0), (18.0, 4.5), (1.0, -19.5)]
)
def test_depth_is_the_distance_to_the_surface(rho, z):
    depth, n_rho, n_z = depth_at(BODY, rho, z)
    assert depth == pytest.approx(sampled(rho, z), rel=1e-4)
    assert np.hypot(n_rho, n_z) == pytest.approx(1.0, rel=1e-12)
    assert depth_at(BODY, rho + 1.001 * depth * n_rho, z + 1.001 * depth * n_z)[0] < 1e-3 * depth  # out that way


@pytest.mark.parametrize(("rho", "z"), [(15.1, 0.0), (5.1, -15.0), (3.0, 5.1), (3.0, -20.1)])
def test_outside_there_is_no_depth(rho, z):
    assert depth_at(BODY, rho, z)[0] < 0.0


def test_the_body_is_as_wide_between_two_heights_as_sampling_finds_it():
    """Below, within and above; an edge farther away than that has no point in the body, and few others have none."""
    random, fine = np.random.default_rng(5), np.linspace(-20.0, 5.0, 200001)
    for low, high in np.sort(random.uniform(-24.0, 9.0, (200, 2)), axis=1):
        inside = fine[(fine >= low) & (fine <= high)]
        widest = radius(inside).max() if len(inside) else -np.inf
        assert widest_between(BODY, low, high) == pytest.approx(widest, abs=2e-4)
    told = missed = 0
    for _ in range(2000):
        p, q = random.uniform([-25.0, -25.0, -24.0], [25.0, 25.0, 9.0], (2, 3))
        p, q = p, p + random.uniform(0.02, 0.3) * (q - p)
        points = p + np.linspace(0.0, 1.0, 101)[:, None] * (q - p)
        touches = max(depth_at(BODY, np.hypot(x, y), z)[0] for x, y, z in points) > 0.0
        beside = is_beside(BODY, spot_at(BODY, *p), spot_at(BODY, *q))
        assert not (beside and touches)
        told, missed = told + beside, missed + (not beside and not touches)
    assert told > 5 * missed > 0


def test_an_edge_stands_deepest_where_sampling_finds_it():
    """Edges across the flank, level and tilted; a corner is the deepest where nothing between is.

    Not so deep that another part of the surface is nearer than the one through which they have come.
    """
    random, between = np.random.default_rng(12), 0
    for _ in range(1000):
        p, q = random.uniform([-16.0, 4.0, -8.0], [16.0, 13.0, 3.0], (2, 3))
        found = deepest(BODY, spot_at(BODY, *p), spot_at(BODY, *q))
        s = np.linspace(0.0, 1.0, 501)[:, None]
        depths = [depth_at(BODY, np.hypot(x, y), z)[0] for x, y, z in p + s * (q - p)]
        if 0.0 < max(depths) < 1.0:
            assert found.depth == pytest.approx(max(depths), abs=2e-3)
            between += 0 < int(np.argmax(depths)) < 500
    assert between > 50


BOX = np.array(list(itertools.product((-2.25, 2.25), (-WIDTH, WIDTH), (-H / 2, H / 2))))  #: corners of the block


def deepest_corner(plates):
    """How deep a corner of the block stands in the cone [m]."""
    corners = plates.position[0] + BOX @ plates.rotation[0].T
    return max(depth_at(BODY, np.hypot(x, y), z)[0] for x, y, z in corners)


def passing(generator, pitch, yaw=0.0):
    """A block that is carried along the flank of the cone, 11 m to the side; depths of its corners in the cone."""
    layer = RubbleLayer(STILL, pitch, solids=cone_cut, generator=generator)
    outline, depths = rectangle(-20.25, -3.2, -15.75, -0.2), []
    layer.add_block(1, Slab(outline, np.array([-20.25, -15.75]), np.array([2.0 * WIDTH]), 846.0), (1.0, 0.0), y=11.0)
    plate, plates = layer.store.list[0], layer.store.plates
    layer.store.take(plate)
    plate.thrust[:3] = plate.mass * np.array([0.2, 0.0, 0.2])  # against the cone, and up
    layer.store.add(plate)
    plates = layer.store.plates
    plates.quaternion[0] = np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)
    orient_all(plates)
    assert deepest_corner(plates) < 0.0
    while plate.position[0] < -2.0 and layer.time < 60.0:
        layer.advance(10)
        depths.append(deepest_corner(layer.store.plates))
    return np.array(depths), layer


@pytest.mark.parametrize(("pitch", "yaw"), [(2.0 * WIDTH, 0.0), (WIDTH, 0.0), (WIDTH, 0.5), (0.5 * WIDTH, -0.7)])
def test_a_block_that_passes_the_flank_stays_outside_the_cone(pitch, yaw):
    """In the planes of sections alone it would stand metres inside; seen by one of them or by several."""
    depths, layer = passing(GENERATOR, pitch, yaw)
    assert depths.max() < 0.01 * H
    assert layer.store.list[0].position[0] > -2.0
    wrong = passing(None, pitch, yaw)[0]
    assert wrong.max() > 0.03 * H
