"""The explicit engine against the assembled matrices, closed forms and the implicit engine."""

from dataclasses import replace

import numpy as np
import pytest

from lattice.assembly import assemble
from lattice.contact import NoContact, no_faces
from lattice.criteria.laws import combined_tension
from lattice.energy import EnergyBooks
from lattice.explicit.engine import ExplicitEngine, SubSteps
from lattice.explicit.forces import NOTHING, Touch
from lattice.explicit.kernels import sweep
from lattice.explicit.march import march
from lattice.explicit.screen import overloaded
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.implicit.engine import Engine
from lattice.loads import NodeLoad
from lattice.sheet import Sheet
from lattice.state import State
from lattice.stiffness import STIFFNESS_SETS, hrennikoff
from lattice.strain import CellState

GRID = Grid(9, 7, 3.0)
BRITTLE = Ice(E=8.7e9, nu=1 / 3, h=3.0, rho_i=846.0, rho_w=1006.0, sigma_t=750e3, sigma_f=750e3, sigma_c=4e6)
ICE = replace(BRITTLE, sigma_t=1e15, sigma_f=1e15, sigma_c=5e15)
HERE = np.ones(GRID.nodes, bool)
NO_TOUCH = Touch(*np.zeros((2, 0), np.int64), *np.zeros((2, 0)), *np.zeros((2, 0, 3)), np.zeros((0, 3, 3)), no_faces(0))
MIRROR = np.arange(GRID.nodes).reshape(GRID.nx, GRID.ny)[:, ::-1].ravel()


def engine(window, grid=GRID, ice=ICE, **options):
    options = {"held_in_plane": np.zeros(grid.nodes, bool)} | options
    return ExplicitEngine(grid, ice, hrennikoff(ice), window, **options)


def after(e, state, windows=1):
    """State after whole windows without forces."""
    for _ in range(windows):
        e.start(state, HERE if len(state.u) == GRID.nodes else np.ones(len(state.u), bool), ())
        e.march(e.sub_steps, NOTHING, NO_TOUCH, False)
        state = e.state(state, np.ones(len(state.u), bool), ())
    return state


def rough(seed=3):
    rng, n = np.random.default_rng(seed), GRID.nodes
    return State(*(1e-3 * rng.standard_normal((n, k)) for k in (2, 3)), *(rng.standard_normal((n, k)) for k in (2, 3)))


def smooth():
    """Long waves in every degree of freedom."""
    x, y = GRID.xy.T / 24.0
    s = State.rest(GRID.nodes)
    s.u[:] = 1e-3 * np.column_stack((np.cos(np.pi * x), np.cos(2 * np.pi * y) * x))
    s.q[:] = 1e-2 * np.column_stack((np.cos(np.pi * x) * y, 0.1 * np.sin(np.pi * x), 0.05 * y))
    return s


@pytest.mark.parametrize("name", sorted(STIFFNESS_SETS))
@pytest.mark.parametrize("nu", [1 / 3, 0.25])
def test_the_kernel_is_the_assembled_lattice(name, nu):
    """One sweep from rest is -dt M^-1 (K + foundation) x, with broken cells and held nodes."""
    ice, rng = replace(ICE, nu=nu), np.random.default_rng(1)
    springs, held = STIFFNESS_SETS[name](ice), np.zeros(GRID.nodes, bool)
    held[: GRID.ny] = True
    e = ExplicitEngine(GRID, ice, springs, 1e-4, held_in_plane=held)
    live = rng.random(GRID.cells) > 0.3
    e.set_cells(live, np.full(GRID.cells, ice.sigma_t), HERE)
    s = rough()
    e.put(e.motion.y, np.hstack((s.u, s.q)))
    sweep(e.motion, e.mesh.intact, e.mesh.kick, e.mesh.springs, e.mesh.pace, e.mesh.rows)
    v = e.get(e.motion.v)
    expected_u = -e.dt / e.M_u * (assemble(GRID, e.rows_u, live) @ s.u.ravel()) * np.repeat(~held, 2)
    expected_q = -e.dt / e.M_q * (assemble(GRID, e.rows_q, live) @ s.q.ravel() + e.k_f * s.q.ravel())
    np.testing.assert_allclose(v[:, :2].ravel(), expected_u, rtol=1e-9, atol=1e-12 * np.abs(expected_u).max())
    np.testing.assert_allclose(v[:, 2:].ravel(), expected_q, rtol=1e-9, atol=1e-12 * np.abs(expected_q).max())


