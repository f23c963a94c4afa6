"""A contact above or ahead of its nodes: statics in closed form, reciprocity, work and energy."""

from dataclasses import replace

import numpy as np
import pytest

from lattice.contact import Lever, edge_displacement, lever_of, point_displacement
from lattice.energy import EnergyBooks
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.sheet import Sheet
from lattice.state import State
from lattice.stiffness import hrennikoff
from tests.lattice.pushes import Push, no_force

GRID = Grid(9, 7, 3.0)
ICE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=1e15, sigma_f=1e15, sigma_c=5e15)


class Cushion:
    """Elastic cushion that comes towards the front edge and pushes its upper or lower rim back and down."""

    direction = np.array([-0.7, 0.1, -0.7])

    def __init__(self, height, lead=0.0):
        self.nodes = GRID.edge_nodes("x+")
        self.height, self.lead = np.full(GRID.ny, height), np.full(GRID.ny, lead)

    def evaluate(self, t, y):
        depth, k = 0.05 * t + y[:, 0] + y[:, 2], 2e6
        tangent = np.zeros((len(y), 3, 3))
        tangent[:, :, 0] = tangent[:, :, 2] = k * self.direction
        return k * depth[:, None] * self.direction, tangent


def back_held(grid):
    held = np.zeros(grid.nodes, bool)
    held[grid.edge_nodes("x-")] = True
    return held


@pytest.mark.parametrize("z", [0.4, -0.4])
def test_the_end_of_a_floating_beam_turns_under_the_moment_of_a_push(z):
    """Hetenyi (1946), semi-infinite beam with the end moment M: w = 2 M b^2 / k (cos bx - sin bx) exp(-bx),
    b^4 = k / 4EI. A push F back at height z lifts the end by 2 z F b^2 / k (shear of the plate: 0.1 %)."""
    grid, ice, F = Grid(201, 3, 1.0), Ice(E=8.7e9, nu=0.0, h=1.0, rho_i=846.0, rho_w=1006.0), 1e5
    push = Push(grid.edge_nodes("x+"), np.array([[-0.25 * F, 0, 0], [-0.5 * F, 0, 0], [-0.25 * F, 0, 0]]), z)
    e, s = Engine(grid, ice, hrennikoff(ice), held_in_plane=back_held(grid)), State.rest(grid.nodes)
    for k in range(3):  # steps so long that the end of each is at rest
        s = e.step(1e5 * k, 1e5, s, *no_force(grid), push).state
    b, x, M = (ice.k_f / (4.0 * ice.D)) ** 0.25, 200.0 - np.arange(grid.nx) * grid.d, z * F / 2.0
    w = 2.0 * M * b**2 / ice.k_f * (np.cos(b * x) - np.sin(b * x)) * np.exp(-b * x)
    np.testing.assert_allclose(s.q[1::3, 0], w, rtol=0, atol=5e-3 * abs(w[-1]))
    assert s.q[-2, 1] == pytest.approx(-4.0 * M * b**3 / ice.k_f, rel=5e-3)
    assert s.u[-2, 0] == pytest.approx(-F * 200.0 / (ice.E * 2.0), rel=1e-2)


@pytest.mark.parametrize("lead", [0.5, 1.5])
def test_the_end_of_a_floating_beam_turns_under_a_weight_ahead_of_it(lead):
    """The same beam under a force F down at x = lead: beside its own deflection that of the end moment -lead F."""
    grid, ice, F = Grid(201, 3, 1.0), Ice(E=8.7e9, nu=0.0, h=1.0, rho_i=846.0, rho_w=1006.0), 1e3
    down = F * np.array([[0, 0, -0.25], [0, 0, -0.5], [0, 0, -0.25]])
    ends = []
    for ahead in (lead, 0.0):
        e, s = Engine(grid, ice, hrennikoff(ice), held_in_plane=back_held(grid)), State.rest(grid.nodes)
        for k in range(3):
            s = e.step(1e5 * k, 1e5, s, *no_force(grid), Push(grid.edge_nodes("x+"), down, 0.0, ahead)).state
        ends.append(s)
    b, M = (ice.k_f / (4.0 * ice.D)) ** 0.25, lead * F / 2.0
    assert ends[0].q[-2, 0] - ends[1].q[-2, 0] == pytest.approx(-2.0 * M * b**2 / ice.k_f, rel=5e-3)
    assert ends[0].q[-2, 1] - ends[1].q[-2, 1] == pytest.approx(4.0 * M * b**3 / ice.k_f, rel=5e-3)


