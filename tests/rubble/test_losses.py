"""Where the energy of blocks goes: closed forms, contact by contact, and a balance that closes to second order."""

import numpy as np
import pytest

from rubble.cut import plane
from rubble.energy import energy_terms, mechanical_energy
from rubble.geometry import place
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import thrust
from rubble.sheet import SheetMotion

WIDTH = 2.0
ICE = dict(rho_i=846.0, rho_w=1006.0, thickness=3.0)
AIR = dict(rho_i=846.0, rho_w=1e-9, thickness=1.0, form_drag=0.0, skin_drag=0.0)


def add(layer, x, z, length, height, velocity=(0.0, 0.0), angle=0.0, flooded=True, alone=True):
    box = np.array([(-length, -height), (length, -height), (length, height), (-length, height)]) / 2
    middle = x * np.cos(angle) + z * np.sin(angle)
    return layer.add_block(
        0,
        Slab(
            place(box, x, z, angle, 0.0, 0.0), middle + np.array([-length, length]) / 2, np.array([WIDTH]), 846.0, angle
        ),
        velocity,
        flooded=flooded,
        alone=alone,
    )


def lost(before, after, *names):
    """Change of the sum of some terms [J]."""
    return sum(after[n] - before[n] for n in names)


def residual(before, after, wrong=None):
    """What no term explains [J]; ``wrong``: a term that is taken with the other sign."""
    change = {n: (after[n] - before[n]) * (-1.0 if n == wrong else 1.0) for n in after}
    spent = sum(v for n, v in change.items() if n.endswith("_loss"))
    return change["thrust_work"] - change["sheet_work"] - change["rubble_kinetic"] - change["rubble_potential"] - spent


def test_a_block_that_rises_at_its_terminal_speed_loses_its_net_buoyancy_times_the_way():
    layer = RubbleLayer(RubblePhysics(**ICE, added_mass=0.3), WIDTH)
    add(layer, 0.0, -200.0, 10.0, 3.0)
    layer.advance(4000)
    start, z = energy_terms(layer), layer.table().position[0, 2]
    layer.advance(2000)
    net = (1006 - 846) * 9.81 * 10.0 * 3.0 * WIDTH
    way = layer.table().position[0, 2] - z
    assert way > 10.0
    assert lost(start, energy_terms(layer), "drag_loss") == pytest.approx(net * way, rel=1e-6)
    assert lost(start, energy_terms(layer), "rubble_potential") == pytest.approx(-net * way, rel=1e-9)


def test_a_block_that_slides_down_a_slope_loses_mu_times_the_normal_force_times_the_way():
    slope, mu = np.radians(30.0), 0.2
    layer = RubbleLayer(
        RubblePhysics(**AIR, mu_structure=mu, substep=0.001),
        WIDTH,
        solids=lambda y: plane(convex_parts(np.array([(0.0, 0.0), (100.0, 100.0 * np.tan(slope))]), back=300.0)),
    )
    x, c, s = 60.0, np.cos(slope), np.sin(slope)
    add(layer, x - 0.498 * s, x * np.tan(slope) + 0.498 * c, 4.0, 1.0, (-c, -s), slope)
    layer.advance(500)
    start, table = energy_terms(layer), layer.table()
    layer.advance(1500)
    way = np.hypot(*(layer.table().position - table.position)[0, [0, 2]])
    normal = table.mass[0] * 9.81 * c
    assert lost(start, energy_terms(layer), "friction_structure_loss") == pytest.approx(mu * normal * way, rel=2e-3)
    kick = lost(start, energy_terms(layer), "impact_structure_loss")
    assert abs(kick + lost(start, energy_terms(layer), "stepping_loss")) < 0.01 * mu * normal * way
    assert abs(residual(start, energy_terms(layer))) < 1e-5 * normal * way


@pytest.mark.parametrize("e", [0.0, 0.3, 0.9])
def test_two_blocks_that_collide_lose_the_share_1_minus_e2_of_their_energy_about_the_centre(e):
    layer = RubbleLayer(RubblePhysics(**AIR, g=0.0, restitution=e, mu_ice_ice=0.0), WIDTH)
    add(layer, 0.0, 0.0, 2.0, 2.0, (2.0, 0.0))
    add(layer, 3.0, 0.0, 3.0, 2.0, (-1.0, 0.0))
    start, m = energy_terms(layer), layer.table().mass
    layer.advance(200)
    about = 0.5 * m[0] * m[1] / m.sum() * 3.0**2
    assert lost(start, energy_terms(layer), "impact_ice_loss") == pytest.approx(
        (1.0 - e**2) * about, rel=1e-6, abs=1e-6
    )
    assert abs(lost(start, energy_terms(layer), "friction_ice_loss")) < 1e-9 * about
    assert abs(residual(start, energy_terms(layer))) < 1e-10 * about


