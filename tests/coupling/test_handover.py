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


def handed_over(ahead, omega=0.05):
    """What a port says of a fragment whose front stands ``ahead`` of the middle of a slope, and its layer."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H, added_mass=0.2)
    port = RubblePort(plane_slope(np.pi / 4, top=5.0, toe_depth=20.0), physics, pitch=D, origin=1.0, domain=Domain())
    f = fragment(omega=omega)
    return port.add(replace(f, position=f.position + np.array([ahead, 0.0, 0.0]))), port.layer


@pytest.mark.parametrize("ahead", [-5.0, 1.0])
def test_a_fragment_is_one_plate_with_its_six_momenta(ahead):
    moved, layer = handed_over(ahead)
    assert moved.blocks == len(layer.blocks) == 1
    assert len(layer.blocks[0].pieces) == 3
    assert (moved.trimmed > 0.01 * moved.mass) == (ahead > 0.0)
    assert moved.momentum_error < 1e-12
    assert moved.angular_momentum_error < 1e-12


def test_the_momenta_are_those_of_the_nodes():
    _, layer = handed_over(-5.0)
    f = fragment()
    at = f.position + np.array([-5.0, 0.0, 0.0])
    p = f.mass[:, None] * f.velocity
    spin = np.cross(at, p)
    spin[:, 1] += f.mass * H**2 / 12.0 * f.tilt_rate
    tables = layer.store.tables
    found = momenta(layer.store.plates, tables.mass, tables.spin)
    np.testing.assert_allclose(found[:3], p.sum(axis=0), rtol=1e-12)
    np.testing.assert_allclose(found[3:], spin.sum(axis=0), rtol=1e-9)
    assert not np.allclose(found[3:], -spin.sum(axis=0), rtol=1e-3)


def test_a_plate_of_a_rigid_fragment_moves_as_it_did():
    """But for the mass, which nodes have at the edge of their ice and a plate has in its middle."""
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
    centre = np.average(f.position, axis=0, weights=f.mass)
    found = Momenta.of(f, H, centre)
    x = f.position[:, 0] - centre[0]
    assert found.angular[1] == pytest.approx(-0.05 * (f.mass * (x**2 + H**2 / 12)).sum(), rel=1e-12)
    assert found.scale[1] >= abs(found.angular[1])


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
