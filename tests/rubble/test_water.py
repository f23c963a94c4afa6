"""Water forces on single blocks: equilibrium, terminal velocity, moments, energy."""

import numpy as np
import pytest

from rubble.energy import mechanical_energy
from rubble.geometry import area_moments, clip, contiguous, place, submerged
from rubble.layer import RubbleLayer
from rubble.physics import RubblePhysics
from rubble.piece import Slab, turned
from rubble.plates import empty, orient_all
from rubble.pressure import FAR
from rubble.prism import inertia, strips, wetted_edges
from rubble.water import Hulls, Water, plate_forces

PHYSICS = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=3.0)  # thesis values
RHO_G = PHYSICS.rho_w * PHYSICS.g


def box(x, z, length, height):
    return np.array(
        [
            (x - length / 2, z - height / 2),
            (x + length / 2, z - height / 2),
            (x + length / 2, z + height / 2),
            (x - length / 2, z + height / 2),
        ]
    )


def add_box(
    layer, x=0.0, z=0.0, length=10.0, height=3.0, width=2.8, density=846.0, velocity=(0.0, 0.0), omega=0.0, section=0
):
    return layer.add_block(
        section,
        Slab(box(x, z, length, height), np.array([x - length / 2, x + length / 2]), np.array([width]), density),
        velocity,
        omega,
    )


def force_on(edges, state, form=0.0, skin=0.0):
    """Force x, z, moment from x towards z and power of drag on a plate of one piece at x, z, angle and their rates."""
    water = Water(RHO_G, PHYSICS.rho_w / 2, form, skin, 0.0, 0.0, 0.0, 0.0, FAR * PHYSICS.thickness)
    x, z, angle, v_x, v_z, omega = state
    plates = empty(1)
    plates.position[0], plates.quaternion[0] = (x, 0.0, z), turned(angle)
    plates.velocity[0] = v_x, 0.0, v_z, 0.0, -omega, 0.0
    orient_all(plates)
    offset = np.array([0, len(edges)])
    hulls = Hulls(np.zeros(1, np.int64), np.zeros(1), np.ones(1), edges, offset, np.zeros((1, 3)), np.zeros((1, 3)))
    forces, lowest = np.zeros((1, 3, 6)), np.zeros(1)
    plate_forces(plates, hulls, water, forces, lowest)
    total, drag = forces[0].sum(axis=0), forces[0, 2]
    return total[0], total[2], -total[4], float(drag @ plates.velocity[0])


def edges_of(polygon, width=2.0):
    ends = np.array([polygon[:, 0].min(), polygon[:, 0].max()])
    return wetted_edges([polygon], ends, np.array([width]))


@pytest.mark.parametrize("pose", [(0.0, 0.0, 0.0), (3.0, 0.4, 0.7), (-2.0, -0.9, 2.5), (0.0, -9.0, 1.0), (0.0, 9.0, 1)])
def test_pressure_integral_equals_the_clipped_polygon(pose):
    polygon = contiguous([(-2, -1), (1.5, -1.2), (2.2, 0.3), (0.2, 1.4), (-1.8, 0.9)])
    x, z, angle = pose
    fx, fz, moment, _ = force_on(edges_of(polygon), [x, z, angle, 0, 0, 0])
    area, cx, _, _ = area_moments(submerged(place(polygon, x, z, angle, 0.0, 0.0)))
    assert fx == pytest.approx(0.0, abs=1e-9 * RHO_G)
    assert fz == pytest.approx(RHO_G * area * 2.0, rel=1e-12, abs=1e-9)
    assert moment == pytest.approx(RHO_G * area * 2.0 * (cx - x), rel=1e-10, abs=1e-6)


def test_strips_of_a_stepped_wedge_keep_volume_and_buoyancy():
    polygon = contiguous(box(0.0, 0.0, 6.0, 2.0))
    cuts, widths = np.array([-3.0, -1.0, 1.0, 3.0]), np.array([1.0, 2.5, 4.0])
    parts = strips(polygon, cuts, widths)
    volume, cx, cz, _ = inertia(parts, widths)
    assert volume == pytest.approx(2.0 * 2.0 * 7.5)
    assert (cx, cz) == pytest.approx((2.0 * (4.0 - 1.0) / 7.5, 0.0))
    _, fz, moment, _ = force_on(wetted_edges(parts, cuts, widths), [0.0, -0.2, 0.5, 0, 0, 0])
    wet = [area_moments(submerged(place(p, 0.0, -0.2, 0.5, 0.0, 0.0))) for p in parts]
    assert fz == pytest.approx(RHO_G * sum(m.area * w for m, w in zip(wet, widths, strict=True)), rel=1e-12)
    assert moment == pytest.approx(RHO_G * sum(m.area * m.x * w for m, w in zip(wet, widths, strict=True)), rel=1e-10)


