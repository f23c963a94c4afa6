"""Profile, plane cuts and side force of cones and slopes."""

from itertools import pairwise

import numpy as np
import pytest

from coupling.structure import Profile, Revolved, cone, plane_slope

CONE = cone(np.pi / 4, 15.0, 5.0, toe_depth=20.0, top=5.0)


def lateral_ratio(structure, y, x, z):
    """Fy / Fx at a point of the face."""
    a, b = structure.bearing(x, y, z)
    return a + b * y / x


def test_radius_narrows_with_depth_down_to_the_neck():
    assert CONE.profile.radius([5.0, 0.0, -4.0, -10.0, -15.0]) == pytest.approx([20.0, 15.0, 11.0, 5.0, 5.0])
    assert np.isnan(CONE.profile.radius([5.1, -20.1])).all()


def test_upward_breaking_cone_narrows_with_height():
    c = cone(np.radians(60), 10.0, 4.0, toe_depth=3.0, top=20.0, breaking="upward")
    z = np.array([-3.0, 0.0, 2.0, 15.0])
    assert c.profile.radius(z) == pytest.approx([10 + 3 / 3**0.5, 10.0, 10 - 2 / 3**0.5, 4.0])
    assert c.normal(0.0, 1.0)[2] > 0 > CONE.normal(0.0, -1.0)[2]


@pytest.mark.parametrize("y", [0.0, 1e-3, 4.9, 5.0, 12.0, -12.0, 19.0])
@pytest.mark.parametrize("tolerance", [0.3, 0.02])
def test_section_outline_keeps_its_chord_error(y, tolerance):
    outline = CONE.section(y, -30.0, 30.0, tolerance)[0]
    assert outline[:, 0] == pytest.approx(CONE.face_x(y, outline[:, 1].clip(-20, 5)), abs=1e-6)
    assert (np.diff(outline[:, 1]) > 0).all()
    for a, b in pairwise(outline):
        if a[1] >= -10.0:  # on the cone r = 15 + z, so the cut is z = hypot(x, y) - 15; on the neck it is straight
            x = np.linspace(a[0], b[0], 41)
            off = (x - a[0]) * (b[1] - a[1]) - (np.hypot(x, y) - 15 - a[1]) * (b[0] - a[0])
            assert np.abs(off).max() / np.hypot(*(b - a)) <= tolerance * 1.001


def test_a_plane_beside_the_structure_has_no_outline():
    assert CONE.section(20.5, -30.0, 30.0, 0.01)[0].shape == (0, 2)
    assert np.isnan(CONE.face_x(12.0, -4.0))  # r = 11 m there: the section passes below the cone


def test_normal_is_a_unit_vector_across_the_surface():
    y, z = 6.0, -2.0
    n = CONE.normal(y, z)
    assert n @ n == pytest.approx(1.0, rel=1e-14)
    x, step = float(CONE.face_x(y, z)), 1e-6
    along_y = [float(CONE.face_x(y + step, z)) - x, step, 0.0]
    along_z = [float(CONE.face_x(y, z + step)) - x, 0.0, step]
    assert abs(n @ along_y) < 1e-10
    assert abs(n @ along_z) < 1e-10
    assert n[0] < 0  # against the drift


@pytest.mark.parametrize(("y", "z"), [(6.0, -2.0), (-6.0, -2.0), (3.0, -12.0)])
def test_side_force_follows_from_three_dimensional_statics(y, z):
    """Ice presses with N along -n: the force on the structure is -N n, so F_y / F_x = y / x."""
    force = -1000.0 * CONE.normal(y, z)
    x = float(CONE.face_x(y, z))
    assert force[0] > 0
    assert force[2] > 0 or z < -10
    assert lateral_ratio(CONE, y, x, z) * force[0] == pytest.approx(force[1], rel=1e-12)
    assert np.sign(force[1]) == -np.sign(y)  # the structure is pushed to the middle, the ice away from it


def test_side_force_is_sheer_of_the_plane_radius():
    r, y = 13.0, 5.0
    assert lateral_ratio(CONE, y, -12.0, -2.0) == pytest.approx(-y / np.sqrt(r**2 - y**2), rel=1e-14)


def test_side_forces_of_a_symmetric_ring_cancel_and_a_wrong_sign_does_not():
    y = np.linspace(-10, 10, 41)
    fx = 1.0 + 0 * y
    ratio = lateral_ratio(CONE, y, CONE.face_x(y, -2.0), -2.0)
    assert abs((fx * ratio).sum()) < 1e-12
    assert abs((fx * np.abs(ratio)).sum()) > 1.0


def test_plane_slope_recedes_with_depth_and_has_no_side_force():
    s = plane_slope(np.pi / 4, top=3.0, toe_depth=10.0)
    assert s.face_x(99.0, [-10.0, 0.0, 3.0]) == pytest.approx([10.0, 0.0, -3.0])
    assert s.section(99.0, -5.0, 1.0, 0.01)[0] == pytest.approx(np.array([(5.0, -5.0), (-1.0, 1.0)]))
    assert lateral_ratio(s, 99.0, 1.0, -1.0) == 0.0
    assert s.normal(3.0, -1.0) == pytest.approx([-(0.5**0.5), 0.0, -(0.5**0.5)])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: cone(0.0, 15.0), "0 deg"),
        (lambda: cone(np.pi / 2, 15.0), "90 deg"),
        (lambda: cone(np.nan, 15.0), "nan deg"),
        (lambda: cone(1.0, 15.0, 15.0), "neck radius is 15 m"),
        (lambda: cone(1.0, -1.0), "waterline radius is -1 m"),
        (lambda: cone(1.0, 15.0, toe_depth=-2.0), "toe lies above the waterline"),
        (lambda: cone(1.0, 15.0, top=-1.0), "top of the structure is -1 m"),
        (lambda: cone(1.0, 15.0, breaking="upward"), "needs toe_depth"),
        (lambda: cone(1.0, 15.0, breaking="sideways"), "'sideways'"),
        (lambda: plane_slope(2.0), "must lie between 0 and 90"),
        (lambda: Profile(((0.0, 1.0), (-1.0, 2.0))), "z ascending"),
        (lambda: Revolved(Profile(((0.0, 1.0), (1.0, -2.0)))), "radius -2 m"),
        (lambda: CONE.section(0.0, -1.0, 1.0, 0.0), "tolerance"),
    ],
)
def test_bad_input_is_refused_in_one_line(make, words):
    with pytest.raises(ValueError, match=words) as error:
        make()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("structure", [cone(np.pi / 4, 15.0, top=5.0), plane_slope(np.pi / 4, top=5.0)])
def test_over_the_top_nothing_overlaps_and_the_normal_is_against_the_drift(structure):
    L, normal = structure.overlap(np.array([5.0]), np.zeros((1, 2)), np.array([5.1]))
    assert not L.any()
    np.testing.assert_array_equal(normal, [[[-1.0, 0.0, 0.0]] * 2])


def test_ice_that_has_passed_the_axis_is_behind_the_face():
    """Beside a cone the face looks along y; behind the axis its front is metres away along x and pushes nothing."""
    y, z = np.full((3, 1), 14.9), np.zeros(3)
    L, _ = CONE.overlap(np.array([-1.5, -0.5, 0.5]), y, z)
    np.testing.assert_allclose(L[:, 0], [np.sqrt(15.0**2 - 14.9**2) - 1.5, np.sqrt(15.0**2 - 14.9**2) - 0.5, 0.0])
