"""Crushed ice comes off: no corner stands in the structure for long, and what is lost is in the books."""

import numpy as np
import pytest

import rubble.wear
from rubble.cut import plane
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Start, prism_at, turned
from rubble.rig import thrust
from rubble.round import closed, depth_at
from tests.rubble.cone_scene import WIDTH, H, cone_cut, rectangle

GENERATOR = np.array([(-20.0, 5.0), (-10.0, 5.0), (5.0, 20.0)])  #: of `cone_scene.cone_cut`
RHO = 846.0


def dry(**options):
    """Ice that neither falls nor floats, of little strength."""
    return RubblePhysics(rho_i=RHO, rho_w=1e-9, g=0.0, thickness=H, restitution=0.0, contact_strength=2e5, **options)


def before_the_cone(place, velocity, pieces=4):
    """A plate of pieces side by side, 6 m long, that moves towards the cone."""
    layer = RubbleLayer(dry(), WIDTH, solids=cone_cut, generator=GENERATOR)
    prisms = [
        prism_at(rectangle(-3.0, -H / 2, 3.0, H / 2), (i - (pieces - 1) / 2) * WIDTH, WIDTH, RHO) for i in range(pieces)
    ]
    layer.add_plate(prisms, Start(np.array(place), turned(0.0), np.array(velocity), np.zeros(3)), fragment=3)
    return layer


def deepest(layer):
    corners = layer.corners
    return max(depth_at(closed(GENERATOR), np.hypot(x, y), z)[0] for x, y, z in corners)


def test_no_corner_stands_deeper_in_a_cone_than_a_hundredth_of_the_thickness(monkeypatch):
    def worst():
        layer = before_the_cone((-18.2, 3.0, -1.6), (0.6, 0.0, 0.0))
        thrust(layer, 0, (1.5e6, 0.0, 0.0))
        depths = []
        for _ in range(60):
            layer.advance(10)
            depths.append(deepest(layer))
        return max(depths), layer

    found, layer = worst()
    assert 0.5 * layer.physics.slop < found < 0.01 * H
    assert layer.crushed.mass > 0.0
    monkeypatch.setattr(rubble.wear, "WORN", np.inf)
    assert worst()[0] > 0.03 * H  # ice that stays as overlap


def test_what_comes_off_is_booked_with_mass_momentum_and_energy():
    layer = before_the_cone((-18.2, 3.0, -1.6), (2.0, 0.0, 0.1))
    mass, carried = layer.mass, layer.store.carried
    runner, scale = layer.runner, np.zeros(6)
    start = runner.energy_of(layer.block(0))
    for _ in range(40):
        before = runner.momenta.copy()
        layer.advance(10)
        scale += np.abs(runner.momenta - before).sum(axis=0)
    assert layer.crushed.mass > 1e-4 * mass
    assert layer.mass + layer.crushed.mass == pytest.approx(mass, rel=1e-12)
    gained, received = layer.store.carried - carried, runner.momenta.sum(axis=0)
    assert np.abs(gained - received).max() < 1e-12 * scale.max()
    books = {name: float(runner.books[name][0]) for name in runner.books.dtype.names}
    losses = sum(v for name, v in books.items() if name.startswith(("impact_", "friction_")))
    losses += layer.crushed.energy + books["drag_loss"] - books["correction"] - books["stepping"]
    assert runner.energy_of(layer.block(0)) + losses == pytest.approx(start, rel=1e-3)
    assert layer.crushed.energy > 0.0


def test_a_plate_goes_on_as_itself():
    layer = before_the_cone((-18.2, 3.0, -1.6), (0.6, 0.0, 0.0))
    thrust(layer, 0, (1.5e6, 0.0, 0.0))
    plate = layer.block(0)
    plate.rows.flooded[plate.row], plate.aligned = 0.25, True
    pieces = [p.number for p in plate.pieces]
    for _ in range(40):
        layer.advance(10)
    left = layer.block(0)
    assert left is not plate
    assert (left.fragment, left.aligned, left.flooded) == (3, True, pytest.approx(0.25, abs=0.1))
    assert left.thrust == pytest.approx([1.5e6, 0, 0, 0, 0, 0])
    assert [p.number for p in left.pieces] == pieces  # contacts with other ice go on
    assert max(p.worn for p in left.pieces) > 3  # features of an outline that has lost a corner are other ones
    assert layer.load_on_structure[0, 0] > 0.0
    assert left.mass == pytest.approx(sum(p.prism.mass for p in left.pieces), rel=1e-12)