def test_a_stepped_wedge_has_its_front_area_in_drag():
    polygon = contiguous(box(0.0, -5.0, 6.0, 2.0))
    cuts, widths = np.array([-3.0, 0.0, 3.0]), np.array([1.0, 4.0])
    edges = wetted_edges(strips(polygon, cuts, widths), cuts, widths)
    for v in (1.0, -1.0):
        assert force_on(edges, [0, 0, 0, v, 0, 0], form=1.0)[0] == pytest.approx(-v * 1006 / 2 * 2.0 * 4.0, rel=1e-12)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.2])
def test_form_drag_acts_on_the_projected_extent(angle):
    polygon, u = contiguous(box(0.0, 0.0, 4.0, 1.0)), np.array([0.6, -0.3])
    fx, fz, _, power = force_on(edges_of(polygon), [0, -20, angle, *u, 0], form=1.2)
    fx0, fz0, _, _ = force_on(edges_of(polygon), [0, -20, angle, 0, 0, 0])
    speed = np.hypot(*u)
    across = place(polygon, 0.0, 0.0, angle, 0.0, 0.0) @ np.array([-u[1], u[0]]) / speed
    drag = 1006 / 2 * 1.2 * speed * np.ptp(across) * 2.0
    assert (fx - fx0, fz - fz0) == pytest.approx(tuple(-drag * u), rel=1e-6)
    assert power == pytest.approx(-drag * speed**2, rel=1e-9)


def test_rotational_drag_of_a_thin_plate():
    length, om = 8.0, 0.5
    moment = force_on(edges_of(contiguous(box(0, 0, length, 1e-6))), [0, -50, 0, 0, 0, om], form=1.0)[2]
    assert moment == pytest.approx(-2 * 1006 / 2 * 2.0 * om**2 * (length / 2) ** 4 / 4, rel=0.04)


def test_draft_at_rest_is_thickness_times_density_ratio():
    layer = RubbleLayer(RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=3.0, form_drag=30.0), 2.8)
    add_box(layer, z=-1.2)
    layer.advance(40_000)
    table = layer.table()
    assert 1.5 - table.position[0, 2] == pytest.approx(3.0 * 846 / 1006, rel=1e-3)
    assert abs(table.angle[0]) < 1e-9


def test_a_flat_block_floats_flat_and_a_tall_one_turns_over():
    layer = RubbleLayer(RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=3.0, form_drag=5.0), 2.8)
    add_box(layer, x=0.0, length=10.0, height=3.0, omega=0.02)
    add_box(layer, x=40.0, length=3.0, height=10.0, omega=0.02)
    layer.advance(20_000)
    flat, tall = layer.table().angle
    assert abs(flat) < 0.05
    assert np.cos(tall) ** 2 < 0.05  # lies on its side


@pytest.mark.parametrize(("density", "start"), [(846.0, -300.0), (1166.0, -5.0)])
def test_terminal_velocity(density, start):
    """rise or fall of a box, broadside: (rho_w - rho) g h L w = rho_w / 2 C_d L w v^2 + 2 rho_w / 2 C_f h w v^2."""
    layer = RubbleLayer(PHYSICS, 2.8)
    add_box(layer, z=start, density=density)
    layer.advance(4000)
    v = layer.table().velocity[0, 2]
    skin = 1 + 2 * PHYSICS.skin_drag * 3.0 / 10.0
    expected = np.sqrt(abs(1006 - density) * 9.81 * 3.0 * 2 / (1006 * skin))
    assert v == pytest.approx(np.copysign(expected, 1006 - density), rel=0.01)


def test_added_mass_slows_the_start_and_leaves_the_momentum_true():
    physics = RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=3.0, form_drag=0.0, skin_drag=0.0, added_mass=0.7)
    layer = RubbleLayer(physics, 2.8)
    add_box(layer, z=-50.0)
    layer.advance(100)
    a = (1006 - 846) * 9.81 / (846 + 0.7 * 1006)
    assert layer.table().velocity[0, 2] == pytest.approx(a * 0.5, rel=1e-12)
    assert layer.momentum[2] == pytest.approx(846 * 10 * 3 * 2.8 * a * 0.5, rel=1e-12)


def energies(sign=1.0, seconds=60.0):
    """Energy of a free, dragless, rocking block at start and end; ``sign`` -1 spoils the water's share."""
    layer = RubbleLayer(RubblePhysics(rho_i=846.0, rho_w=1006.0, thickness=3.0, form_drag=0.0, skin_drag=0.0), 2.8)
    add_box(layer, z=-0.7, omega=0.1, velocity=(0.2, 0.3))
    before = mechanical_energy(layer)
    layer.advance(round(seconds / 0.005))
    after = mechanical_energy(layer)
    weight = layer.mass * 9.81 * layer.table().position[0, 2]
    return before["kinetic"] + before["potential"], after["kinetic"] + weight + sign * (after["potential"] - weight)


