"""The thesis's contact (6.2) against a plane slope, where everything is in closed form."""

import numpy as np
import pytest

from coupling.contact import ContactLaw, OverlapContact
from coupling.crushing import CrushingContact
from coupling.structure import cone, plane_slope
from lattice.memory import recall, remember

P, MU, H = 200e3, 0.1, 3.0
FREEBOARD = 0.477


def contact(structure, y=0.0, width=2.0, front=None):
    law = OverlapContact(structure, ContactLaw(P, MU), 0.1, H, FREEBOARD)
    z = FREEBOARD if law.face > 0 else FREEBOARD - H
    start = float(structure.face_x(y, z)) if front is None else front
    law.set_edge(np.array([7]), np.array([start]), np.array([y]), np.array([width]))
    return law


@pytest.mark.parametrize("degrees", [30.0, 45.0, 60.0])
def test_force_on_a_plane_slope(degrees):
    """F = p (L / cos a) b along the normal, mu F up the slope against ice that is pushed down."""
    a = np.radians(degrees)
    f, _ = contact(plane_slope(a)).evaluate(5.0, np.zeros((1, 3)))
    F = P * min(0.5 / np.cos(a), H / np.sin(a)) * 2.0
    expected = [-F * (np.sin(a) + MU * np.cos(a)), 0.0, -F * (np.cos(a) - MU * np.sin(a))]
    np.testing.assert_allclose(f[0], expected, rtol=1e-12, atol=1e-6)


def test_an_upward_breaking_slope_lifts_the_ice():
    f, _ = contact(plane_slope(np.pi / 4, breaking="upward")).evaluate(5.0, np.zeros((1, 3)))
    F = P * 0.5 / np.cos(np.pi / 4) * 2.0
    np.testing.assert_allclose(f[0, [0, 2]], [-F * 1.1 / np.sqrt(2), F * 0.9 / np.sqrt(2)], rtol=1e-12)


def test_the_contact_length_ends_where_the_slope_leaves_the_ice():
    f, tangent = contact(plane_slope(np.pi / 4)).evaluate(100.0, np.zeros((1, 3)))
    assert -f[0, 0] == pytest.approx(P * H * np.sqrt(2) * 2.0 * 1.1 / np.sqrt(2), rel=1e-12)
    assert not tangent.any()


def test_nothing_before_the_touch_and_nothing_beside_the_cone():
    structure = cone(np.pi / 4, 15.0)
    touching = float(structure.face_x(0.0, FREEBOARD))
    assert not contact(structure, front=touching - 1.0).evaluate(9.0, np.zeros((1, 3)))[0].any()
    assert not contact(structure, y=20.0, front=touching).evaluate(60.0, np.zeros((1, 3)))[0].any()


@pytest.mark.parametrize("y", [0.0, 6.0, -12.0])
def test_the_force_on_a_cone_lies_in_the_plane_through_its_axis(y):
    structure = cone(np.pi / 4, 15.0)
    f, _ = contact(structure, y, width=1e-6).evaluate(10.0, np.zeros((1, 3)))
    x = float(structure.face_x(y, FREEBOARD))
    assert f[0, 1] * x == pytest.approx(f[0, 0] * y, rel=1e-9, abs=1e-12)
    assert np.hypot(f[0, 0], f[0, 1]) / -f[0, 2] == pytest.approx(1.1 / 0.9, rel=1e-9)


def test_the_tangent_is_the_derivative():
    law = contact(cone(np.pi / 4, 15.0), 5.0)
    y = np.array([[0.02, 0.01, -0.1]])
    _, tangent = law.evaluate(8.0, y)
    for k in (0, 2):
        step = np.zeros((1, 3))
        step[0, k] = 1e-6
        slope = (law.evaluate(8.0, y + step)[0] - law.evaluate(8.0, y - step)[0]) / 2e-6
        np.testing.assert_allclose(tangent[0, :, k], slope[0], rtol=5e-2)  # the normal's own turn is left out