def test_the_compiled_criterion_is_the_criterion():
    """Faces counted in the loop are those of (4.6), for limits that a third of the cells reach; and not a number."""
    e, s = engine(1e-4, ice=BRITTLE), rough()
    load = combined_tension(CellState.of(GRID, s.u, s.q), BRITTLE)
    limit = BRITTLE.sigma_t * np.where(np.arange(GRID.cells) % 3 == 0, 0.999, 1.001) * load
    e.set_cells(np.ones(GRID.cells, bool), limit, HERE)
    e.put(e.motion.y, np.hstack((s.u, s.q)))
    e.motion.v[:] = 0.0
    at_limit = np.count_nonzero(np.arange(GRID.cells) % 3 == 0)
    assert overloaded(e.motion, e.mesh.threshold, e.screen, 0.0) == at_limit
    e.motion.y[0, 4, 3] = np.nan
    assert overloaded(e.motion, e.mesh.threshold, e.screen, 0.0) > at_limit


def energy_drift(share):
    e = engine(0.01)
    e = engine(0.01, sub_steps=SubSteps(share * e.critical))
    books, s = EnergyBooks(e), smooth()
    live = np.ones(GRID.cells, bool)
    books.measure(s, live, HERE)
    start, worst = books.stored, 0.0
    for _ in range(20):
        s = after(e, s)
        books.measure(s, live, HERE)
        worst = max(worst, abs(books.stored / start - 1.0))
    return worst


def test_energy_is_conserved_at_second_order_without_damping():
    coarse, fine = energy_drift(0.2), energy_drift(0.1)
    assert coarse < 0.02
    assert 1.7 < np.log2(coarse / fine) < 2.3


@pytest.mark.parametrize("alpha", [0.0, 1e-3])
def test_a_free_floe_keeps_its_momentum(alpha):
    e, s = engine(0.01, alpha=alpha), rough()
    s.u_dot[:] += (0.3, -0.2)
    mass = e.M_u.reshape(-1, 2)
    before = (mass * s.u_dot).sum(axis=0)
    gone = (mass * after(e, s, 5).u_dot).sum(axis=0)
    np.testing.assert_allclose(gone, before, rtol=1e-9)
    assert not np.allclose(gone, -before)


def test_heave_has_its_period():
    """w'' = -rho_w g / (rho_i h) w: back where it was after one period."""
    T = 2 * np.pi / np.sqrt(ICE.k_f / (ICE.rho_i * ICE.h))
    e, s = engine(T / 40), State.rest(GRID.nodes)
    s.q[:, 0] = 0.1
    half, s = after(e, s, 20), after(e, s, 40)
    np.testing.assert_allclose(half.q[:, 0], -0.1, rtol=1e-5)
    np.testing.assert_allclose(s.q[:, 0], 0.1, rtol=1e-5)


def test_a_long_in_plane_wave_runs_along_an_axis_at_the_plane_stress_speed():
    """sqrt(E / (rho (1 - nu^2))) while the sides, too far for their waves to arrive, hold the ice from contracting."""
    grid, cells = Grid(181, 141, 1.0), 60
    c = np.sqrt(ICE.E / (ICE.rho_i * (1.0 - ICE.nu**2)))
    s, x = State.rest(grid.nodes), grid.xy[:, 0] - 90.0
    s.u[:, 0] = 1e-3 * np.exp(-((x / 8.0) ** 2))
    e = engine(cells / c, grid=grid)
    s = after(e, s)
    u = s.u.reshape(181, 141, 2)[90:, 70, 0]
    speed = (u**2 @ np.arange(91)) / (u**2).sum() / (cells / c)
    assert speed == pytest.approx(c, rel=0.02)


