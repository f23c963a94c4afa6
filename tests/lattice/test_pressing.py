"""A contact at the end of a sub-step: what a loose edge may take from it, and what it tends to."""

import numpy as np
import pytest

from lattice.contact import Faces
from lattice.cracks.pressing import force_at_end

MASS, STIFFNESS, STRENGTH = 3.3e3, 1.5e9, 2e6  # a cell of 1.13 m in ice of 3 m
SLOPE = np.array([-1.0, 0.0, -1.0]) / np.sqrt(2.0)
DEPTH = 0.6  #: to which the edge has been crushed [m]


def faces(x, samples=8, stiffness=STIFFNESS):
    """An edge at x (3,) before a slope of 45 deg, crushed all along."""
    shape = (1, samples)
    grows = np.broadcast_to(SLOPE / SLOPE[0], (*shape, 3)).copy()
    overlap = DEPTH + np.broadcast_to(grows @ x, shape)
    way = np.broadcast_to(SLOPE / abs(SLOPE[2]) * 1.13 / samples, (*shape, 3)).copy()
    return Faces(overlap.copy(), np.full(shape, DEPTH), grows, np.full(shape, 3.0), way, stiffness, STRENGTH)


def at_end(x, v, dt, **given):
    """Force on an edge with place x and velocity v (3,) that moves by itself, all of it at the end of dt."""
    now = np.zeros((1, 5))
    force_at_end(faces(x, **given), 0, dt * v, np.eye(3) * dt**2 / MASS, now)
    return now[0, :3]


def at_start(x, v, dt, **given):
    return at_end(x, 0.0 * v, 0.0, **given)


def thrown(law, dt, speed, steps=4000):
    """Energy of an edge that has been thrown at the slope and left it again, over the one that it had [-]."""
    x, v = 1e-3 * SLOPE, -speed * SLOPE
    for _ in range(steps):
        v = v + dt / MASS * law(x, v, dt)
        x = x + dt * v
        if x @ SLOPE > 2e-3:
            return float(v @ v) / speed**2
    return 0.0  # it stays there


@pytest.mark.parametrize("speed", [0.2, 0.5, 1.0, 2.0])
@pytest.mark.parametrize("dt", [1e-4, 1e-3, 5e-3])
def test_a_loose_edge_takes_no_energy_from_the_structure(speed, dt):
    assert thrown(at_end, dt, speed) <= 1.0


@pytest.mark.parametrize("speed", [0.2, 0.5, 1.0, 2.0])
def test_the_force_at_the_start_of_a_long_sub_step_throws_it_back_faster(speed):
    assert thrown(at_start, 5e-3, speed) > 1.3


def test_in_short_sub_steps_it_bounces():
    assert thrown(at_end, 1e-5, 0.5) > 0.9


def test_both_are_the_same_in_short_sub_steps():
    x, v = 0.5e-3 * SLOPE / SLOPE[0], np.zeros(3)
    assert at_end(x, v, 1e-6) == pytest.approx(at_start(x, v, 1e-6), rel=1e-4)
    assert np.abs(at_start(x, v, 1e-6)).max() > 1e5


@pytest.mark.parametrize("dt", [1e-3, 5e-3])
def test_it_is_the_force_that_holds_where_it_brings_the_edge(dt):
    x, v = np.zeros(3), -0.1 * SLOPE
    force = at_end(x, v, dt)
    end = x + dt * v + dt**2 / MASS * force
    assert force == pytest.approx(at_start(end, v, dt), rel=1e-8)
    assert force @ SLOPE > 0.0


def test_an_edge_that_stays_apart_feels_nothing():
    assert not at_end(0.01 * SLOPE, np.zeros(3), 5e-3).any()


def test_it_presses_no_harder_than_the_ice_is_strong():
    force = at_end(np.zeros(3), -20.0 * SLOPE, 5e-3)
    end = 5e-3 * -20.0 * SLOPE + 25e-6 / MASS * force
    assert np.linalg.norm(force) == pytest.approx(
        STRENGTH * (DEPTH + end @ SLOPE / SLOPE[0]) * 1.13 * np.sqrt(2), rel=1e-9
    )