def test_the_overlap_of_a_wide_node_is_its_mean_over_the_width():
    """On a round structure the middle of a node touches before its sides: integration, not sampling."""
    structure = cone(np.pi / 4, 15.0)
    wide, _ = contact(structure, width=8.0).evaluate(5.0, np.zeros((1, 3)))
    dy = np.linspace(-4.0, 4.0, 2001)
    overlap = np.maximum(0.5 - (float(structure.face_x(0.0, FREEBOARD)) * -1 + structure.face_x(dy, FREEBOARD)), 0.0)
    mean = overlap.mean() * P * np.sqrt(2) * 8.0
    assert -wide[0, 2] == pytest.approx(mean * 0.9 / np.sqrt(2), rel=0.03)
    assert -wide[0, 2] < 0.9 * 0.5 * P * np.sqrt(2) * 8.0 * 0.9 / np.sqrt(2)


def crushing(front_overlap_at=0.0):
    law = CrushingContact(plane_slope(np.pi / 4), ContactLaw(4e6, MU, 3e9), 0.1, H, FREEBOARD)
    start = float(plane_slope(np.pi / 4).face_x(0.0, FREEBOARD)) + front_overlap_at
    law.set_edge(np.array([7]), np.array([start]), np.array([0.0]), np.array([2.0]))
    return law


def test_intact_ice_presses_elastically_then_at_its_strength():
    law = crushing()
    elastic, _ = law.evaluate(0.01, np.zeros((1, 3)))  # L = 1 mm, below 4 MPa / (3e9 Pa/m)
    assert -elastic[0, 0] == pytest.approx(3e9 * 1e-3 * 1e-3 * np.sqrt(2) * 2.0 * 1.1 / np.sqrt(2), rel=1e-9)
    crushed, _ = law.evaluate(5.0, np.zeros((1, 3)))
    assert -crushed[0, 0] == pytest.approx(4e6 * 0.5 * np.sqrt(2) * 2.0 * 1.1 / np.sqrt(2), rel=1e-12)


def test_crushed_ice_does_not_come_back():
    """After crushing half a metre the edge lets go when the ice moves back by the elastic closure, and stays apart."""
    law = crushing()
    depth = law.close_window(5.0, lambda: np.zeros((1, 3)))
    np.testing.assert_allclose(depth, 0.5 - 4e6 / 3e9)
    back = np.array([[-2e-3, 0.0, 0.0]])
    assert not law.evaluate(5.0, back)[0].any()
    assert contact(plane_slope(np.pi / 4)).evaluate(5.0, back)[0].any()  # the thesis's contact presses on


def test_ice_that_is_found_in_the_structure_presses_with_what_closes_from_then_on():
    """Half a metre deep when the ice before it has left: no force, where one that is new to `find` has all of it."""
    law, y = crushing(0.5), np.zeros((1, 3))
    assert law.evaluate(0.0, y)[0].any()
    law.find(0.0, lambda: y)
    assert not law.evaluate(0.0, y)[0].any()
    assert law.height[0] == pytest.approx(0.5 * H - 0.25, rel=1e-9)
    pressed, _ = law.evaluate(0.01, y)  # 1 mm more, on the face of 0.501 m
    assert -pressed[0, 0] == pytest.approx(3e9 * 1e-3 * 0.501 * np.sqrt(2) * 2.0 * 1.1 / np.sqrt(2), rel=1e-9)
    law.set_edge(law.nodes, np.array([law._x[0]]), np.array([0.0]), np.array([2.0]))
    law.find(0.01, lambda: y)
    np.testing.assert_array_equal(law.evaluate(0.01, y)[0], pressed)  # it is known now


@pytest.mark.parametrize("turned", [-0.1, 0.1])
def test_the_closure_of_an_edge_that_has_turned_stays_when_its_point_of_action_moves(turned):
    """That point lies some 0.2 m lower after the window, so 20 mm from where it was along the drift."""
    law = crushing()

    def displacement():
        return np.array([[turned * law.height[0], 0.0, 0.0]])

    L, _ = law.overlap(5.0, displacement())
    law.close_window(5.0, displacement)
    there, _ = law.overlap(5.0, displacement())
    assert np.abs(there - L).min() > 0.015
    np.testing.assert_allclose(there - law._crushed, 4e6 / 3e9, rtol=1e-9)


