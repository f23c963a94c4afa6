"""A cone with flat sides: planes, corners and cuts in closed form, and the body of revolution as its limit."""

from itertools import pairwise

import numpy as np
import pytest

from coupling.contact import ContactLaw, OverlapContact
from coupling.structure import MultiSidedCone, Profile, cone, multi_sided_cone

#: two slopes and a neck
PROFILE = Profile(((-20.0, 5.0), (-9.0, 5.0), (-4.0, 11.0), (5.0, 17.0)))
UPWARD = Profile(((-3.0, 13.0), (2.0, 9.0), (4.0, 4.0), (20.0, 4.0)))
SHAPES = [
    MultiSidedCone(profile, sides, orientation)
    for profile in (PROFILE, UPWARD)
    for sides in (3, 6, 8)
    for orientation in (0.0, 0.2, np.pi / sides)
]


def facet_of(s, n):
    """Facet whose normal has the horizontal direction of n."""
    along = np.cos(s.psi) * n[0] + np.sin(s.psi) * n[1]
    assert along.max() == pytest.approx(np.hypot(n[0], n[1]), rel=1e-12)
    return int(np.argmax(along))


@pytest.mark.parametrize("s", SHAPES)
@pytest.mark.parametrize(("y", "z"), [(0.0, 0.0), (3.0, -2.5), (-4.0, 1.0), (1.5, 3.0)])
def test_the_front_is_a_point_of_one_facet_and_inside_all_others(s, y, z):
    x, r = float(s.face_x(y, z)), float(s.profile.radius(z))
    distance = x * np.cos(s.psi) + y * np.sin(s.psi) - r
    assert np.abs(distance).min() < 1e-12
    assert distance.max() < 1e-12
    n = s.normal(y, z)
    assert n @ n == pytest.approx(1.0, rel=1e-14)
    assert n[0] < 0.0
    assert abs(distance[facet_of(s, n)]) < 1e-12
    step = 1e-6
    along = np.array([float(s.face_x(y, z + step)) - x, 0.0, step])
    assert abs(n @ along) < 1e-9
    a, b = s.bearing(x, y, z)
    assert (a, b) == (pytest.approx(n[1] / n[0], abs=1e-12), 0.0)


def test_beside_above_and_below_it_is_no_face():
    s = MultiSidedCone(PROFILE, 6)
    assert s.half_width == pytest.approx(float(PROFILE.radius(0.0)) / np.cos(np.pi / 6))
    assert np.isfinite(s.face_x(0.999 * s.half_width, 0.0))
    assert np.isnan(s.face_x([1.001 * s.half_width, 0.0, 0.0], [0.0, 5.1, -20.1])).all()
    assert np.isnan(s.normal(1.001 * s.half_width, 0.0)).all()


@pytest.mark.parametrize("s", SHAPES)
def test_overlap_is_measured_along_the_drift_from_the_front(s):
    y, z = np.linspace(-20.0, 20.0, 81)[None] + np.zeros((3, 1)), np.array([-6.0, 0.0, 2.5])
    x = np.array([0.0, -3.0, 1.0])
    L, normal = s.overlap(x, y, z)
    face = s.face_x(y, z[:, None] + 0.0 * y)
    expected = np.nan_to_num(np.maximum(x[:, None] - face, 0.0))
    np.testing.assert_allclose(L, expected, atol=1e-12)
    assert (L > 0.0).any()
    assert (L == 0.0).any()
    on = np.isfinite(face)
    np.testing.assert_allclose(normal[on], s.normal(y, z[:, None] + 0.0 * y)[on], atol=1e-14)
    np.testing.assert_array_equal(normal[~on], np.tile([-1.0, 0.0, 0.0], ((~on).sum(), 1)))


