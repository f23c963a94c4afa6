"""A fragment and its blocks: same ice, same place, same motion."""

from dataclasses import replace

import numpy as np
import pytest

import coupling.rubble_port.hand_over
from coupling.interface import Fragment
from coupling.rubble_port import RubblePort
from coupling.rubble_port.births import births, centre_of, momenta_of
from coupling.structure import plane_slope
from rubble.domain import Domain
from rubble.physics import RubblePhysics

D, H = 2.0, 3.0


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


def test_blocks_hold_the_ice_of_their_columns():
    blocks = list(births(fragment(), H, 1))
    assert len(blocks) == 3
    for b in blocks:
        assert area(b.polygon) == pytest.approx(3.5 * D * H, rel=1e-12)
        assert b.widths.sum() == pytest.approx(4 * D)
        assert b.mass == pytest.approx(846.0 * H * D * 3.5 * D, rel=1e-12)


def test_a_rigid_piece_keeps_its_place_and_motion():
    for b in births(fragment(), H, 1):
        assert b.angle == pytest.approx(0.1, rel=1e-9)
        assert b.omega == pytest.approx(0.05, rel=1e-9)
        x, z = b.centre
        np.testing.assert_allclose(b.velocity, [0.1 - 0.05 * z, 0.02, 0.05 * x - 0.3], rtol=1e-9)
        front = b.polygon[np.argmax(b.polygon[:, 0])]
        assert np.hypot(front[0], front[1] + 1.0) == pytest.approx(H / 2, rel=1e-5)  # the front node is mid-height


def test_linear_momentum_is_that_of_the_nodes():
    f = fragment(omega=0.3)
    total = sum(b.mass * b.velocity for b in births(f, H, 2))
    np.testing.assert_allclose(total, (f.mass[:, None] * f.velocity).sum(axis=0), rtol=1e-12)
    assert not np.allclose(total, -(f.mass[:, None] * f.velocity).sum(axis=0))


@pytest.mark.parametrize("face", [1.0, -1.0])
@pytest.mark.parametrize("cut", [0.5, 2.9, 4.5])
def test_the_crushed_edge_is_cut_off(cut, face):
    b = next(births(fragment(turn=0.0, omega=0.0, cut=cut, face=face), H, 1))
    lost = 0.5 * cut**2 if cut < H else H * cut - 0.5 * H**2
    assert area(b.polygon) == pytest.approx(3.5 * D * H - lost, rel=1e-9)
    z = b.polygon[b.polygon[:, 0] > b.polygon[:, 0].max() - 1e-9, 1].mean() + 1.0
    assert z * face < 0.0  # what is left in front is the other edge


def test_a_gap_in_the_rows_makes_two_blocks():
    f = fragment(rows=5, columns=1)
    keep = f.row != 2
    gap = Fragment(**{k: (v[keep] if isinstance(v := getattr(f, k), np.ndarray) else v) for k in f.__slots__})
    assert [round(area(b.polygon) / H / D, 6) for b in births(gap, H, 1)] == [1.5, 2.0]


def test_two_columns_in_a_section_are_one_block_with_both_widths():
    blocks = list(births(fragment(), H, 2))
    assert len(blocks) == 2
    np.testing.assert_allclose(blocks[0].widths, 2 * D)
    np.testing.assert_allclose(blocks[1].widths, D)


def handed_over(ahead, omega=0.05):
    """What a port says of a fragment whose front stands ``ahead`` of the middle of a slope."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H, added_mass=0.2)
    port = RubblePort(
        plane_slope(np.pi / 4, top=5.0, toe_depth=20.0),
        physics,
        pitch=D,
        origin=1.0,
        columns_per_section=1,
        domain=Domain(),
    )
    f = fragment(omega=omega)
    return port.add(replace(f, position=f.position + np.array([ahead, 0.0, 0.0])))


@pytest.mark.parametrize("ahead", [-5.0, 1.0])
def test_momentum_linear_and_angular_of_a_fragment_goes_over_with_what_is_trimmed(ahead):
    moved = handed_over(ahead)
    assert moved.blocks == 3
    assert (moved.trimmed > 0.01 * moved.mass) == (ahead > 0.0)
    assert moved.momentum_error < 1e-12
    assert moved.angular_momentum_error < 1e-12
    assert 0.0 < moved.angular_momentum_change < 0.2


@pytest.mark.parametrize("wrong", [{"omega": -0.05}, {"centre": np.array([1.0, 0.0])}, {"inertia": 1.0}])
def test_a_hand_over_that_spoils_the_angular_momentum_is_found(monkeypatch, wrong):
    def wrong_births(*args):
        return (replace(b, **wrong) for b in births(*args))

    monkeypatch.setattr(coupling.rubble_port.hand_over, "births", wrong_births)
    assert handed_over(-5.0).angular_momentum_error > 1e-3


def test_angular_momentum_of_a_turning_plate():
    """Nodes in a row, d apart: sum of m x^2 omega about their centre, and m h^2 / 12 each."""
    f = fragment(rows=4, columns=1, turn=0.0, omega=0.05)
    total, scale = momenta_of(f, H, centre_of(f))
    x = f.position[:, 0] - np.average(f.position[:, 0], weights=f.mass)
    assert total[3] == pytest.approx(0.05 * (f.mass * (x**2 + H**2 / 12)).sum(), rel=1e-12)
    assert scale[3] >= abs(total[3])


@pytest.mark.parametrize(("backfill", "parts"), [("filling", (0.25, 0.5)), ("full", (1.0, 1.0)), ("none", (0.0, 0.0))])
def test_a_block_begins_with_the_water_that_its_nodes_had_on_top(backfill, parts):
    """Where tops of blocks fill; else all blocks are as `RubblePhysics.backfill` has it."""
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=H, backfill=backfill)
    slope = plane_slope(np.pi / 4, top=5.0, toe_depth=20.0)
    port = RubblePort(slope, physics, pitch=D, origin=1.0, columns_per_section=1, domain=Domain())
    f = fragment(columns=2)
    f = replace(f, flooded=np.where(f.column == 0, 0.25, 0.5), position=f.position + np.array([-5.0, 0.0, 0.0]))
    port.add(f)
    assert tuple(b.flooded for b in port.layer.blocks) == pytest.approx(parts)
