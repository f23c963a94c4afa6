"""Plates break again where and when a rigid beam does, and part without losing mass or momentum."""

from __future__ import annotations

import numpy as np
import pytest

from rubble.bending import CELLS, Ice, Loaded, judge, put
from rubble.breaking import part
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Start, prism_at
from rubble.rig import Hinge

H, L, B, RHO_I, RHO_W, SIGMA, G = 1.0, 24.0, 4.0, 900.0, 1000.0, 100e3, 9.81
STILL = np.zeros(3)


def layer(**options) -> RubbleLayer:
    usual = {"flexural_strength": SIGMA, "breaking_time": 0.1, "form_drag": 0.0, "skin_drag": 0.0}
    return RubbleLayer(RubblePhysics(rho_i=RHO_I, rho_w=RHO_W, thickness=H, **{**usual, **options}), 2.0)


def float_plate(rubble, length=L, width=B, columns=2, velocity=STILL, omega=STILL):
    """A plate of so many columns that floats flat; its number."""
    box = np.array([(-length, -H), (length, -H), (length, H), (-length, H)]) / 2
    each = width / columns
    prisms = [prism_at(box, (k + 0.5) * each - width / 2, each, RHO_I) for k in range(columns)]
    start = Start(
        np.array([0.0, 0.0, H / 2 - H * RHO_I / RHO_W]), np.array([1.0, 0.0, 0.0, 0.0]), velocity.copy(), omega.copy()
    )
    return rubble.add_plate(prisms, start)


@pytest.mark.parametrize("end", [-1.0, 1.0])
def test_a_floating_beam_with_a_tip_load_breaks_at_a_third_of_its_length(end):
    """Rigid on water: M = P s (1 - s/L)^2 from the tip, 4 P L / 27 at L/3; the tip sinks by 4 P / (k L)."""
    rubble = layer()
    number = float_plate(rubble)
    speed = 0.005
    z = float(rubble.block(number).position[2])
    Hinge(rubble, number, (end * L / 2, 0.0, z), (0.0, 0.0, -speed))
    while not rubble.breaks and rubble.time < 40.0:
        rubble.advance(4)
    load = 27 * SIGMA * B * H**2 / (24 * L)
    assert rubble.time * speed == pytest.approx(4 * load / (RHO_W * G * B * L), rel=0.02)
    found = rubble.breaks[0]
    assert found.position[0] == pytest.approx(end * (L / 2 - L / 3), abs=0.02 * L)
    assert sorted(found.lengths) == pytest.approx([L / 3, 2 * L / 3], rel=1e-6)
    assert found.areas == pytest.approx([n * B for n in found.lengths], rel=1e-9)


def test_a_beam_that_is_loaded_less_does_not_break():
    rubble = layer(flexural_strength=1.1 * SIGMA)
    number = float_plate(rubble)
    Hinge(rubble, number, (-L / 2, 0.0, float(rubble.block(number).position[2])), (0.0, 0.0, -0.005))
    seconds = 4 * 27 * SIGMA * B * H**2 / (24 * L) / (RHO_W * G * B * L) / 0.005
    rubble.advance(round(seconds / 0.005))
    assert not rubble.breaks


def loaded(span, forces):
    """Forces normal to a plate at places along both axes."""
    out = Loaded(np.array([0, -1]), span[None], np.zeros((1, 2, CELLS + 1, 3)))
    for x, y, f in forces:
        put(span[0], out.impulse[0, 0], x, f, 0.0, 0.0)
        put(span[1], out.impulse[0, 1], y, f, 0.0, 0.0)
    return out