@pytest.mark.parametrize("s", SHAPES)
@pytest.mark.parametrize("y", [0.0, 2.0, -5.5, 9.0])
def test_a_section_is_the_exact_cut(s, y):
    """Middles of its pieces lie on the faces as well as the corners, in front and behind."""
    front, rear = s.section(y, -30.0, 30.0, 0.01)
    assert (np.diff(front[:, 1]) > 0.0).all()
    for line, side in ((front, -1.0), (rear, 1.0)):
        for a, b in pairwise(line):
            for point in (a, 0.5 * (a + b), b):
                r = float(s.profile.radius(point[1]))
                distance = point[0] * np.cos(s.psi) + y * np.sin(s.psi) - r
                assert np.abs(distance).min() < 1e-9
                assert distance.max() < 1e-9
            middle = 0.5 * (a + b)
            facing = side * np.cos(s.psi) > 0.0
            distance = middle[0] * np.cos(s.psi) + y * np.sin(s.psi) - float(s.profile.radius(middle[1]))
            assert np.abs(distance[facing]).min() < 1e-9
    inside = np.isfinite(s.face_x(y, front[:, 1]))
    np.testing.assert_allclose(front[inside, 0], s.face_x(y, front[:, 1])[inside], atol=1e-9)


def test_a_plane_that_misses_it_has_no_section():
    front, rear = MultiSidedCone(PROFILE, 6).section(30.0, -30.0, 30.0, 0.01)
    assert front.shape == rear.shape == (0, 2)


@pytest.mark.parametrize("orientation", [0.0, 0.3])
def test_many_sides_are_a_cone(orientation):
    """Faces, normals and overlap come closer with 1 / n^2; at a fixed y of the plan the normal with 1 / n."""
    round_one = cone(np.pi / 4, 15.0, 5.0, toe_depth=20.0)
    y, z = np.linspace(-9.0, 9.0, 37)[None] + np.zeros((2, 1)), np.array([-3.0, 0.4])
    x = np.array([-8.0, -13.0])
    exact, normal = round_one.overlap(x, y, z)
    off, turned = [], []
    for sides in (64, 256, 1024):
        s = multi_sided_cone(sides, np.pi / 4, 15.0, 5.0, toe_depth=20.0, orientation=orientation)
        L, n = s.overlap(x, y, z)
        off.append(np.abs(L - exact).max())
        turned.append(np.abs(n - normal).max())
        assert s.foremost_x(0.4) == pytest.approx(-15.4, rel=6.0 / sides**2)
    assert off[0] / off[1] == pytest.approx(16.0, rel=0.5)
    assert off[1] / off[2] == pytest.approx(16.0, rel=0.5)
    assert off[2] < 1e-3
    assert turned[2] < 1.1 * np.pi / 1024


@pytest.mark.parametrize(("breaking", "face"), [("downward", 1.0), ("upward", -1.0)])
@pytest.mark.parametrize("mu", [0.0, 0.15])
def test_statics_of_an_edge_on_a_facet(breaking, face, mu):
    """Pressed by p over the cut face: N along the facet's normal, friction up or down its line of fall."""
    a, psi, p, h, width, freeboard = np.pi / 3, np.pi + 0.4, 200e3, 3.0, 0.5, 0.477
    s = multi_sided_cone(6, a, 15.0, toe_depth=10.0, orientation=0.4, breaking=breaking)
    law = OverlapContact(s, ContactLaw(p, mu), 0.1, h, freeboard)
    y, z = -5.0, freeboard if face > 0 else freeboard - h
    x = float(s.face_x(y, z))
    law.set_edge(np.array([7]), np.array([x - 0.6]), np.array([y]), np.array([width]))
    force = law.evaluate(10.0, np.zeros((1, 3)))[0][0]  # 1 m of drift
    n = np.array([np.sin(a) * np.cos(psi), np.sin(a) * np.sin(psi), -face * np.cos(a)])
    fall = face * (np.array([0.0, 0.0, 1.0]) - n[2] * n) / np.sin(a)
    L = 0.4 + np.tan(0.4) * (np.arange(8) - 3.5) / 8 * width  # the facet recedes along y
    N = p * width * np.minimum(L / np.cos(a), h / np.sin(a)).mean()
    np.testing.assert_allclose(force, N * (n + mu * fall), rtol=1e-9)
    assert force[1] / force[0] == pytest.approx(np.tan(psi), rel=1e-9)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: MultiSidedCone(PROFILE, 2), "2 sides"),
        (lambda: MultiSidedCone(PROFILE, 4, np.nan), "nan"),
        (lambda: MultiSidedCone(Profile(((0.0, -1.0), (1.0, 1.0))), 4), "radius -1 m"),
    ],
)
def test_bad_input_is_refused_in_one_line(make, words):
    with pytest.raises(ValueError, match=words) as error:
        make()
    assert "\n" not in str(error.value)
