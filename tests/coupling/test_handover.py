"""A fragment and its blocks: same ice, same place, same motion."""

from dataclasses import replace

import numpy as np
import pytest

import coupling.rubble_port.hand_over
from coupling.interface import Fragment
from coupling.rubble_port import RubblePort
from coupling.rubble_port.births import Momenta, births, frame_of
from coupling.structure import plane_slope
from rubble.domain import Domain
from rubble.physics import RubblePhysics
from rubble.plates import momenta

D, H = 2.0, 3.0
solve = np.linalg.solve


def fragment(rows=4, columns=3, *, turn=0.1, omega=0.05, cut=0.0, face=1.0):
    """A rigid piece, turned by `turn` from x towards z and turning with `omega`, front node at x = 0, z = -1."""
    row, column = (a.ravel() for a in np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"))
    s = -row * D
    position = np.column_stack((s * np.cos(turn), 1.0 + column * D, -1.0 + s * np.sin(turn)))
    velocity = np.column_stack((0.1 - omega * position[:, 2], np.full(len(s), 0.02), omega * position[:, 0] - 0.3))
    length = np.where(row == 0, D / 2, D)
    return Fragment(
        row=row,
        column=column,
        mass=846.0 * H * D * length,
        length=length,
        width=np.full(len(s), D),
        lead=np.where(row == 0, 0.0, D / 2),
        position=position,
        velocity=velocity,
        tilt=np.full(len(s), -turn),
        tilt_rate=np.full(len(s), -omega),
        flooded=np.zeros(len(s)),
        cut=np.where(row == 0, cut, 0.0),
        cut_tan=np.ones(len(s)),
        cut_face=face,
    )


def area(polygon):
    x, z = polygon.T
    return 0.5 * (np.dot(x, np.roll(z, -1)) - np.dot(z, np.roll(x, -1)))


def pieces(f):
    return list(births(f, H, *frame_of(f, H)))


def test_pieces_hold_the_ice_of_their_columns():
    found = pieces(fragment())
    assert len(found) == 3
    for b in found:
        assert area(b.polygon) == pytest.approx(3.5 * D * H, rel=1e-12)
        assert b.width == pytest.approx(D)
    assert np.diff([b.y for b in found]) == pytest.approx(D)


def test_a_rigid_piece_keeps_its_place():
    f = fragment()
    origin, axes = frame_of(f, H)
    np.testing.assert_allclose(axes[:, 0], [np.cos(0.1), 0.0, np.sin(0.1)], atol=1e-12)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-14)
    for b in births(f, H, origin, axes):
        corners = origin + np.insert(b.polygon, 1, b.y, axis=1) @ axes.T
        front = corners[np.argmax(corners[:, 0])]
        assert np.hypot(front[0], front[2] + 1.0) == pytest.approx(H / 2, rel=1e-5)  # the front node is mid-height


def test_a_plate_that_leans_has_its_lean():
    f = fragment(turn=0.0)
    leaning = replace(f, position=f.position + np.outer(0.05 * f.position[:, 1], [0.0, 0.0, 1.0]))
    _, axes = frame_of(leaning, H)
    assert axes[2, 1] / axes[1, 1] == pytest.approx(0.05, rel=1e-9)


@pytest.mark.parametrize("face", [1.0, -1.0])
@pytest.mark.parametrize("cut", [0.5, 2.9, 4.5])
def test_the_crushed_edge_is_cut_off(cut, face):
    b = pieces(fragment(turn=0.0, omega=0.0, cut=cut, face=face))[0]
    lost = 0.5 * cut**2 if cut < H else H * cut - 0.5 * H**2
    assert area(b.polygon) == pytest.approx(3.5 * D * H - lost, rel=1e-9)
    z = b.polygon[b.polygon[:, 0] > b.polygon[:, 0].max() - 1e-9, 1].mean()
    assert z * face < 0.0  # what is left in front is the other edge


def test_a_gap_in_the_rows_makes_two_pieces():
    f = fragment(rows=5, columns=1)
    keep = f.row != 2
    gap = Fragment(**{k: (v[keep] if isinstance(v := getattr(f, k), np.ndarray) else v) for k in f.__slots__})
    assert [round(area(b.polygon) / H / D, 6) for b in pieces(gap)] == [1.5, 2.0]