@pytest.mark.parametrize(("height", "lead"), [(0.0, 0.0), (1.3, 0.0), (-1.2, 0.0), (0.0, 1.5), (1.3, 1.5)])
def test_what_a_point_feels_and_how_it_moves_belong_together(height, lead):
    """The compliance that the contact is solved with gives the displacement of its points, and is symmetric."""
    e = Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=back_held(GRID), alpha=1e-3)
    nodes = np.concatenate((GRID.edge_nodes("x+"), GRID.edge_nodes("y+")[3:5]))
    force = np.random.default_rng(1).normal(size=(len(nodes), 3))
    push = Push(nodes, force, height, lead)
    stage = e.step(0.0, 0.05, State.rest(GRID.nodes), *no_force(GRID), push).stages[0].state
    G = e.edge(nodes, lever_of(push)).compliance()
    y = point_displacement(stage.u, stage.q, nodes, lever_of(push))
    np.testing.assert_allclose(np.einsum("iajb,jb->ia", G, force), y, rtol=0, atol=1e-9 * np.abs(y).max())
    np.testing.assert_allclose(G, G.transpose(2, 3, 0, 1), rtol=0, atol=1e-9 * np.abs(G).max())


def cushioned(height, long_step=1, lead=0.0):
    engine = Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=back_held(GRID), damping=2000.0, alpha=1e-3)
    sheet = Sheet(engine, 0.025, long_step=long_step)
    for k in range(80):
        sheet.advance(0.025 * k, [], Cushion(height, lead), lambda nodes: None)
    return sheet


@pytest.mark.parametrize(
    ("height", "long_step", "lead"), [(1.3, 1, 0.0), (-1.3, 1, 0.0), (1.3, 4, 0.0), (0.0, 1, 1.5), (1.3, 4, 1.5)]
)
def test_energy_closes_with_a_contact_beside_the_node(height, long_step, lead):
    e = cushioned(height, long_step, lead).energy
    assert e.contact > 0.0
    assert abs(e.residual) < (1e-9 if long_step == 1 else 1e-3) * e.contact


@pytest.mark.parametrize(("height", "lead"), [(1.3, 0.0), (0.0, 1.5)])
def test_books_with_the_wrong_sign_of_the_lever_do_not_close(height, lead):
    e = Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=back_held(GRID))
    here, live, contact = np.ones(GRID.nodes, bool), np.ones(GRID.cells, bool), Cushion(height, lead)
    right, wrong, s = EnergyBooks(e), EnergyBooks(e), State.rest(GRID.nodes)
    for k in range(40):
        step = e.step(0.025 * k, 0.025, s, *no_force(GRID), contact)
        for books, z in ((right, step.lever), (wrong, Lever(-step.lever.height, -step.lever.lead))):
            books.book_step(replace(step, lever=z), [], contact.nodes, live, here)
        s = step.state
    assert abs(right.residual) < 1e-9 * right.contact
    assert abs(wrong.residual) > 1e-2 * right.contact


def test_work_is_the_force_times_the_way_of_its_point():
    """Exactly so for constant forces: also where they turn the edge more than they push it."""
    push = Push(GRID.edge_nodes("x+"), np.tile([-1e5, 3e4, -2e4], (GRID.ny, 1)), 1.4, 0.8)
    sheet = Sheet(Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=back_held(GRID)), 0.05)
    for k in range(30):
        sheet.advance(0.05 * k, [], push, lambda nodes: None)
    work = (push.force * edge_displacement(sheet.state, push.nodes, lever_of(push))).sum()
    below = (push.force * edge_displacement(sheet.state, push.nodes, Lever(-push.height, -push.lead))).sum()
    assert sheet.energy.contact == pytest.approx(work, rel=1e-10)
    assert abs(work - below) > 0.1 * abs(work)
