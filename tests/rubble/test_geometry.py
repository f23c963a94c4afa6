"""Plane geometry against closed forms."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.geometry import area_moments, clip, contiguous, intersection, place, submerged
from rubble.outline import convex_parts
from rubble.trim import cut_away

BOX = contiguous([(0, 0), (4, 0), (4, 2), (0, 2)])


def regular(n, r, x=0.0, z=0.0):
    t = 2 * np.pi * np.arange(n) / n
    return np.column_stack([x + r * np.cos(t), z + r * np.sin(t)])


def test_moments_of_a_rectangle():
    assert area_moments(BOX) == pytest.approx([8.0, 2.0, 1.0, 4 * 2 * (4**2 + 2**2) / 12], rel=1e-14)


def test_moments_of_a_regular_polygon_tend_to_the_circle():
    area, x, z, polar = area_moments(contiguous(regular(2000, 3.0, 50.0, -7.0)))
    assert area == pytest.approx(np.pi * 9, rel=1e-5)
    assert (x, z) == pytest.approx((50.0, -7.0), rel=1e-12)
    assert polar == pytest.approx(np.pi * 3**4 / 2, rel=1e-5)


def test_moments_do_not_lose_digits_far_away():
    near, far = area_moments(BOX), area_moments(BOX + 1e6)
    assert (far.area, far.polar) == pytest.approx((near.area, near.polar), rel=1e-9)


def test_clockwise_points_are_turned():
    assert area_moments(contiguous(BOX[::-1])).area == pytest.approx(8.0)


@pytest.mark.parametrize(("c", "area"), [(-1.0, 0.0), (0.0, 0.0), (1.0, 2.0), (3.5, 7.0), (4.0, 8.0), (9.0, 8.0)])
def test_clip_by_a_vertical_line(c, area):
    assert area_moments(clip(BOX, 1.0, 0.0, c)).area == pytest.approx(area, abs=1e-14)


def test_two_clips_partition_a_polygon():
    p = contiguous(regular(7, 2.0))
    a, b = area_moments(clip(p, 0.3, 0.8, 0.4)), area_moments(clip(p, -0.3, -0.8, -0.4))
    assert a.area + b.area == pytest.approx(area_moments(p).area, rel=1e-14)


def test_submerged_part_of_a_tilted_box():
    box = place(BOX, 0.0, 0.0, np.pi / 4, -2.0, -1.0)
    wet = area_moments(submerged(box))
    assert wet.area == pytest.approx(4.0, rel=1e-14)  # the waterline goes through the centre


def test_intersection_of_two_boxes():
    assert area_moments(intersection(BOX, BOX + np.array([1.0, 1.5]))).area == pytest.approx(3 * 0.5, rel=1e-14)
    assert area_moments(intersection(BOX, BOX + np.array([5.0, 0.0]))).area == 0.0


def test_cut_away_by_a_slope_is_exact():
    slope = convex_parts(np.array([(12.0, -10.0), (-8.0, 10.0)]), back=40.0)  # x = 2 - z
    rest = cut_away(BOX, plane(slope))
    assert area_moments(rest).area == pytest.approx(2.0, rel=1e-12)
    assert intersection(rest, slope[0]).shape[0] == 0 or area_moments(intersection(rest, slope[0])).area < 1e-12


def test_cut_away_at_an_inward_corner_leaves_nothing_inside():
    parts = convex_parts(np.array([(-2.0, -20.0), (-2.0, -5.0), (-12.0, 5.0)]))  # neck below a cone
    assert len(parts) == 2
    block = contiguous([(-6, -7), (-1, -7), (-1, -4), (-6, -4)])
    rest = cut_away(block, plane(parts))
    inside = sum(area_moments(intersection(rest, p)).area for p in parts)
    assert inside < 1e-12
    assert 0.4 * area_moments(block).area < area_moments(rest).area < area_moments(block).area


def test_a_block_inside_the_structure_is_gone():
    parts = convex_parts(np.array([(-20.0, -20.0), (-20.0, 20.0)]))
    assert area_moments(cut_away(BOX, plane(parts))).area == 0.0


def test_faces_between_parts_are_no_outer_faces():
    parts = convex_parts(np.array([(-2.0, -20.0), (-2.0, -5.0), (-12.0, 5.0)]))
    faces = plane(parts).faces
    assert not any(f["z0"] == f["z1"] == -5.0 for f in faces)
    assert len(faces) == 6


@pytest.mark.parametrize(
    "points",
    [
        [(0.0, 0.0), (1.0, 0.0)],
        [(0.0,), (1.0,), (2.0,)],
        [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)],
        [0.0, 1.0, 2.0, 3.0],
        [(0.0, 0.0), (1.0, 0.0), (np.nan, 1.0)],
    ],
)
def test_what_is_no_polygon_is_refused(points):
    with pytest.raises(ValueError, match="check the corners"):
        contiguous(points)