def test_mirrored_motion_stays_mirrored():
    a = rough()
    b = State(a.u[MIRROR] * (1, -1), a.q[MIRROR] * (1, 1, -1), a.u_dot[MIRROR] * (1, -1), a.q_dot[MIRROR] * (1, 1, -1))
    e = engine(0.01, alpha=1e-3, damping=500.0)
    a, b = after(e, a), after(e, b)
    np.testing.assert_allclose(b.u[MIRROR] * (1, -1), a.u, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(b.q[MIRROR] * (1, 1, -1), a.q, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("alpha", [0.0, 1e-3])
def test_the_critical_step_is_sharp_and_a_longer_one_is_refused(alpha):
    limit = engine(0.1, alpha=alpha).critical
    with pytest.raises(ValueError, match="is not stable: use at most") as error:
        engine(0.1, alpha=alpha, sub_steps=SubSteps(1.001 * limit))
    assert "\n" not in str(error.value)
    for share, bounded in ((0.999, True), (1.01, False)):
        e = engine(2000 * 0.9 * limit, alpha=alpha, sub_steps=SubSteps(0.9 * limit))
        e.allocate(share * limit)
        e.start(rough(), HERE, ())
        size = np.abs(e.motion.y).max()
        e.march(2000, NOTHING, NO_TOUCH, False)
        assert (np.abs(e.motion.y).max() < 1e3 * size) == bounded


class Cushion:
    """Elastic cushion that comes towards the front edge and pushes it back and down."""

    nodes = GRID.edge_nodes("x+")
    direction = np.array([-0.7, 0.05, -0.7])

    def __init__(self, height=0.0, lead=0.0):
        self.height, self.lead = np.full(len(self.nodes), height), np.full(len(self.nodes), lead)

    def evaluate(self, t, y):
        depth, k = 0.05 * t + y[:, 0] + y[:, 2], 2e6
        tangent = np.zeros((len(y), 3, 3))
        tangent[:, :, 0] = tangent[:, :, 2] = k * self.direction
        return k * depth[:, None] * self.direction, tangent


def loaded(kind, windows=120, height=0.0, lead=0.0, **options):
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    damped = {"held_in_plane": held, "damping": 2000.0, "alpha": 1e-3}
    if kind is Sheet:
        sheet = Sheet(Engine(GRID, ICE, hrennikoff(ICE), **damped), 0.025)
    else:
        sheet = ExplicitSheet(engine(0.025, **damped), **options)
    F_u, F_q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
    load = np.array([-2e5, 1e5, -3e5])
    states, means = [], []
    for k in range(windows):
        F_q[GRID.node(4, 2)] = load * k / windows
        out = sheet.advance(0.025 * k, [NodeLoad("load", F_u, F_q)], Cushion(height, lead), lambda nodes: None)
        states.append(np.hstack((sheet.state.u, sheet.state.q)))
        means.append(out.contact_mean.sum(axis=0))
    return sheet, np.array(states), np.array(means)


@pytest.mark.parametrize(("height", "lead"), [(0.0, 0.0), (1.3, 0.0), (0.5, 1.0)])
def test_both_engines_agree_on_a_loaded_sheet(height, lead):
    """Within 1 % at the ends of the windows; energy balances; the contact's nodes see the same mean force."""
    (sheet, x, f), (_, y, g) = loaded(ExplicitSheet, height=height, lead=lead), loaded(Sheet, height=height, lead=lead)
    for dof in range(5):
        np.testing.assert_allclose(x[10:, :, dof], y[10:, :, dof], rtol=0, atol=0.01 * np.abs(y[..., dof]).max())
    np.testing.assert_allclose(f[10:], g[10:], rtol=0, atol=0.01 * np.abs(g).max())
    assert abs(sheet.energy.residual) < 1e-3 * sheet.energy.contact


def test_contact_may_be_linear_over_several_sub_steps():
    (a, x, _), (_, y, _) = loaded(ExplicitSheet, 20), loaded(ExplicitSheet, 20, contact_time=1e-9)
    assert a.block > 1
    np.testing.assert_allclose(x[-1], y[-1], rtol=0, atol=1e-4 * np.abs(y[-1]).max())


def pull(stress):
    """Forces on the ends x- and x+ that make a uniform stress [Pa], (n, 2)."""
    share, F = np.full(GRID.ny, GRID.d), np.zeros((GRID.nodes, 2))
    share[[0, -1]] *= 0.5
    for side, sign in (("x+", 1.0), ("x-", -1.0)):
        F[GRID.edge_nodes(side), 0] = sign * stress * ICE.h * share
    return F


def pulled(until, stress=2.0, longest=None, **options):
    """A sheet pulled at both ends at ``stress`` of the strength, suddenly, until some time; 1-ms windows."""
    sheet = ExplicitSheet(engine(1e-3, ice=BRITTLE, sub_steps=SubSteps(longest)), share=0.0, **options)
    F = pull(stress * BRITTLE.sigma_t)
    for k in range(round(until / 1e-3)):
        sheet.advance(1e-3 * k, [NodeLoad("pull", F, np.zeros((GRID.nodes, 3)))], NoContact(), lambda nodes: None)
    return sheet


@pytest.mark.parametrize("alpha", [0.0, 1e-3])
def test_a_crack_leaves_its_flanks_standing(alpha):
    """Uniform tension above the limit beside a crack: the cells ahead of a new hole fail, those in its shadow hold."""
    ice = replace(BRITTLE, beam_test=BeamTest(length=18.0, width=6.0, failure_load=375e3, factor=0.75))
    stress = 0.99 * ice.sigma_t
    assert ice.stress_beside_crack(GRID.d) < stress
    sheet = ExplicitSheet(engine(1e-3, ice=ice, alpha=alpha), share=0.0)
    x, y = GRID.xy.T
    sheet.state.u[:] = stress / ice.E * np.column_stack((x, -ice.nu * y))
    for k in range(10):
        if k == 1:
            hole = 4 * (GRID.ny - 1) + 3
            sheet.intact[hole] = False
            sheet.engine.remove(np.array([hole]))
        sheet.advance(
            1e-3 * k, [NodeLoad("pull", pull(stress), np.zeros((GRID.nodes, 3)))], NoContact(), lambda nodes: None
        )
        assert k > 0 or not sheet.failed_cells
    cells = sheet.intact.reshape(GRID.nx - 1, GRID.ny - 1)
    assert not cells[4].any()
    assert cells[[3, 5]].all()


def test_a_suddenly_pulled_sheet_overshoots():
    """Half the strength, applied suddenly, meets itself with twice its size: 0.3 holds, 0.6 breaks."""
    assert not pulled(0.05, 0.3).failure_times
    assert pulled(0.05, 0.6).failure_times


def test_the_time_of_a_failure_does_not_depend_on_the_sub_step():
    times = [pulled(0.02, longest=step).failure_times[0] for step in (1e-4, 5e-5, 2.5e-5)]
    assert times == pytest.approx([times[-1]] * 3, rel=0.01)


def test_a_broken_sheet_balances_its_energy_and_mirrors():
    sheet = pulled(0.02)
    assert sheet.energy.fracture > 0.0
    assert abs(sheet.energy.residual) < 1e-9 * sheet.energy.received
    cells = sheet.intact.reshape(GRID.nx - 1, GRID.ny - 1)
    assert not cells.all()
    np.testing.assert_array_equal(cells, cells[:, ::-1])


def test_of_two_equal_neighbours_one_fails_first():
    """A row of cells on either side of the middle is loaded alike; they do not fail in the same sub-step."""
    sheet = pulled(0.02)
    times, (i, j) = np.array(sheet.failure_times), np.divmod(sheet.failed_cells, GRID.ny - 1)
    near = np.maximum(np.abs(i[:, None] - i), np.abs(j[:, None] - j)) == 1
    assert near.any()
    assert np.abs(times[:, None] - times)[near].min() > 0.0


def test_pieces_leave_at_once_and_keep_their_state():
    left = []
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    sheet = ExplicitSheet(engine(1e-3, ice=BRITTLE, held_in_plane=held), share=0.5)
    F = np.zeros((GRID.nodes, 2))
    F[GRID.edge_nodes("x+"), 0] = 5e7
    for k in range(60):
        out = sheet.advance(1e-3 * k, [NodeLoad("pull", F, np.zeros((GRID.nodes, 3)))], NoContact(), left.append)
        if out.pieces:
            break
    gone = np.concatenate(left)
    kept = sheet.state.u[gone].copy()
    assert np.abs(kept).max() > 0.0
    assert sheet.energy.pieces.energy > 0.0
    assert abs(sheet.energy.residual) < 1e-9 * sheet.energy.received  # with the half sub-step that they take along
    sheet.advance(1e-3 * (k + 1), [NodeLoad("pull", F, np.zeros((GRID.nodes, 3)))], NoContact(), left.append)
    np.testing.assert_array_equal(sheet.state.u[gone], kept)
    assert not sheet.present[gone].any()


def test_the_same_run_gives_the_same_bits():
    a, b = pulled(0.01), pulled(0.01)
    np.testing.assert_array_equal(a.state.q_dot, b.state.q_dot)
    np.testing.assert_array_equal(a.state.u, b.state.u)


def test_each_kernel_has_one_signature():
    assert [len(f.signatures) for f in (march, sweep, overloaded)] == [1, 1, 1]
