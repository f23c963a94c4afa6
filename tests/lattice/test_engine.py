"""Implicit dynamics against closed forms: heave of a free floe, momentum, statics, order of convergence."""

from types import SimpleNamespace

import numpy as np
import pytest

from lattice.assembly import assemble
from lattice.contact import NoContact
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.implicit.step import GAMMA, Step
from lattice.loads import NodeLoad
from lattice.sheet import Sheet
from lattice.state import State
from lattice.stiffness import hrennikoff

GRID = Grid(6, 5, 3.0)
ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0)
FREE = np.zeros(GRID.nodes, bool)
NOTHING_U, NOTHING_Q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))


def engine(**options):
    return Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=FREE, **options)


def heave_error(steps, damping):
    """Phase-plane error after one natural period of w'' + 2 gamma w' + omega^2 w = 0, omega^2 = rho_w g / (rho_i h)."""
    m, omega = ICE.rho_i * ICE.h, np.sqrt(ICE.k_f / (ICE.rho_i * ICE.h))
    T, gamma = 2 * np.pi / omega, damping / (2 * m)
    e, s = engine(damping=damping), State.rest(GRID.nodes)
    s.q[:, 0] = 0.1
    for k in range(steps):
        s = e.step(k * T / steps, T / steps, s, NOTHING_U, NOTHING_Q, NoContact()).state
    omega_d = np.sqrt(omega**2 - gamma**2)
    cos, sin, decay = np.cos(omega_d * T), np.sin(omega_d * T), 0.1 * np.exp(-gamma * T)
    w = decay * (cos + gamma / omega_d * sin)
    w_dot = -decay * omega**2 / omega_d * sin
    return np.hypot(s.q[:, 0].mean() - w, (s.q_dot[:, 0].mean() - w_dot) / omega)


@pytest.mark.parametrize("damping", [0.0, 500.0])
def test_heave_converges_at_second_order(damping):
    coarse, fine = heave_error(40, damping), heave_error(80, damping)
    assert 1.8 < np.log2(coarse / fine) < 2.3


def test_a_free_floe_keeps_its_momentum_and_its_rotation():
    e, s = engine(), State.rest(GRID.nodes)
    rng = np.random.default_rng(4)
    s.u_dot[:] = rng.normal(size=s.u_dot.shape) + np.array([0.3, -0.2])
    mass = e.M_u[::2, None]
    before = (mass * s.u_dot).sum(axis=0)
    for k in range(20):
        s = e.step(0.05 * k, 0.05, s, NOTHING_U, NOTHING_Q, NoContact()).state
    np.testing.assert_allclose((mass * s.u_dot).sum(axis=0), before, rtol=1e-9)
    assert not np.allclose((mass * s.u_dot).sum(axis=0), -before)  # the wrong sign is told apart


def test_a_constant_force_brings_the_floe_to_its_static_draft():
    """Weight F on the whole floe settles at w = F / (rho_w g A)."""
    e, s = engine(damping=5e4), State.rest(GRID.nodes)
    F = NOTHING_Q.copy()
    F[:, 0] = -1000.0 * GRID.area
    for k in range(400):
        s = e.step(0.5 * k, 0.5, s, NOTHING_U, F, NoContact()).state
    np.testing.assert_allclose(s.q[:, 0], -1000.0 / ICE.k_f, rtol=1e-6)


def energy_left(alpha, shape):
    """Energy after 20 steps that start with the velocity `shape` of w, relative to the start."""
    e, s = engine(alpha=alpha), State.rest(GRID.nodes)
    s.q_dot[:, 0] = shape
    kinetic = 0.5 * (e.M_q[::3] * shape**2).sum()
    for k in range(20):
        s = e.step(0.002 * k, 0.002, s, NOTHING_U, NOTHING_Q, NoContact()).state
    moving = 0.5 * (e.M_q * s.q_dot.ravel() ** 2).sum()
    stored = 0.5 * s.q.ravel() @ (assemble(GRID, e.rows_q) @ s.q.ravel() + e.k_f * s.q.ravel())
    return (moving + stored) / kinetic


def test_material_damping_takes_energy_from_bending_only():
    """alpha K damps the vibration of the plate (2.27) and leaves heave alone."""
    heave, bend = np.ones(GRID.nodes), np.cos(np.pi * (np.arange(GRID.nodes) // GRID.ny) / 2.5)
    assert energy_left(1e-2, heave) == pytest.approx(energy_left(0.0, heave), rel=1e-9)
    assert energy_left(1e-2, bend) < 0.5 * energy_left(0.0, bend)


def test_mirrored_loads_give_mirrored_motion():
    e, s = engine(), State.rest(GRID.nodes)
    F = NOTHING_Q.copy()
    F[GRID.node(2, 1), 0] = 1e6
    mirror = np.arange(GRID.nodes).reshape(GRID.nx, GRID.ny)[:, ::-1].ravel()
    a = e.step(0.0, 0.05, s, NOTHING_U, F, NoContact()).state.q
    b = e.step(0.0, 0.05, s, NOTHING_U, F[mirror], NoContact()).state.q
    np.testing.assert_allclose(b[mirror, 0], a[:, 0], rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(b[mirror, 2], -a[:, 2], rtol=1e-6, atol=1e-10)


def test_a_pulled_strip_breaks_at_its_tensile_strength():
    """Uniaxial tension: no cell fails at 0.999 sigma_t, some do at 1.001 (4.6)."""
    ice = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=750e3, sigma_f=750e3, sigma_c=4e6)
    failed = []
    for stress in (0.999 * ice.sigma_t, 1.001 * ice.sigma_t):
        held = np.zeros(GRID.nodes, bool)
        sheet = Sheet(Engine(GRID, ice, hrennikoff(ice), held_in_plane=held), 1000.0)
        F = NOTHING_U.copy()
        share = np.full(GRID.ny, GRID.d)
        share[[0, -1]] *= 0.5
        F[GRID.edge_nodes("x+"), 0], F[GRID.edge_nodes("x-"), 0] = stress * ice.h * share, -stress * ice.h * share
        failed.append(
            len(sheet.advance(0.0, [NodeLoad("pull", F, NOTHING_Q.copy())], NoContact(), lambda nodes: None).failed)
        )
    assert failed[0] == 0
    assert failed[1] > 0


def test_the_error_of_a_step_is_that_of_a_cubic_motion():
    """x = c t^3 / 6: accelerations c gamma dt and c dt at the stages, so the local error is 0.040 c dt^3."""
    dt, c = 0.05, np.array([[3.0, -7.0]])
    stages = [SimpleNamespace(u_acc=c * part * dt, q_acc=np.array([[2.0, 99.0 * part, 0.0]])) for part in (GAMMA, 1.0)]
    assert Step.error.fget(SimpleNamespace(dt=dt, stages=stages)) == pytest.approx(0.040 * 7.0 * dt**3, rel=1e-12)
