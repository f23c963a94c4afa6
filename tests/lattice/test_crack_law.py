"""The law of a cracked layer and of a layered cell against closed forms, with wrong twins that they reject."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from lattice.cracks.cells import Plate, room_for
from lattice.cracks.evaluate import evaluate
from lattice.cracks.law import CrackLaw, layer, local_of
from lattice.cracks.layers import POINTS, WEIGHTS
from lattice.cracks.motion import Layered, crack_forces
from lattice.cracks.slopes import level, on_nodes

Z, W = np.array(POINTS), np.array(WEIGHTS)
E, SIGMA_T, SIGMA_C, H, CELL = 8.7e9, 430e3, 4e6, 3.0, 2.8
G_F = 300.0  # J/m2

FLAT = np.zeros((3, 4))  # no strain from slopes


def law(nu=0.0, fracture_energy=G_F, mu=0.3, sigma_c=SIGMA_C):
    e_0 = SIGMA_T / E
    return CrackLaw(E, nu, sigma_c, 700e3, mu, e_0, max(e_0, 2.0 * fracture_energy / SIGMA_T / CELL))


def states():
    return np.zeros(2), np.zeros(2)


def work_along(path, the_law, slip=0.0):
    """Stresses along a path of strains (k, 3) and the work done, by the trapezoidal rule, with what the law booked."""
    damage, crushed = states()
    stress, stored, losses = [np.zeros(3)], [0.0], np.zeros(3)
    for eps in path[1:]:
        a = layer(*eps, damage, crushed, slip, the_law)
        slip = a.slip
        stress.append(np.array([a.s_n, a.s_t, a.tau]))
        stored.append(a.stored)
        losses += (a.cracking, a.crushing, a.rubbing)
    s = np.array(stress)
    work = float((0.5 * (s[1:] + s[:-1]) * np.diff(path, axis=0)).sum())
    return s, work, stored[-1], losses


def straight(*corners, n=4000):
    parts = [np.linspace(a, b, n) for a, b in pairwise(corners)]
    return np.concatenate(parts)


def test_softening_takes_the_fracture_energy():
    """A layer pulled apart and let go has lost G_f per area of its crack, so G_f / d per volume."""
    the_law = law()
    path = straight((0, 0, 0), (1.2 * the_law.e_f, 0, 0), (0, 0, 0))
    _, work, stored, losses = work_along(path, the_law)
    assert work == pytest.approx(G_F / CELL, rel=1e-3)
    assert losses[0] == pytest.approx(G_F / CELL, rel=2e-3)
    assert stored == 0.0


def test_an_open_crack_carries_no_tension_and_a_closed_one_all_compression():
    the_law = law(nu=1 / 3)
    path = straight((0, 0, 0), (1.5 * the_law.e_f, 0, 0), (1e-5, 0, 0), (-2e-4, 0, 0))
    s, *_ = work_along(path, the_law)
    assert s[2 * 4000 - 1, 0] == 0.0
    whole = E / (1 - 1 / 9) * -2e-4
    assert s[-1, 0] == pytest.approx(whole, rel=1e-12)


def test_the_largest_tension_is_the_strength():
    the_law = law(nu=1 / 3)
    eps = np.linspace(0, 3 * the_law.e_f, 20001)
    s, *_ = work_along(np.column_stack((eps, -eps / 3, 0 * eps)), the_law)  # uniaxial while elastic
    assert s[:, 0].max() == pytest.approx(SIGMA_T, rel=1e-3)


def test_compression_stops_at_the_strength_and_stays():
    the_law = law()
    s, work, stored, losses = work_along(straight((0, 0, 0), (-2e-3, 0, 0), (0, 0, 0)), the_law)
    assert s[:, 0].min() == -SIGMA_C
    assert losses[1] == pytest.approx(SIGMA_C * (2e-3 - SIGMA_C / E), rel=1e-3)
    assert s[-1, 0] == 0.0  # the crushed layer does not reach back: it has opened
    assert work - stored - losses.sum() == pytest.approx(0.0, abs=2e-3 * work)


def friction_loop(slips, s_n=-1e6, mu=0.3):
    """Work of a loop of shear strain under thrust in a layer that is cracked through."""
    the_law = law(mu=mu)
    damage, crushed = np.array([1.0, 0.0]), np.zeros(2)
    work, tau, slip, lost = 0.0, 0.0, 0.0, 0.0
    for a, b in pairwise(slips):
        for g in np.linspace(a, b, 2001)[1:]:
            out = layer(s_n / E, 0.0, g, damage, crushed, slip, the_law)
            slip, lost = out.slip, lost + out.rubbing
            work, tau = work + 0.5 * (tau + out.tau) * (b - a) / 2000, out.tau
    return work, lost


def test_a_closed_loop_of_slip_loses_friction_times_way():
    """Slip there and back by g each: what is lost is mu N times the slip, the elastic part coming back."""
    g, s_n = 1e-2, -1e6
    limit = 0.3 * -s_n
    elastic = limit / (0.5 * E)
    work, lost = friction_loop((0.0, g, -g, 0.0))
    slipped = (g - elastic) + (2 * g - 2 * elastic) + (g - 2 * elastic)
    assert lost == pytest.approx(limit * slipped, rel=1e-3)
    stored = 0.5 * limit**2 / (0.5 * E)
    assert work == pytest.approx(lost + stored, rel=1e-3)


def test_friction_without_a_state_makes_energy():
    """The wrong twin: a limited spring without slip gives back on the way home what it took on the way out."""
    limit, G = 0.3e6, 0.5 * E
    there = np.linspace(0, 1e-2, 2001)
    tau = np.clip(G * there, -limit, limit)
    taken = float(np.trapezoid(tau, there))
    given = -float(np.trapezoid(tau[::-1], there[::-1]))
    assert taken - given == pytest.approx(0.0, abs=1e-9 * taken)  # nothing is lost, which friction forbids
    assert friction_loop((0.0, 1e-2, 0.0))[1] > 0.9 * taken


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("nu", [0.0, 1 / 3])
def test_work_is_what_is_stored_and_lost(seed, nu):
    """Along any path of strain; fracture_energy > 0, so that no stress jumps. The error falls with the step."""
    random = np.random.default_rng(seed)
    corners = random.uniform(-1.0, 1.0, (6, 3)) * (1e-3, 1e-3, 1e-3)
    errors = []
    for n in (2000, 8000):
        _, work, stored, losses = work_along(straight((0, 0, 0), *corners, n=n), law(nu=nu))
        errors.append(abs(work - stored - losses.sum()) / (np.abs(losses).sum() + stored))
    assert errors[-1] < 2e-3
    assert (np.array(losses) >= 0.0).all()


def cracked_strip(N, the_law, z, w, kappa=5e-3):
    """Moment per width of a strip that is cracked through, opened by the curvature kappa, under the thrust N [N/m]."""

    def resultants(eps):
        total = moment = 0.0
        for zi, wi in zip(z, w, strict=True):
            a = layer(eps + zi * kappa, 0.0, 0.0, np.array([1.0, 0.0]), np.zeros(2), 0.0, the_law)
            total, moment = total + wi * a.s_n, moment + wi * zi * a.s_n
        return -total, moment

    low, high = -1.0, 1.0  # strain of the middle: thrust falls as it grows
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if resultants(middle)[0] > N else (low, middle)
    return resultants(high)[1]


@pytest.mark.parametrize("thrust", [0.02, 0.05, 0.1, 0.142, 0.2, 0.3, 0.4, 0.6])
def test_a_closed_crack_under_thrust_carries_a_moment(thrust):
    """M = N (h/2 - N / (2 sigma_c)): the thrust goes through the edge; 81 layers within 0.5 %, ours 2."""
    the_law = law()
    N = thrust * SIGMA_C * H
    exact = N * (0.5 * H - N / (2.0 * SIGMA_C))
    fine = (np.arange(81) + 0.5) / 81 - 0.5
    assert cracked_strip(N, the_law, H * fine, np.full(81, H / 81)) == pytest.approx(exact, rel=0.005)
    assert cracked_strip(N, the_law, 0.5 * H * Z, H * W) == pytest.approx(exact, rel=0.02)


def test_without_thrust_it_carries_none():
    the_law = law()
    moment = cracked_strip(1.0, the_law, 0.5 * H * Z, H * W)
    assert abs(moment) < 2.0 * 0.5 * H


def test_a_hinge_at_middle_thickness_is_rejected():
    """The wrong twin: all thrust through the middle has no arm, whatever the thrust."""
    assert cracked_strip(1.7e6, law(), np.array([0.0]), np.array([H])) == pytest.approx(0.0, abs=1.0)
    assert abs(cracked_strip(1.7e6, law(), 0.5 * H * Z, H * W)) > 2e6


# ---- cells --------------------------------------------------------------------------------------------------------

SAME = local_of(law(), *np.ones((3, 4)))


def one_cell(angle=0.4, damage=0.0, nu=1 / 3):
    """A single layered cell on a 2 x 2 grid stored row by row (width 2)."""
    the_law = law(nu=nu)
    shear = 0.5 * 5 / (6 - nu) * E / (2 * (1 + nu)) * H
    plate = Plate(CELL, H, shear, 0.05 * E * H)
    cracks = room_for(1)
    cracks.axis[:, 0] = np.cos(angle), np.sin(angle)
    cracks.damage[0] = damage
    return cracks, plate, the_law


def energy(cracks, plate, the_law, x):
    stored = evaluate(0, np.ascontiguousarray(x), np.zeros((5, 4)), 2, plate, the_law, cracks, FLAT)
    q, H_, R = 0.5 / plate.d, plate.hourglass, plate.hourglass * plate.h**2 / 12
    sign = np.array([1.0, -1.0, -1.0, 1.0])
    mode = x @ sign * q
    return stored + 0.5 * plate.d**2 * (H_ * (mode[0] ** 2 + mode[1] ** 2) + R * (mode[3] ** 2 + mode[4] ** 2))


def nodal(cracks, plate, x):
    on = on_nodes(4)
    crack_forces(
        2, np.ascontiguousarray(x), Layered(1, cracks, plate, law(), level(4), leans=False, local=SAME, nodes=on)
    )
    return on.force[:, [0, 2, 1, 3]].T  # nodes (0,0), (1,0), (0,1), (1,1)


@pytest.mark.parametrize("damage", [0.0, 0.4])
@pytest.mark.parametrize("seed", range(3))
def test_forces_are_the_slope_of_the_energy(seed, damage):
    """Below the strength of the layers, whole or softened, by central differences."""
    random = np.random.default_rng(seed)
    x = 2e-6 * random.standard_normal((5, 4))
    cracks, plate, the_law = one_cell(damage=damage)
    evaluate(0, x, np.zeros((5, 4)), 2, plate, the_law, cracks, FLAT)
    f = nodal(cracks, plate, x).copy()
    order = [0, 2, 1, 3]  # row-by-row places 0 .. 3 are nodes (0,0), (0,1), (1,0), (1,1)
    for component in range(5):
        for place in range(4):
            step = np.zeros((5, 4))
            step[component, place] = 1e-9
            slope = (energy(cracks, plate, the_law, x + step) - energy(cracks, plate, the_law, x - step)) / 2e-9
            assert f[order[place], component] == pytest.approx(-slope, rel=2e-4, abs=2e-5 * np.abs(f).max())


def test_forces_balance_and_rigid_motion_costs_nothing():
    random = np.random.default_rng(3)
    cracks, plate, the_law = one_cell(damage=1.0)
    x = 1e-3 * random.standard_normal((5, 4))
    evaluate(0, x, np.zeros((5, 4)), 2, plate, the_law, cracks, FLAT)
    f = nodal(cracks, plate, x).copy()
    assert np.abs(f[:, :3].sum(axis=0)).max() < 1e-9 * np.abs(f).max()
    xy = np.array([[0, 0], [CELL, 0], [0, CELL], [CELL, CELL]])
    turn = (xy[:, 0] * f[:, 1] - xy[:, 1] * f[:, 0]).sum()
    assert abs(turn) < 1e-9 * np.abs(f).max() * CELL
    whole, plate, the_law = one_cell()
    rigid = np.zeros((5, 4))
    place = np.array([[0, 0], [0, CELL], [CELL, 0], [CELL, CELL]])
    rigid[0], rigid[1] = 1e-3 - 1e-5 * place[:, 1], 2e-3 + 1e-5 * place[:, 0]
    rigid[2] = 3e-3 + 1e-5 * place[:, 0] - 2e-5 * place[:, 1]
    rigid[3], rigid[4] = -1e-5, 2e-5
    evaluate(0, rigid, np.zeros((5, 4)), 2, plate, the_law, whole, FLAT)
    assert np.abs(nodal(whole, plate, rigid)).max() < 1e-6