@pytest.mark.parametrize("way", [-1.0, 1.0])
def test_an_edge_that_swings_finds_the_structure_where_it_left_it(way):
    """It turns and goes back by up to 0.6 m and comes again, never farther than it was crushed.

    A height that follows the overlap moves c by 38 mm a swing, nearer or farther by the way it turns; the closure at
    full strength is 1.3 mm.
    """
    law = crushing()
    law.close_window(5.0, lambda: np.zeros((1, 3)))
    crushed, height = law._crushed.copy(), law.height[0]
    for phase in np.linspace(0.0, 6.0 * np.pi, 61):
        back, turned = 0.3 * (1.0 - np.cos(phase)), way * 0.1 * np.sin(phase)
        law.close_window(5.0, lambda: np.array([[-back + turned * (law.height[0] - height), 0.0, 0.0]]))  # noqa: B023
    assert law.height[0] == height
    np.testing.assert_array_equal(law._crushed, crushed)


def test_nodes_that_stay_in_front_keep_their_damage():
    law = crushing()
    law.close_window(5.0, lambda: np.zeros((1, 3)))
    law.set_edge(np.array([3, 7]), np.array([-1.0, 0.0]), np.array([2.0, 0.0]), np.array([2.0, 2.0]))
    depth = law.close_window(0.0, lambda: np.zeros((2, 3)))
    assert depth[1].min() > 0.4
    assert depth[0].max() < depth[1].min()


def test_ice_that_hangs_over_the_side_of_the_cone_is_pressed_where_it_touches_only():
    """Half of the node's width lies beside the structure: a finite force, from the other half."""
    structure = cone(np.pi / 4, 15.0)
    law = contact(structure, y=15.4, width=2.0, front=-2.0)
    force, tangent = law.evaluate(0.0, np.zeros((1, 3)))
    assert np.isfinite(force).all()
    assert np.isfinite(tangent).all()
    assert 0.0 < -force[0, 2] < P * H * np.sqrt(2) * 2.0


def test_the_thesis_contact_acts_at_middle_thickness():
    law = contact(plane_slope(np.pi / 4))
    law.close_window(5.0, lambda: np.zeros((1, 3)))
    np.testing.assert_array_equal(law.height, [0.0])


@pytest.mark.parametrize(("breaking", "face"), [("downward", 1.0), ("upward", -1.0)])
@pytest.mark.parametrize("degrees", [30.0, 45.0, 60.0])
def test_a_crushing_contact_acts_at_the_middle_of_its_face(degrees, breaking, face):
    """z = h/2 - min(L tan a, h)/2 on the side of the edge that touches; at the edge before it is pressed."""
    structure, tan = plane_slope(np.radians(degrees), breaking=breaking), np.tan(np.radians(degrees))
    law = CrushingContact(structure, ContactLaw(4e6, MU, 3e9), 0.1, H, FREEBOARD)
    z = FREEBOARD if face > 0 else FREEBOARD - H
    law.set_edge(np.array([7]), np.array([float(structure.face_x(0.0, z))]), np.zeros(1), np.array([2.0]))
    assert law.height[0] == pytest.approx(face * 1.5, rel=1e-12)
    for t in (2.0, 10.0, 100.0):
        law.close_window(t, lambda: np.zeros((1, 3)))
        assert law.height[0] == pytest.approx(face * 0.5 * (H - min(0.1 * t * tan, H)), abs=1e-9)


def test_on_a_round_structure_the_height_is_the_mean_over_the_face():
    """A node beside the axis of a cone touches along part of its width: each point counts by its contact length."""
    law = CrushingContact(cone(np.pi / 4, 15.0), ContactLaw(4e6, MU, 3e9), 0.1, H, FREEBOARD)
    front = float(cone(np.pi / 4, 15.0).face_x(6.0, FREEBOARD))
    law.set_edge(np.array([7]), np.array([front]), np.array([6.0]), np.array([2.8]))
    L, _ = law.overlap(3.0, np.zeros((1, 3)))
    assert L.min() == 0.0 < L.max()
    law.close_window(3.0, lambda: np.zeros((1, 3)))
    assert law.height[0] == pytest.approx(0.5 * H - 0.5 * (L**2).sum() / L.sum(), rel=1e-9)


