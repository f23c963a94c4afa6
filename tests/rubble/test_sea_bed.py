"""The sea bed: rubble stands on it, slides on it with its friction, and everything that it gives is booked."""

import numpy as np
import pytest

from rubble.books import GROUND
from rubble.cut import plane
from rubble.energy import energy_terms
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.plates import momenta
from rubble.rig import thrust

RHO_I, RHO_W, G, H, WIDTH, DEPTH = 900.0, 1025.0, 9.81, 1.5, 3.0, 12.0
ICE = dict(rho_i=RHO_I, rho_w=RHO_W, g=G, thickness=H)


def rectangle(x0, z0, x1, z1):
    return np.array([(x0, z0), (x1, z0), (x1, z1), (x0, z1)], dtype=float)


def add(layer, x, z, length, velocity=(0.0, 0.0), y=None, height=H):
    ends = np.array([x, x + length])
    slab = Slab(rectangle(x, z, x + length, z + height), ends, np.array([WIDTH]), RHO_I)
    return layer.add_block(0, slab, velocity, y=y)


def open_box(_y):
    """Two smooth walls through the bed: they carry nothing of what is pressed down between them."""
    return plane([rectangle(-9, -30, -7, 0), rectangle(7, -30, 9, 0)])


def test_a_pile_that_is_pressed_down_stands_on_the_bed_with_the_press_less_its_buoyancy():
    physics = RubblePhysics(**ICE, depth=DEPTH, mu_structure=0.0, form_drag=5.0)
    layer = RubbleLayer(physics, WIDTH, solids=open_box)
    random = np.random.default_rng(1)
    for i in range(9):
        add(layer, -6.5 + 4.4 * (i % 3) + random.uniform(0.0, 0.4), -11.9 + 1.7 * (i // 3), 3.5)
    lid = add(layer, -6.9, -6.5, 13.8)
    lift = (RHO_W - RHO_I) * G * H * WIDTH * (9 * 3.5 + 13.8)
    press = 3.0 * lift
    thrust(layer, lid, (0.0, 0.0, -press))
    layer.advance(6000)
    layer.advance(200)
    assert layer.table().position[:, 2].max() < -H  # all of it under water
    on_bed = layer.budget["sea_bed"]
    assert on_bed[1] == pytest.approx(press - lift, rel=1e-3)
    assert abs(on_bed[0]) < 0.05 * press  # friction under what leans on the walls
    assert not np.isclose(on_bed[1], press, rtol=0.1)  # a twin that forgets the buoyancy
    assert not layer.load_on_structure[:, 2].any()
    assert min(b.outline[:, 1].min() for b in layer.blocks) > -DEPTH - 0.01 * H


def sliding(push, mu, seconds=4.0, y=0.0):
    """A block under water, pressed down and pushed along the bed; its layer, its mass and the force on the bed."""
    physics = RubblePhysics(**ICE, depth=DEPTH, mu_bed=mu, form_drag=0.0, skin_drag=0.0)
    layer = RubbleLayer(physics, WIDTH)
    number = add(layer, 0.0, -DEPTH, 4.0, y=y)
    lift = (RHO_W - RHO_I) * G * H * WIDTH * 4.0
    thrust(layer, number, (push * lift, 0.0, -2.0 * lift))
    layer.advance(round(seconds / physics.substep))
    return layer, layer.block(number), lift


def test_a_block_slides_on_the_bed_against_mu_times_what_it_stands_on():
    """Pressed with twice its lift it stands on the bed with once its lift; 0.5 of that along, less 0.3 of friction."""
    layer, block, lift = sliding(0.5, 0.3)
    assert layer.budget["sea_bed"] == pytest.approx([-0.3 * lift, lift], rel=1e-3)
    assert block.velocity[0] == pytest.approx(0.2 * lift / block.mass * 4.0, rel=1e-3)
    assert abs(block.velocity[2]) < 1e-6
    assert layer.sheet_forces(0).shape == (0, 3)
    assert not layer.load_on_structure.any()


def test_below_its_friction_it_stands_and_without_friction_it_does_not():
    _, block, lift = sliding(0.29, 0.3)
    assert abs(block.velocity[0]) < 1e-9
    _, twin, _ = sliding(0.29, 0.0)
    assert twin.velocity[0] == pytest.approx(0.29 * lift / twin.mass * 4.0, rel=1e-3)


def lively(depth=DEPTH, substeps=1000, substep=0.005, restitution=0.3):
    """Blocks of two sections' width, thrown on the bed; the layer and the largest momenta that came in."""
    physics = RubblePhysics(
        **ICE, depth=depth, substep=substep, restitution=restitution, added_mass=0.2, added_inertia=0.2
    )
    layer = RubbleLayer(physics, 0.5 * WIDTH)
    for i in range(9):
        number = add(layer, 4.0 * (i % 3), -7.0 - 1.8 * (i // 3), 3.0, (0.5 * (i % 2), 0.1, -1.0), y=0.3 * (i % 3))
        lift = (RHO_W / RHO_I - 1.0) * G * layer.block(number).mass
        thrust(layer, number, (0.5 * lift, 0.1 * lift, -2.0 * lift))
    scale, before = np.zeros(6), layer.runner.momenta.copy()
    start = carried(layer), energy_terms(layer)
    for _ in range(substeps // 10):
        layer.advance(10)
        scale += np.abs(layer.runner.momenta - before).sum(axis=0)
        before = layer.runner.momenta.copy()
    return layer, start, scale


def carried(layer):
    plates = layer.store.plates
    return momenta(plates, plates.moved[:-1], plates.inertia[:-1])


def test_six_momenta_are_kept_and_a_bed_of_the_wrong_sign_is_found():
    layer, (start, _), scale = lively()
    gained, received = carried(layer) - start, layer.runner.momenta
    assert np.abs(received[GROUND]).max() > 1e4
    assert (np.abs(gained - received.sum(axis=0)) / scale).max() < 1e-12
    received[GROUND] *= -1.0
    assert (np.abs(gained - received.sum(axis=0)) / scale).max() > 1e-2


def test_the_bed_is_a_term_of_what_carries_the_rubble():
    """Water, drag, inertia and bed balance in every window; without the bed they do not."""
    layer, _, _ = lively(substeps=1)
    for _ in range(100):
        layer.advance(10)
        terms = np.array([*layer.budget.values()])
        assert np.abs(terms.sum(axis=0)).max() < 1e-9 * np.abs(terms).max()
    assert layer.budget["sea_bed"][1] > 0.1 * np.abs(terms).max()


def test_energy_that_the_bed_takes_is_booked():
    """What no term explains is below 1e-6 of what the bed takes by impacts and friction."""
    layer, (_, start), _ = lively(substeps=2000, substep=0.0025)
    change = {name: value - start[name] for name, value in energy_terms(layer).items()}
    stores = change["rubble_kinetic"] + change["rubble_potential"]
    lost = sum(value for name, value in change.items() if name.endswith("_loss"))
    bed = change["friction_bed_loss"] + change["impact_bed_loss"]
    assert change["friction_bed_loss"] > 0.0
    assert change["impact_bed_loss"] > 0.0
    assert abs(change["thrust_work"] - stores - lost) < 1e-5 * bed


def test_what_never_reaches_the_bed_has_the_same_bits_without_it():
    deep, none = (lively(depth, 400)[0] for depth in (1e4, np.inf))
    assert deep.table().position.tobytes() == none.table().position.tobytes()
    assert "sea_bed" not in none.budget
    assert not deep.budget["sea_bed"].any()


def test_a_contact_with_the_bed_crushes_at_the_strength_of_the_ice():
    """Pressed with more than strength times its area the block gives way; what it stands on is that."""
    strength = 1e4
    layer = RubbleLayer(RubblePhysics(**ICE, depth=DEPTH, contact_strength=strength), WIDTH)
    number = add(layer, 0.0, -DEPTH, 4.0)
    thrust(layer, number, (0.0, 0.0, -3.0 * strength * 4.0 * WIDTH))
    layer.advance(20)
    assert layer.budget["sea_bed"][1] == pytest.approx(strength * 4.0 * WIDTH, rel=1e-2)
    assert layer.block(number).velocity[2] < -0.01