def test_a_free_block_keeps_its_energy():
    start, end = energies()
    scale = 0.5 * 846 * 84 * (0.13 + 0.1**2 * 9)
    assert abs(end - start) < 0.02 * scale
    assert abs(energies(sign=-1.0)[1] - start) > 100 * scale


def test_what_drag_takes_is_what_is_missing():
    layer = RubbleLayer(PHYSICS, 2.8)
    add_box(layer, z=-20.0, velocity=(1.0, 0.0), omega=0.3)
    before = mechanical_energy(layer)
    layer.advance(2000)
    after = mechanical_energy(layer)
    lost = before["kinetic"] + before["potential"] - after["kinetic"] - after["potential"]
    assert after["drag"] == pytest.approx(lost, rel=0.01)
    assert lost > 1e6


def test_mass_of_a_block_and_its_strips():
    layer = RubbleLayer(PHYSICS, 2.8)
    slab = Slab(box(5.0, -1.0, 6.0, 2.0), np.array([2.0, 5.0, 8.0]), np.array([1.0, 3.0]), 900.0, 0.0)
    block = layer.block(layer.add_block(0, slab))
    assert block.mass == pytest.approx(900 * 2 * 3 * (1 + 3), rel=1e-14)
    assert block.position[0] == pytest.approx((3.5 * 1 + 6.5 * 3) / 4)
    assert area_moments(clip(block.pieces[0].prism.polygon, 1.0, 0.0, 1e9)).area == pytest.approx(12.0)


def test_a_tilted_block_takes_its_strips_along_its_own_axis():
    tilted = place(contiguous(box(0.0, 0.0, 6.0, 2.0)), 4.0, -3.0, 0.4, 0.0, 0.0)
    middle = 4.0 * np.cos(0.4) - 3.0 * np.sin(0.4)
    layer = RubbleLayer(PHYSICS, 2.8)
    block = layer.block(layer.add_block(0, Slab(tilted, middle + np.array([-3.0, 3.0]), np.array([2.0]), 900.0, 0.4)))
    assert tuple(block.position) == pytest.approx((4.0, 0.0, -3.0))
    prism = block.pieces[0].prism
    assert np.ptp(prism.polygon[:, 0]) == pytest.approx(6.0)
    assert abs(np.sin(prism.long_axis)) < 1e-12


def test_water_lifts_a_plate_that_is_turned_about_all_axes():
    """By what it displaces, straight up, through the middle of that: fully submerged, rho_w g V at its centre."""
    plates = empty(1)
    plates.position[0], plates.quaternion[0] = (
        (3.0, 1.0, -20.0),
        np.array([0.7, 0.4, -0.5, 0.33]) / np.linalg.norm([0.7, 0.4, -0.5, 0.33]),
    )
    orient_all(plates)
    edges = edges_of(contiguous(box(0.0, 0.0, 4.0, 1.0)), 2.5)
    hulls = Hulls(
        np.zeros(1, np.int64),
        np.zeros(1),
        np.ones(1),
        edges,
        np.array([0, len(edges)]),
        np.zeros((1, 3)),
        np.zeros((1, 3)),
    )
    forces, lowest = np.zeros((1, 3, 6)), np.zeros(1)
    plate_forces(
        plates, hulls, Water(RHO_G, 500.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, FAR * PHYSICS.thickness), forces, lowest
    )
    lift = RHO_G * 10.0
    assert forces[0, 0] == pytest.approx([0.0, 0.0, lift, 0.0, 0.0, 0.0], abs=1e-9 * lift)


@pytest.mark.parametrize(
    ("polygon", "cuts", "widths", "words"),
    [
        ([(0, 0), (1, 0)], [0, 1], [1], "finite points"),
        ([(0, 0), (2, 0), (1, 0.2), (0, 2)], [0, 2], [1], "not convex"),
        ([(0, 0), (2, 0), (2, 1), (0, 1)], [0, 2], [0.0], "widths > 0"),
        ([(0, 0), (2, 0), (2, 1), (0, 1)], [5, 6], [1.0], "miss the block"),
    ],
)
def test_a_bad_block_is_refused(polygon, cuts, widths, words):
    layer = RubbleLayer(PHYSICS, 1.0)
    with pytest.raises(ValueError, match=words):
        layer.add_block(0, Slab(np.array(polygon), np.array(cuts), np.array(widths), 900.0))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"rho_w": 0.0}, "rho_w"),
        ({"mu_ice_ice": "slow"}, "rate-dependent"),
        ({"backfill": "some"}, "full or none or filling"),
        ({"backfill_level": 1.0}, "z <= 0"),
        ({"substep": float("nan")}, "substep"),
    ],
)
def test_bad_physics_is_refused(change, words):
    with pytest.raises(ValueError, match=words):
        RubblePhysics(**change)