def test_a_floating_block_that_is_pushed_passes_its_thrust_on_to_the_water():
    layer = RubbleLayer(RubblePhysics(**ICE), WIDTH)
    number = add(layer, 0.0, 1.5 - 3.0 * 846 / 1006, 10.0, 3.0)
    thrust(layer, number, (2e4, 0.0, 0.0))
    layer.advance(6000)
    start, x = energy_terms(layer), layer.table().position[0, 0]
    layer.advance(2000)
    work = 2e4 * (layer.table().position[0, 0] - x)
    assert lost(start, energy_terms(layer), "thrust_work") == pytest.approx(work, rel=1e-12)
    assert lost(start, energy_terms(layer), "drag_loss") == pytest.approx(work, rel=1e-3)


def test_ice_afloat_has_no_energy():
    physics = RubblePhysics(**ICE)
    layer = RubbleLayer(physics, WIDTH)
    add(layer, 0.0, 1.5 - 3.0 * 846 / 1006, 10.0, 3.0)
    kinetic, potential = layer.runner.parts_of(layer.blocks[0])
    assert kinetic == 0.0
    assert abs(potential) < 1e-9 * layer.mass * 9.81
    old = mechanical_energy(layer)
    assert energy_terms(layer)["rubble_potential"] == pytest.approx(
        old["potential"] - layer.mass * physics.afloat, abs=1e-4
    )


def test_overlap_that_is_corrected_moves_blocks_without_speed_and_is_booked():
    """A block that floats against one above it and then stands 0.1 m deep in it: they are pushed apart."""
    layer = RubbleLayer(RubblePhysics(**ICE), WIDTH)
    add(layer, 0.0, -1.0, 6.0, 3.0)
    add(layer, 0.0, -4.2, 6.0, 3.0)
    layer.advance(6000)
    runner, place = layer.runner, (layer.store, layer.table_of_sections)
    runner.begin(*place, layer.joints)
    runner.go(1)
    layer.store.plates.position[1, 2] += 0.1
    start = energy_terms(layer)
    runner.go(3999)
    runner.end(*place)
    end = energy_terms(layer)
    assert abs(lost(start, end, "correction_loss")) > 1e3
    assert abs(residual(start, end)) < 1e-3 * abs(lost(start, end, "correction_loss"))
    assert abs(residual(start, end, "correction_loss")) > abs(lost(start, end, "correction_loss"))


def lively(substep, wrong=None, seconds=10.0):
    """Residual of a pile between a slope and a moving sheet with everything at work, and its largest loss."""
    physics = RubblePhysics(
        **ICE, added_mass=0.2, added_inertia=0.2, restitution=0.1, substep=substep, backfill="filling"
    )
    layer = RubbleLayer(
        physics, 3.0, solids=lambda y: plane(convex_parts(np.array([(30.0, -30.0), (-5.0, 5.0)]), back=60.0))
    )
    for i in range(9):
        add(layer, -4.0 - 5.0 * (i % 3), -4.0 - 4.0 * (i // 3), 4.0, 2.5, (1.0, 0.2 * (-1) ** i), flooded=None)
    start, x, rows = energy_terms(layer), np.array([-6.0, -9.0, -12.0, -15.0, -18.0]), round(0.05 / substep)
    layer.set_sheet(0, SheetMotion(x, np.zeros(5), -5.0, np.tile((0.1, 0.0), (5, 1)), 3.0))
    layer.set_yields([0], np.array([1e-7, 1e-6]).reshape(2, 1, 1))
    for _ in range(round(seconds / 0.05)):  # the sheet goes on as it was: where it is set anew there are corrections
        layer.advance(rows)
    end = energy_terms(layer)
    return residual(start, end, wrong), max(abs(end[n] - start[n]) for n in end if n.endswith("_loss")), start, end


def test_the_residual_falls_with_the_square_of_the_sub_step():
    runs = [lively(dt) for dt in (0.005, 0.0025, 0.00125)]
    assert abs(runs[0][0]) < 1e-6 * runs[0][1]
    order = np.log2(abs(runs[0][0] / runs[2][0])) / 2
    assert 1.5 < order < 2.5


def test_a_term_with_the_wrong_sign_is_found():
    _, scale, start, end = lively(0.005)
    right = abs(residual(start, end))
    terms = [n for n in end if abs(end[n] - start[n]) > 1e-4 * scale]
    assert len(terms) >= 10
    for name in terms:
        assert abs(residual(start, end, name)) > 100 * right, name