@pytest.mark.parametrize("axis", [0, 1])
def test_a_free_plate_that_is_hit_at_its_end_is_bent_by_its_inertia(axis):
    """Neither water nor weight: the moment is P s (1 - s/L)^2; a twin without inertia would have P s."""
    rubble = layer()
    size = (L, B) if axis == 0 else (B, L)
    number = float_plate(rubble, length=size[0], width=size[1], columns=3)
    plate = rubble.block(number)
    at = [0.0, 0.0]
    at[axis] = -L / 2
    force = 1e4
    ice = Ice(RHO_I, H, SIGMA, 0.0, 0.0)
    stress, cut, place = judge(
        plate.row, 0, rubble.store.plates, rubble.store.tables.pieces, loaded(plate.span, [(*at, force)]), 1.0, ice
    )
    assert cut == axis
    assert place == pytest.approx(-L / 2 + L / 3, rel=1e-9)
    assert stress * SIGMA == pytest.approx(6 * (4 * force * L / 27) / (B * H**2), rel=5e-3)
    without_inertia = 6 * force * (L - H) / (B * H**2)
    assert stress * SIGMA < 0.2 * without_inertia


def test_thrust_closes_a_crack():
    """6 M / (w h^2) - N / (w h): a plate that is pressed along its axis bears more."""
    rubble = layer()
    plate = rubble.block(float_plate(rubble))
    ice = Ice(RHO_I, H, SIGMA, 0.0, 0.0)
    bent = loaded(plate.span, [(-L / 2, 0.0, 1e4), (0.0, 0.0, -2e4), (L / 2, 0.0, 1e4)])
    tables = rubble.store.plates, rubble.store.tables.pieces
    stress = judge(plate.row, 0, *tables, bent, 1.0, ice)[0]
    assert stress * SIGMA == pytest.approx(6 * (1e4 * L / 2) / (B * H**2), rel=1e-9)
    thrust = 2e4
    put(bent.span[0, 0], bent.impulse[0, 0], -L / 2, 0.0, thrust, 0.0)
    put(bent.span[0, 0], bent.impulse[0, 0], L / 2, 0.0, -thrust, 0.0)
    assert judge(plate.row, 0, *tables, bent, 1.0, ice)[0] * SIGMA == pytest.approx(
        stress * SIGMA - thrust / (B * H), rel=1e-9
    )


@pytest.mark.parametrize(("axis", "place"), [(0, -3.0), (1, 0.5), (1, -1.0)])
def test_parts_move_on_as_the_rigid_body_did(axis, place):
    """Mass, all six momenta and, without added mass, the kinetic energy are kept to rounding."""
    rubble = layer()
    number = float_plate(
        rubble, width=12.0, columns=4, velocity=np.array([0.3, -0.2, 0.1]), omega=np.array([0.02, -0.05, 0.1])
    )
    plate, before = rubble.block(number), rubble.store.carried
    mass, energy, corner = rubble.mass, rubble.runner.energies(rubble.store)[0], plate.outline.copy()
    found = part(rubble.store, plate, np.array([1.0, axis, place]))
    assert found is not None
    new, told = found
    rubble.store.replace([(plate, new)])
    assert [p.id for p in rubble.blocks] == [p.id for p in new]
    assert rubble.mass == pytest.approx(mass, rel=1e-14)
    assert rubble.store.carried == pytest.approx(before, rel=1e-12, abs=1e-12 * np.abs(before).max())
    assert rubble.runner.energies(rubble.store)[0] == pytest.approx(energy, rel=1e-12)
    whole = (L, 12.0)[axis]
    assert sum(told.lengths) == pytest.approx(whole, rel=1e-12)
    assert told.lengths[0] == pytest.approx(place + whole / 2, rel=1e-12)
    assert min(np.abs(corner - c).sum(axis=1).min() for c in new[0].outline[:1]) < (1e-9 if axis == 0 else np.inf)


def test_short_plates_do_not_break():
    """Both parts would be shorter than they are thick."""
    rubble = layer(flexural_strength=1.0)
    number = float_plate(rubble, length=1.9 * H, width=1.9 * H)
    Hinge(rubble, number, (-0.95 * H, 0.0, float(rubble.block(number).position[2])), (0.0, 0.0, -0.01))
    rubble.advance(400)
    assert not rubble.breaks
    assert len(rubble.blocks) == 1
