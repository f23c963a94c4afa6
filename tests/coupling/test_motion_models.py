"""Motions of a structure by themselves: exact under a constant load, second order under one that varies, in balance."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from coupling.structure.motion import LinearMotion, Prescribed, modal, spring

MASS, STIFFNESS, RATIO = 1.2e6, 5.0e6, 0.05
OMEGA = np.sqrt(STIFFNESS / MASS)
SURGE = np.array([2e5, 0.0, 0.0, 0.0, 0.0, 0.0])


def oscillator(stiffness=STIFFNESS, ratio=RATIO):
    return spring([0], np.diag([MASS]), np.diag([2.0 * ratio * np.sqrt(stiffness * MASS)]), np.diag([stiffness]))


def test_oscillator_under_a_step_load():
    """x = F/k (1 - exp(-zeta w t) (cos w_d t + zeta w / w_d sin w_d t)): Chopra, Dynamics of Structures, 4.3.2."""
    s, t = oscillator(), np.arange(1, 201) * 0.05
    way = []
    for begin in t - 0.05:
        s.advance(begin, 0.05, SURGE)
        way.append(s.displacement[0])
    d = OMEGA * np.sqrt(1.0 - RATIO**2)
    decay = np.exp(-RATIO * OMEGA * t)
    exact = SURGE[0] / STIFFNESS * (1.0 - decay * (np.cos(d * t) + RATIO * OMEGA / d * np.sin(d * t)))
    assert np.abs(np.array(way) - exact).max() < 1e-10 * exact.max()


def test_free_mass_under_a_constant_load():
    """x = F t^2 / 2 m and v = F t / m, to rounding at every window."""
    s = oscillator(stiffness=0.0)
    for k in range(100):
        s.advance(0.1 * k, 0.1, SURGE)
    assert s.displacement[0] == pytest.approx(0.5 * SURGE[0] / MASS * 100.0, rel=1e-12)
    assert s.velocity[0] == pytest.approx(SURGE[0] / MASS * 10.0, rel=1e-12)


def error(windows):
    """Of the end of 4 s under sin(3 t), given as its mean over every window; undamped, from rest."""
    s, edge = oscillator(ratio=0.0), np.linspace(0.0, 4.0, windows + 1)
    for a, b in pairwise(edge):
        s.advance(a, b - a, SURGE * (np.cos(3.0 * a) - np.cos(3.0 * b)) / (3.0 * (b - a)))
    exact = quad(lambda u: SURGE[0] * np.sin(3.0 * u) * np.sin(OMEGA * (4.0 - u)), 0.0, 4.0, epsabs=1e-6)[0]
    return abs(s.displacement[0] - exact / (MASS * OMEGA))


def test_the_mean_of_a_load_is_second_order():
    errors = np.array([error(n) for n in (40, 80, 160)])
    assert (np.abs(np.log2(errors[:-1] / errors[1:]) - 2.0) < 0.1).all()


def coupled():
    """Surge and pitch that know of each other, as of a floater; damped."""
    mass = np.array([[4e6, 3e7], [3e7, 2e9]])
    stiffness, damping = np.array([[3e5, 1e6], [1e6, 4e8]]), np.array([[2e5, 0.0], [0.0, 5e8]])
    return spring([0, 4], mass, damping, stiffness)


@pytest.mark.parametrize("make", [oscillator, coupled, lambda: oscillator(stiffness=1e18)])
def test_what_the_load_puts_in_is_stored_or_damped(make):
    s, random, work, put_in = make(), np.random.default_rng(1), 0.0, 0.0
    for k in range(400):
        load, before = random.normal(size=6) * 1e5, s.displacement.copy()
        s.advance(0.05 * k, 0.05, load)
        work += float(load @ (s.displacement - before))
        put_in += abs(float(load @ (s.displacement - before)))
    assert abs(work - sum(s.energy.values())) < 1e-10 * put_in
    assert s.energy["structure_damping_loss"] > 0.0


def test_modes_are_springs_in_other_words():
    """Two modes of two coupled masses move as these: phi^T M phi = m, phi^T K phi = omega^2 m."""
    own = coupled()
    mass, stiffness = own._M, own._K
    values, vectors = np.linalg.eig(np.linalg.solve(mass, stiffness))
    shape = np.zeros((2, 6))
    shape[:, [0, 4]] = vectors.T
    frequency = np.sqrt(values.real) / (2.0 * np.pi)
    modes = modal(frequency, np.zeros(2), np.diag(vectors.T @ mass @ vectors), shape)
    direct = spring([0, 4], mass, np.zeros((2, 2)), stiffness)
    for k in range(200):
        load = np.array([3e5, 0.0, 0.0, 0.0, -2e6 * np.cos(0.1 * k), 0.0])
        for s in (modes, direct):
            s.advance(0.1 * k, 0.1, load)
    assert modes.displacement == pytest.approx(direct.displacement, rel=1e-8)
    assert modes.coordinates.shape == (2,)


def test_a_saved_motion_goes_on_with_the_same_bits():
    s = coupled()
    s.advance(0.0, 0.05, SURGE)
    back = s.save()
    ends = []
    for _ in range(2):
        s.advance(0.05, 0.05, 3.0 * SURGE)
        ends.append((s.displacement.copy(), s.velocity.copy(), s.energy))
        back()
    assert (ends[0][0] == ends[1][0]).all()
    assert (ends[0][1] == ends[1][1]).all()
    assert ends[0][2] == ends[1][2]


def test_a_prescribed_motion_follows_its_series_and_its_drive_does_the_work():
    s = Prescribed([0.0, 1.0, 3.0], np.outer([0.0, 0.5, -0.5], [1.0, 0, 0, 0, 0.02, 0]))
    for k in range(30):
        s.advance(0.1 * k, 0.1, np.array([1e3, 0, 0, 0, 5e3, 0]))
    assert s.displacement == pytest.approx([-0.5, 0, 0, 0, -0.01, 0])
    assert s.energy["structure_drive_work"] == pytest.approx(550.0)
    with pytest.raises(ValueError, match=r"ends at 3 s"):
        s.after(2.95, 0.1, np.zeros(6))


@pytest.mark.parametrize(
    ("mass", "stiffness", "says"),
    [
        ([[0.0]], [[1.0]], "mass is not positive"),
        ([[1.0]], [[-1.0]], "stiffness is negative"),
        ([[1.0, 0.5], [0.0, 1.0]], [[1.0, 0.0], [0.0, 1.0]], "not symmetric"),
        ([[1.0]], [[np.nan]], "finite numbers"),
        ([[1.0]], [[1.0, 0.0]], "1 x 1 finite numbers"),
    ],
)
def test_matrices_of_no_structure_are_refused(mass, stiffness, says):
    n = len(mass)
    with pytest.raises(ValueError, match=says):
        LinearMotion(np.array(mass), np.zeros((n, n)), np.array(stiffness), np.eye(6)[:, :n])