def test_a_side_that_meets_the_structure_makes_the_piece_narrower():
    """A flank that looks more along y than along the slice: the outline would lose a strip of its whole width."""
    plate = before_the_cone((-40.0, 0.0, -1.6), (0.0, 0.0, 0.0), pieces=1).block(0)
    piece, normal = plate.pieces[0], np.array([0.6, -0.8, 0.0])
    bite = rubble.wear.Bite(np.array([3.0, 0.5 * WIDTH, -H / 2]), normal, 0.02)
    outline, y, widths = rubble.wear._bitten(piece, [bite], slop=0.015, thickness=H)
    assert outline == pytest.approx(piece.prism.polygon)
    assert widths == pytest.approx([WIDTH - 0.02 / 0.8])
    assert y + 0.5 * widths[0] == pytest.approx(0.5 * WIDTH - 0.02 / 0.8)
    assert y - 0.5 * widths[0] == pytest.approx(-0.5 * WIDTH)  # the other side stays
    steeper = rubble.wear.Bite(bite.spot, np.array([-0.8, -0.6, 0.0]), 0.02)
    outline, y, widths = rubble.wear._bitten(piece, [steeper], slop=0.015, thickness=H)
    assert (y, widths[0]) == (0.0, WIDTH)
    assert outline[:, 0].max() == pytest.approx(3.0 - 0.02 / 0.8)


def test_a_corner_of_the_structure_leaves_the_face_of_the_ice_as_it_is():
    """The notch would not be convex: the ice before it would go as well."""
    wedge = np.array([(0.0, 0.0), (4.0, -1.0), (4.0, 1.0)])
    layer = RubbleLayer(dry(), WIDTH, solids=lambda _: plane([wedge]))
    prisms = [prism_at(rectangle(-6.0, -3.0, 0.0, 3.0), 0.0, WIDTH, RHO)]
    layer.add_plate(prisms, Start(np.zeros(3), turned(0.0), np.array([0.5, 0.0, 0.0]), np.zeros(3)))
    thrust(layer, 0, (1e6, 0.0, 0.0))
    layer.advance(400)
    assert layer.block(0).outline[:, 0].max() > 0.05 * H
    assert layer.crushed.mass == 0.0


def test_a_plate_of_which_nothing_is_left_is_gone():
    layer = RubbleLayer(dry(), WIDTH, solids=lambda _: plane([rectangle(0.0, -9.0, 9.0, 9.0)]))
    prisms = [prism_at(rectangle(-0.2, -0.1, 0.0, 0.1), 0.0, WIDTH, RHO)]
    layer.add_plate(prisms, Start(np.zeros(3), turned(0.0), np.array([40.0, 0.0, 0.0]), np.zeros(3)))
    mass = layer.mass
    layer.advance(40)
    assert layer.blocks == []
    assert layer.crushed.mass == pytest.approx(mass, rel=1e-12)
    layer.advance(10)


def test_an_outline_keeps_few_corners_and_gains_no_ice():
    angle = np.linspace(0.0, 2.0 * np.pi, 60, endpoint=False)
    circle = np.column_stack((np.cos(angle), np.sin(angle)))
    left = rubble.wear._fewer(circle, tiny=0.0)
    assert len(left) == rubble.wear.MOST
    assert np.hypot(*left.T).max() <= 1.0 + 1e-12
    square = rectangle(0.0, 0.0, 1.0, 1.0)
    doubled = np.insert(square, 2, [[1.0, 1.0 - 1e-12], [1.0, 0.5]], axis=0)  # nearly the same, and on an edge
    assert sorted(map(tuple, rubble.wear._fewer(doubled, tiny=1e-6).round(9))) == sorted(map(tuple, square))
