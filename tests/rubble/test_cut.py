"""The structure in a section: which faces meet the drift, and which is near."""

import numpy as np
import pytest

from rubble.cut import FACE, distance_to, nearest, plane


def slopes(corners):
    return [tuple(float(f[n]) for n in ("x0", "z0", "x1", "z1")) for f in plane([np.array(corners)]).slopes]


def test_only_the_face_against_the_drift_carries_blocks():
    """Not the top, the bottom or the rear of a box."""
    assert slopes([(0.0, -4.0), (3.0, -4.0), (3.0, 2.0), (0.0, 2.0)]) == [(0.0, 2.0, 0.0, -4.0)]


@pytest.mark.parametrize(("rise", "meets"), [(0.05, False), (0.0999, False), (0.1011, True), (1.0, True)])
def test_a_face_counts_from_84_degrees_on(rise, meets):
    """The upper face rises along the drift by ``rise`` per metre: n_x = -rise / sqrt(1 + rise^2) beyond -0.1."""
    found = slopes([(0.0, -4.0), (3.0, -4.0), (3.0, 3.0 * rise), (0.0, 0.0)])
    assert ((3.0, 3.0 * rise, 0.0, 0.0) in found) == meets
    assert (0.0, 0.0, 0.0, -4.0) in found


def test_distance_to_a_face_and_to_its_ends():
    faces = plane([np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)])]).faces
    assert faces.dtype == FACE
    slanted = next(f for f in faces if f["x0"] == 4.0 and f["z0"] == 3.0)
    assert distance_to(slanted, 0.5, 2.75) == pytest.approx(0.8 * 2.75 - 0.6 * 0.5, rel=1e-12)
    assert distance_to(slanted, 7.0, 7.0) == pytest.approx(5.0, rel=1e-12)
    assert distance_to(slanted, -3.0, -4.0) == pytest.approx(5.0, rel=1e-12)
    assert [nearest(faces, *p) for p in ((2.0, -1.0), (9.0, 1.0), (0.0, 3.0))] == [
        next(i for i, f in enumerate(faces) if (f["x0"], f["z0"]) == start)
        for start in ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0))
    ]