def test_an_edge_that_lets_go_and_stays_in_front_keeps_its_height():
    law = crushing()
    law.close_window(5.0, lambda: np.zeros((1, 3)))
    law.close_window(5.0, lambda: np.array([[-5.0, 0.0, 0.0]]))
    law.set_edge(np.array([3, 7]), np.array([-9.0, 0.0]), np.array([2.0, 0.0]), np.array([2.0, 2.0]))
    np.testing.assert_allclose(law.height, [1.5, 1.25])


def test_a_contact_set_back_has_its_damage_and_height_again():
    law = crushing()
    law.close_window(2.0, lambda: np.zeros((1, 3)))
    saved, force, height = remember(law), law.evaluate(2.5, np.zeros((1, 3)))[0], law.height.copy()
    law.close_window(9.0, lambda: np.zeros((1, 3)))
    assert law.height[0] < height[0] - 0.1
    recall(saved)
    np.testing.assert_array_equal(law.height, height)
    np.testing.assert_array_equal(law.evaluate(2.5, np.zeros((1, 3)))[0], force)


@pytest.mark.parametrize("degrees", [35.0, 45.0, 60.0])
@pytest.mark.parametrize("part", [0.0, 1e-6, 0.5, 1.0 - 1e-6, 1.0 + 1e-6, 3.0])
def test_the_contact_length_up_to_the_rim_of_the_ice(degrees, part):
    """L / cos a until the whole face h / sin a bears, at L = h cot a; only a contact that can grow has a tangent."""
    a = np.radians(degrees)
    L = part * H / np.tan(a)
    f, tangent = contact(plane_slope(a)).evaluate(L / 0.1, np.zeros((1, 3)))
    length = min(part, 1.0) * H / np.sin(a)
    assert -f[0, 0] == pytest.approx(P * 2.0 * length * (np.sin(a) + MU * np.cos(a)), rel=1e-9, abs=1e-9)
    assert tangent.any() == (0.0 < part < 1.0)
    if tangent.any():
        assert -tangent[0, 0, 0] == pytest.approx(P * 2.0 / np.cos(a) * (np.sin(a) + MU * np.cos(a)), rel=1e-9)


def test_points_of_a_node_that_do_not_touch_have_no_tangent():
    """Part of the width lies ahead of a cone: the force grows along x by what the points in contact give."""
    law = contact(cone(np.pi / 4, 15.0), 6.0, width=2.8)
    L, _ = law.overlap(3.0, np.zeros((1, 3)))
    assert L.min() == 0.0 < L.max()
    step = np.array([[1e-6, 0.0, 0.0]])
    slope = (law.evaluate(3.0, step)[0] - law.evaluate(3.0, -step)[0]) / 2e-6
    np.testing.assert_allclose(law.evaluate(3.0, np.zeros((1, 3)))[1][0, :, 0], slope[0], rtol=1e-6)


@pytest.mark.parametrize(("t", "bears"), [(0.01, True), (5.0, False)])
def test_ice_that_is_not_crushing_stiffens_with_the_closure(t, bears):
    """E / d per metre on top of the length that grows; at the strength the length alone."""
    law, step = crushing(), np.array([[1e-7, 0.0, 0.0]])
    tangent = law.evaluate(t, np.zeros((1, 3)))[1]
    slope = (law.evaluate(t, step)[0] - law.evaluate(t, -step)[0]) / 2e-7
    np.testing.assert_allclose(tangent[0, :, 0], slope[0], rtol=1e-6)
    length_alone = (
        law.pressure(np.full((1, 8), 0.1 * t), np.array([0]))[0][0, 0] * np.sqrt(2.0) * 2.0 * 1.1 / np.sqrt(2.0)
    )
    assert (-tangent[0, 0, 0] > 1.9 * length_alone) == bears