def handed_over(ahead, f=None, boost=(0.0, 0.0, 0.0), pitch=D):
    """What a port says of a fragment whose front stands ``ahead`` of the middle of a slope, and its layer."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H, added_mass=0.2)
    port = RubblePort(
        plane_slope(np.pi / 4, top=5.0, toe_depth=20.0), physics, pitch=pitch, origin=1.0, domain=Domain()
    )
    f = f or fragment()
    f = replace(f, position=f.position + np.array([ahead, 0.0, 0.0]), velocity=f.velocity + np.array(boost))
    return port.add(f), port.layer


def six(f, about=(0.0, 0.0, 0.0)):
    """Momentum of all the ice of a fragment's nodes, each in the middle of its ice, and its moment about a point."""
    ahead = f.lead - 0.5 * f.length
    at = f.position + np.column_stack([ahead, 0.0 * ahead, -ahead * np.tan(f.tilt)]) - about
    mass = 846.0 * H * f.length * f.width
    spin = np.cross(at, mass[:, None] * f.velocity)
    spin[:, 1] += mass * H**2 / 12.0 * f.tilt_rate
    return np.concatenate([(mass[:, None] * f.velocity).sum(axis=0), spin.sum(axis=0)])


def six_of(layer):
    """The same of the plates of a layer."""
    tables = layer.store.tables
    return momenta(layer.store.plates, tables.mass, tables.spin)


@pytest.mark.parametrize("ahead", [-5.0, 1.0])
def test_a_fragment_is_one_plate_with_its_six_momenta(ahead):
    moved, layer = handed_over(ahead)
    assert moved.blocks == len(layer.blocks) == 1
    assert len(layer.blocks[0].pieces) == 3
    assert (moved.trimmed > 0.01 * moved.mass) == (ahead > 0.0)
    assert moved.momentum_error < 1e-12
    assert moved.angular_momentum_error < 1e-12


BOOSTS = [(0.0, 0.0, 0.0), (0.4, 0.0, 0.0), (-3.0, 2.0, 1.0)]
#: whole and before the slope; crushed before; trimmed on it; both, and off its lower edge
CUTS = [(-5.0, 0.0, 1.0), (-5.0, 2.0, 1.0), (1.0, 0.0, 1.0), (1.5, 4.0, -1.0)]


@pytest.mark.parametrize("boost", BOOSTS)
@pytest.mark.parametrize(("ahead", "cut", "face"), CUTS)
def test_what_stays_and_what_is_crushed_have_the_momenta_of_the_nodes(ahead, cut, face, boost):
    """All six, for any observer; not so without the part of the crushed ice."""
    f = fragment(cut=cut, face=face)
    moved, layer = handed_over(ahead, f, boost)
    at = replace(f, position=f.position + np.array([ahead, 0, 0]), velocity=f.velocity + boost)
    left, stays = six(at), six_of(layer)
    size = np.repeat([np.abs(left[:3]).max(), np.abs(left[3:]).max()], 3)
    assert not moved.held.any()
    assert (np.abs(stays + moved.crushed - left) < 1e-11 * size).all()
    if cut or ahead > 0.0:
        assert np.abs(stays - left).max() > 1e-3 * size.max()
    assert not np.allclose(stays[3:], -left[3:], rtol=1e-3)


def seen(f, ahead, boost):
    """Motion of the plate that a fragment becomes, for an observer against whom all goes faster by ``boost``."""
    plate = handed_over(ahead, f, boost)[1].blocks[0]
    return plate.position.copy(), plate.velocity - boost, plate.omega.copy()


@pytest.mark.parametrize("boost", BOOSTS[1:])
@pytest.mark.parametrize(("ahead", "cut", "face"), CUTS)
def test_a_hand_over_is_the_same_for_every_observer(ahead, cut, face, boost):
    """Galilei: a uniform motion of all ice adds to the velocity of the plate and does not turn it."""
    f = fragment(cut=cut, face=face)
    for here, there in zip(seen(f, ahead, np.zeros(3)), seen(f, ahead, np.array(boost)), strict=True):
        np.testing.assert_allclose(there, here, rtol=0.0, atol=1e-13 * max(1.0, np.abs(boost).max()))


