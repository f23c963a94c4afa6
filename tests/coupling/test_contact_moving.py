"""Contact of the sheet with a structure that moves: where it is, how it leans, which way friction acts."""

import numpy as np
import pytest

from coupling.contact import ContactLaw, OverlapContact
from coupling.interface import Path
from coupling.structure import cone, plane_slope
from coupling.structure.moved import turned

LAW = ContactLaw(2e6, 0.1)
H, FREEBOARD, DRIFT = 3.0, 0.4, 0.1
NODES = np.arange(4)


def placed(place, velocity=None):
    path = Path()
    path.start[:] = place
    path.velocity[:] = np.zeros(6) if velocity is None else velocity
    return path


def contact(structure, path=None, drift=DRIFT):
    c = OverlapContact(structure, LAW, drift, H, FREEBOARD, path)
    c.set_edge(NODES, np.full(4, -14.0), np.array([-4.5, -1.5, 1.5, 4.5]), np.full(4, 3.0))
    return c


def force(structure, path=None, y=None, drift=DRIFT):
    return contact(structure, path, drift).evaluate(0.0, np.zeros((4, 3)) if y is None else y)


CONE = cone(np.radians(45.0), 15.0, 9.0)


def test_at_rest_place_it_is_the_structure_that_rests():
    for got, known in zip(force(CONE, placed(np.zeros(6))), force(CONE), strict=True):
        assert (got == known).all()


def test_displaced_it_meets_ice_that_is_displaced_the_other_way():
    way = np.array([0.3, 0.1, -0.2])
    got = force(CONE, placed([*way, 0.0, 0.0, 0.0]))
    known = force(CONE, y=np.tile(-way, (4, 1)))
    assert np.abs(known[0]).max() > 1e5
    for a, b in zip(got, known, strict=True):
        assert a == pytest.approx(b, rel=1e-12, abs=1e-9 * np.abs(b).max())


@pytest.mark.parametrize("pitch", [0.05, -0.08])
def test_a_pitched_slope_is_a_slope_of_another_angle(pitch):
    """A face that leans over by a from the horizontal leans by a + pitch when its top goes along +x."""
    slope = np.radians(50.0)
    structure, other = plane_slope(slope), plane_slope(slope + pitch)
    y = np.tile([14.2, 0.0, 0.0], (4, 1))
    got, known = (force(s, p, y) for s, p in ((structure, placed([0, 0, 0, 0, pitch, 0])), (other, None)))
    assert np.abs(known[0]).max() > 1e5
    for a, b in zip(got, known, strict=True):
        assert a == pytest.approx(b, rel=1e-9, abs=1e-9 * np.abs(b).max())


def test_a_cone_does_not_see_its_yaw():
    got, known = force(CONE, placed([0, 0, 0, 0, 0, 0.02]))[0], force(CONE)[0]
    assert got[:, ::2] == pytest.approx(known[:, ::2], rel=2e-2)  # along x exact where the face is plane


def test_a_roll_leans_to_one_side():
    """Positive roll lowers the side of negative y: ice there meets a larger radius of a cone that widens upwards."""
    load = -force(CONE, placed([0, 0, 0, 0.02, 0, 0]), y=np.tile([0.5, 0.0, 0.0], (4, 1)))[0]
    assert load[0, 0] > load[3, 0] > 0.0


def test_the_tangent_is_the_derivative():
    rng, path = np.random.default_rng(3), placed([0.1, 0.05, -0.1, 0.01, 0.03, -0.02])
    c = contact(plane_slope(np.radians(50.0)), path)
    y = np.tile([14.3, 0.0, 0.0], (4, 1)) + 0.01 * rng.normal(size=(4, 3))
    _, tangent = c.evaluate(0.0, y)
    for k in range(3):
        step = np.zeros(3)
        step[k] = 1e-6
        slope = (c.evaluate(0.0, y + step)[0] - c.evaluate(0.0, y - step)[0]) / 2e-6
        assert tangent[..., k] == pytest.approx(slope, rel=1e-6, abs=1e-6 * np.abs(tangent).max())


@pytest.mark.parametrize(
    ("heave", "sign"),
    [
        (0.0, 1.0),
        (-0.05, 1.0),  # goes down with the ice, which slides down still faster
        (-5.0, -1.0),  # pulls the ice down
        (5.0, 1.0),
    ],
)
def test_friction_is_against_the_sliding(heave, sign):
    """Of ice that drifts at 0.1 m/s down a face of 45 degrees, itself at 0.05 m/s and more in the vertical."""
    velocity = np.array([0.0, 0.0, heave, 0.0, 0.0, 0.0])
    structure = plane_slope(np.radians(45.0))
    y = np.tile([14.2, 0.0, 0.0], (4, 1))
    got = force(structure, placed(np.zeros(6), velocity), y)[0]
    known = force(structure, y=y)[0]
    normal, mu = known[0, 2] / known[0, 0], LAW.friction
    assert normal == pytest.approx((-1.0 + mu) / (-1.0 - mu))
    assert got[0, 2] / got[0, 0] == pytest.approx((-1.0 + sign * mu) / (-1.0 - sign * mu))


def test_friction_in_the_force_is_what_the_law_put_there():
    velocity = np.array([0.0, 0.0, -5.0, 0.0, 0.0, 0.0])
    y = np.tile([0.6, 0.0, 0.0], (4, 1))
    c = contact(CONE, placed(np.zeros(6), velocity))
    whole = c.evaluate(0.0, y)[0]
    c._law = ContactLaw(LAW.strength, 0.0)
    pressure = c.evaluate(0.0, y)[0]
    c._law = LAW
    assert c.friction_in(y, whole) == pytest.approx(whole - pressure, rel=1e-9, abs=1e-6 * np.abs(whole).max())


def test_turning_is_a_rotation():
    r = turned(np.array([0.3, -0.2, 0.5]))
    assert r @ r.T == pytest.approx(np.eye(3), abs=1e-14)
    assert turned(np.array([0.0, 0.1, 0.0])) @ [0.0, 0.0, 1.0] == pytest.approx([np.sin(0.1), 0.0, np.cos(0.1)])
