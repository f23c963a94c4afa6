"""A structure that moves: the same contacts as if ice moved, friction against its motion, load and work as one says."""

from dataclasses import replace

import numpy as np
import pytest

from rubble.cut import plane
from rubble.energy import energy_terms
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.sheet import SheetMotion

SPEED = 0.5
FACE = np.array([(30.0, -30.0), (-5.0, 5.0)])  #: x = -z: breaks downward


def still(**ways):
    """Six values, by their place."""
    out = np.zeros(6)
    for name, value in ways.items():
        out[["surge", "sway", "heave", "roll", "pitch", "yaw"].index(name)] = value
    return out


def course(scene, ice, structure, windows=3):
    """Loads and places of blocks that drift with ``ice`` against a cone that goes with ``structure``; and the layer."""
    layer = RubbleLayer(replace(scene.PHYSICS, current=(ice, 0.0)), scene.WIDTH, solids=scene.cone_cut)
    for key in (-1, 0, 1):
        for i in range(6):
            scene.add(layer, key, -16.9 - 5.5 * (i % 3), -3.2 - 3.2 * (i // 3), velocity=(ice, 0.0))
    loads, places, t = [], [], 0.0
    for _ in range(windows):
        x = np.arange(-16.0, -50.0, -2.8) + ice * t
        for key in list(layer.sections):
            layer.set_sheet(key, SheetMotion(x, 0 * x, x[0] + 1.4, np.tile((ice, 0.0), (len(x), 1)), scene.H))
        layer.set_structure(still(surge=structure * t), still(surge=structure))
        layer.advance(20)
        t += 20 * layer.physics.substep
        loads.append(layer.load_on_structure.copy())
        places.append(layer.table().position - np.array([ice * t, 0.0, 0.0]))
    return np.array(loads), np.array(places), layer


def test_a_cone_that_moves_meets_what_one_meets_that_rests(scene):
    """Galilei: the bits differ by rounding of places, and that by 1e-13 of the load before it has grown."""
    drifts, at, _ = course(scene, SPEED, 0.0)
    moved, there, _ = course(scene, 0.0, -SPEED)
    size = np.abs(drifts).max()
    assert size > 1e5
    assert np.abs(moved - drifts).max() < 1e-9 * size
    assert np.abs(there - at).max() < 1e-9
    wrong, _, _ = course(scene, 0.0, -0.98 * SPEED)  # twin
    assert np.abs(wrong - drifts).max() > 1e-3 * size


def test_its_load_and_its_work_are_those_of_the_contacts(scene):
    _, _, layer = course(scene, 0.0, -SPEED)
    load, wrench = layer.load_on_structure.sum(axis=0), layer.wrench_on_structure
    assert wrench[:3] == pytest.approx(load, rel=1e-12, abs=1e-9 * np.abs(load).max())
    before = energy_terms(layer)["rubble_structure_work"]
    layer.advance(20)
    work, time = energy_terms(layer)["rubble_structure_work"] - before, layer.runner.window
    assert work == pytest.approx(float(layer.wrench_on_structure[0]) * SPEED * time, rel=1e-9)
    assert work > 1e3


def test_energy_closes_with_what_the_structure_puts_in(scene):
    """Blocks at rest, driven by the cone alone: stores and losses are its work and what the sheet has taken."""
    layer = RubbleLayer(scene.PHYSICS, scene.WIDTH, solids=scene.cone_cut)
    for key in (-1, 0, 1):
        scene.add(layer, key, -16.9, -3.2, velocity=(0.0, 0.0))
    at_first = energy_terms(layer)
    for w in range(5):
        layer.set_structure(still(surge=-0.1 * SPEED * w, pitch=-0.002 * w), still(surge=-SPEED, pitch=-0.02))
        layer.advance(20)
    now = {name: value - at_first[name] for name, value in energy_terms(layer).items()}
    put_in = now["rubble_structure_work"]
    spent = now["rubble_kinetic"] + now["rubble_potential"] + sum(v for n, v in now.items() if n.endswith("_loss"))
    assert put_in > 1e4
    assert abs(put_in - now["sheet_work"] - spent) < 1e-9 * put_in


def carried(scene, speed):
    """Velocity along x of a block that floats up into a lid, which moves with this speed for half a second."""
    lid = np.array([(-40.0, -10.0), (40.0, -10.0), (40.0, -8.0), (-40.0, -8.0)])
    physics = replace(scene.PHYSICS, form_drag=0.0, skin_drag=0.0)
    layer = RubbleLayer(physics, scene.WIDTH, solids=lambda _: plane([lid]))
    scene.add(layer, 0, -2.5, -10.0, velocity=(0.0, 0.0))
    layer.advance(100)
    layer.set_structure(still(), still(surge=speed))
    layer.advance(100)
    return layer, float(layer.table().velocity[0, 0])


def test_friction_is_against_the_motion_over_the_structure(scene):
    """A lid that slides over a block takes it along with mu N, to its own speed and no further."""
    _, slow = carried(scene, 0.05)
    assert slow == pytest.approx(0.05, rel=1e-3)
    layer, fast = carried(scene, 5.0)
    volume = scene.WIDTH * scene.H * 5.0
    lift = (layer.physics.rho_w - layer.physics.rho_i) * layer.physics.g * volume
    moved = layer.store.plates.moved[0]
    assert fast == pytest.approx(layer.physics.mu_structure * lift / moved * 0.5, rel=0.02)


def pressed(scene, face, pitch=0.0, velocity=0.0):
    """Load of a block on a face that is turned by ``pitch`` about the origin."""
    layer = RubbleLayer(scene.PHYSICS, scene.WIDTH, solids=lambda _: plane(convex_parts(face, back=60.0)))
    scene.add(layer, 0, 0.68, -7.0, velocity=(0.5, 0.0))
    layer.set_structure(still(pitch=pitch), still(pitch=velocity))
    layer.advance(60)
    return layer.load_on_structure[0], layer


def test_a_face_that_is_pitched_is_another_face(scene):
    """Pitch moves what is above water along +x: points (x, z) go to (x cos + z sin, z cos - x sin)."""
    angle = 0.1
    c, s = np.cos(angle), np.sin(angle)
    turned = np.column_stack((c * FACE[:, 0] + s * FACE[:, 1], c * FACE[:, 1] - s * FACE[:, 0]))
    built, _ = pressed(scene, turned)
    load, _ = pressed(scene, FACE, pitch=angle)
    other, _ = pressed(scene, FACE, pitch=-angle)
    size = np.abs(built).max()
    assert size > 1e4
    assert np.abs(load - built).max() < 1e-6 * size
    assert np.abs(other - built).max() > 1e-2 * size  # twin


def test_aside_by_a_section_is_the_same_cut(scene):
    """The cone gone to the left by the pitch, and the ice with it."""

    def loads(sections, sway):
        layer = RubbleLayer(scene.PHYSICS, scene.WIDTH, solids=scene.cone_cut)
        layer.set_structure(still(sway=sway), still())
        for key in (-1, 0, 1):
            scene.add(layer, key + sections, -16.85, -3.2)
        layer.advance(20)
        return layer.load_on_structure, layer

    here, _ = loads(0, 0.0)
    there, layer = loads(1, scene.WIDTH)
    assert np.abs(here).max() > 1e4
    assert np.abs(there - here).max() < 1e-9 * np.abs(here).max()
    assert layer.section(1).aside == scene.WIDTH
    near, _ = loads(0, 0.09 * scene.WIDTH)  # not cut anew: seen by how deep and how steep contacts are
    assert np.sign(near[:, 1].sum()) == 1.0  # more of the ice is to its right, on y < 0, and presses it to the left