@pytest.mark.parametrize("about_its_centre", [True, False])
def test_a_plate_that_forgets_its_crushed_ice_is_rejected(about_its_centre, monkeypatch):
    """Twins: made of what is left alone, a plate turns as the observer has it, or does not keep the momenta."""
    room = coupling.rubble_port.hand_over
    known, motion = room.births, room._motion

    def other(whole, still, left):
        shift = np.cross(left.centre - whole.position, left.linear)
        return motion(whole, still, replace(left, spin=left.spin + (shift if about_its_centre else 0.0)))

    monkeypatch.setattr(room, "births", lambda *a: (replace(b, whole=b.polygon) for b in known(*a)))
    monkeypatch.setattr(room, "_motion", other)
    f = fragment(cut=2.0)
    turns = [seen(f, -5.0, np.array([v, 0.0, 0.0]))[2] for v in (0.0, 0.4)]
    assert (np.abs(turns[1] - turns[0]).max() > 1e-3) == about_its_centre
    assert (handed_over(-5.0, f)[0].angular_momentum_error > 1e-3) != about_its_centre


def test_nothing_is_left_of_a_fragment():
    """All of it is crushed, and takes all its momenta along."""
    f = fragment(rows=1)
    moved, layer = handed_over(30.0, f)
    assert moved.blocks == len(layer.blocks) == 0
    assert moved.trimmed == moved.mass
    at = replace(f, position=f.position + np.array([30.0, 0, 0]))
    np.testing.assert_allclose(moved.crushed, six(at), rtol=1e-10, atol=1e-10 * np.abs(six(at)).max())


def test_what_neighbours_hold_of_a_narrow_plate_is_told():
    """A plate that one plane alone sees turns about y; the rest of its angular momentum is not lost in silence."""
    f = fragment(columns=1)
    f = replace(f, velocity=f.velocity + np.outer(f.position[:, 0], [0.0, 0.03, 0.0]))
    moved, layer = handed_over(-5.0, f)
    at = replace(f, position=f.position + np.array([-5.0, 0, 0]))
    missing = six(at) - six_of(layer)
    size = np.abs(six(at)[3:]).max()
    np.testing.assert_allclose(missing[:3], 0.0, atol=1e-10 * size)
    np.testing.assert_allclose(missing[3:], moved.held, atol=1e-10 * size)
    assert abs(moved.held[2]) > 1e-2 * size
    assert moved.angular_momentum_error < 1e-12


def test_a_plate_of_a_rigid_fragment_moves_as_it_did():
    """But for the ice of a node, which has a length in a plate and none in the lattice (2.22)."""
    _, layer = handed_over(-5.0)
    plate = layer.blocks[0]
    np.testing.assert_allclose(plate.omega, [0.0, -0.05, 0.0], atol=0.01)
    np.testing.assert_allclose(plate.rotation[:, 0], [np.cos(0.1), 0.0, np.sin(0.1)], atol=1e-12)


def test_a_hand_over_that_spoils_the_angular_momentum_is_found(monkeypatch):
    monkeypatch.setattr(coupling.rubble_port.hand_over.np.linalg, "solve", lambda a, b: 0.9 * solve(a, b))
    assert handed_over(-5.0)[0].angular_momentum_error > 1e-3


def test_angular_momentum_of_a_turning_plate():
    """Nodes in a row, d apart: sum of m x^2 omega about their centre, and m h^2 / 12 each."""
    f = fragment(rows=4, columns=1, turn=0.0, omega=0.05)
    found = Momenta.of(f, H, 846.0)
    ice = f.position[:, 0] + np.where(f.row == 0, -D / 4, 0.0)
    assert found.centre[0] == pytest.approx(np.average(ice, weights=f.mass), rel=1e-12)
    x, swing = ice - found.centre[0], f.velocity[:, 2] - np.average(f.velocity[:, 2], weights=f.mass)
    assert found.spin[1] == pytest.approx(-(f.mass * (x * swing + 0.05 * H**2 / 12)).sum(), rel=1e-12)
    assert found.scale[1] >= abs(found.spin[1])


@pytest.mark.parametrize(("backfill", "part"), [("filling", 0.375), ("full", 1.0), ("none", 0.0)])
def test_a_plate_begins_with_the_water_that_its_nodes_had_on_top(backfill, part):
    """Where tops fill: the mean over its ice; else all plates are as `RubblePhysics.backfill` has it."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H, backfill=backfill)
    slope = plane_slope(np.pi / 4, top=5.0, toe_depth=20.0)
    port = RubblePort(slope, physics, pitch=D, origin=1.0, domain=Domain())
    f = fragment(columns=2)
    f = replace(f, flooded=np.where(f.column == 0, 0.25, 0.5), position=f.position + np.array([-5.0, 0.0, 0.0]))
    port.add(f)
    assert [b.flooded for b in port.layer.blocks] == pytest.approx([part])
