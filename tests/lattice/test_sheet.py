"""Failures within a window: located in time, ordered, with an energy balance that closes; long steps change nothing."""

from dataclasses import replace

import numpy as np
import pytest

from lattice.contact import NoContact
from lattice.criteria.judge import Judge
from lattice.criteria.table import Criterion
from lattice.grid import Grid
from lattice.ice import Ice
from lattice.implicit.engine import Engine
from lattice.outcome import TURNED_TOO_FAR, Outcome
from lattice.sheet import Sheet
from lattice.state import StepError
from lattice.stiffness import hrennikoff

GRID = Grid(13, 12, 2.0)
ICE = Ice(E=8.7e9, nu=1 / 3, h=1.0, rho_i=846.0, rho_w=1006.0, sigma_t=750e3, sigma_f=750e3, sigma_c=4e6)


class Spring:
    """A stiff spring that takes the edge down, slowly at first: w is driven to -rate t^2, whatever breaks."""

    def __init__(self, nodes, rate=0.006, k=2e7):
        self.nodes, self.rate, self.k = np.asarray(nodes), rate, k

    @property
    def height(self):
        return np.zeros(len(self.nodes))

    @property
    def lead(self):
        return np.zeros(len(self.nodes))

    def evaluate(self, t, y):
        force, tangent = np.zeros((len(y), 3)), np.zeros((len(y), 3, 3))
        force[:, 2] = self.k * (-self.rate * t**2 - y[:, 2])
        tangent[:, 2, 2] = -self.k
        return force, tangent


def pressed_down(seconds, *, dt=0.05, long_step=1, alpha=0.0, rate=0.006):
    """A floe held at its back, pressed down at the middle of its front; returns sheet, outcomes, times."""
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    engine = Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=held, damping=500.0, alpha=alpha)
    sheet = Sheet(engine, dt, long_step=long_step)
    contact = Spring(GRID.edge_nodes("x+")[5:7], rate)
    outcomes = []

    def release(nodes):
        contact.nodes = np.setdiff1d(contact.nodes, nodes)

    for k in range(round(seconds / dt)):
        outcomes.append(sheet.advance(k * dt, [], contact, release))
    return sheet, outcomes


def first_failure(outcomes):
    return next(o.failure[0] for o in outcomes if o.failure)


@pytest.mark.parametrize("alpha", [0.0, 1e-3])
@pytest.mark.parametrize("long_step", [1, 4])
def test_energy_closes_through_failures(alpha, long_step):
    """Work = stored + damping + scheme + fracture + handed over, to rounding (long steps: to their interpolation)."""
    sheet, outcomes = pressed_down(8.0, alpha=alpha, long_step=long_step)
    assert sum(len(o.failed) for o in outcomes) >= 3
    e = sheet.energy
    assert e.fracture > 0.0
    assert e.damping > 0.0
    assert abs(e.residual) < (1e-9 if long_step == 1 else 1e-3) * e.contact
    assert abs(e.residual - 2.0 * e.fracture) > 1e-3 * e.contact  # the wrong sign of a term is noticed


def test_a_failure_time_does_not_depend_on_the_window():
    times = [first_failure(pressed_down(7.0, dt=dt)[1]) for dt in (0.1, 0.05, 0.025)]
    assert times[0] == pytest.approx(times[2], rel=1e-3)
    assert times[1] == pytest.approx(times[2], rel=5e-4)


def test_long_steps_find_the_same_failure():
    short, long = pressed_down(7.0), pressed_down(7.0, long_step=8)
    assert first_failure(long[1]) == pytest.approx(first_failure(short[1]), rel=1e-3)
    assert long[1][100].contact_end[:, 2] == pytest.approx(short[1][100].contact_end[:, 2], rel=1e-2)


def test_a_rotating_floe_does_not_fail_by_rotating():
    sheet = Sheet(Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=np.zeros(GRID.nodes, bool)), 0.05)
    turn = 0.05
    x = GRID.xy - GRID.xy.mean(axis=0)
    sheet.state.u[:] = np.column_stack((-turn * x[:, 1], turn * x[:, 0]))
    out = sheet.advance(0.0, [], NoContact(), lambda n: None)
    assert not out.failed
    assert sheet.utilisation.max() < 1e-3


def test_a_hanging_piece_that_has_turned_too_far_leaves():
    """Two cells hold a strip; once it has turned by more than 0.1 rad it is handed over with all that it has."""
    sheet, _ = pressed_down(0.05)
    hinge = GRID.nx - 4
    piece = np.zeros((GRID.nx, GRID.ny), bool)
    piece[hinge + 1 :, 4:8] = True
    corners = piece.ravel()[GRID.cell_nodes]
    for cell in np.flatnonzero(corners.any(axis=1) & ~corners.all(axis=1)):
        if not (GRID.cell_nodes[cell] // GRID.ny == hinge).any() or GRID.cell_nodes[cell][0] % GRID.ny not in (5, 6):
            sheet.fail([int(cell)], [""], sheet.state, Outcome())
    sheet.state.q[piece.ravel(), 1] = 0.09
    left = []
    sheet.judge = Judge(GRID, ICE, (Criterion("never", lambda state, ice: np.zeros(GRID.cells)),))
    sheet.advance(0.05, [], NoContact(), left.append)
    assert not left
    sheet.state.q[piece.ravel(), 1] = 0.11
    mass = sheet.present.sum()
    out = sheet.advance(0.10, [], NoContact(), left.append)
    assert [sorted(p) for p in left] == [np.flatnonzero(piece.ravel()).tolist()]
    assert sheet.present.sum() == mass - piece.sum()
    assert sheet.energy.handed_over > 0.0
    assert set(out.causes) == {TURNED_TOO_FAR}


@pytest.mark.parametrize("held", [False, True])
def test_a_part_that_has_turned_as_a_whole_leaves_without_a_failure(held):
    """Whatever its size and where it is held in the plane: its rotation is out of the lattice's range."""
    at = np.zeros(GRID.nodes, bool)
    at[GRID.edge_nodes("x-")] = held
    sheet = Sheet(Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=at), 0.05)
    sheet.state.q[:] = np.column_stack((-0.2 * (GRID.xy[:, 0] - 12.0), np.full(GRID.nodes, 0.2), np.zeros(GRID.nodes)))
    out = sheet.advance(0.0, [], NoContact(), lambda n: None)
    assert not out.failed
    assert [len(p) for p in out.pieces] == [GRID.nodes]
    assert not sheet.present.any()


@pytest.mark.parametrize(("sides", "leaves"), [((False, True), True), ((True, True), False)])
def test_a_strip_that_breaks_off_between_rollers_leaves(sides, leaves):
    """Rollers at the sides hold it across the drift only; sides that are held keep it."""
    held = np.zeros((GRID.nodes, 2), bool)
    held[np.concatenate((GRID.edge_nodes("y-"), GRID.edge_nodes("y+")))] = sides
    held[GRID.edge_nodes("x-")] = True
    sheet, out, left = Sheet(Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=held), 0.05), Outcome(), []
    across = ((GRID.nx - 3) * (GRID.ny - 1) + np.arange(GRID.ny - 1)).tolist()
    sheet.fail(across, ["bending"] * len(across), sheet.state, out)
    sheet._release_loose(out, left.append)
    assert [len(piece) for piece in left] == ([2 * GRID.ny] if leaves else [])


# ---- steps that do not come to their end --------------------------------------------------------------------------


def refuse(step, longest):
    """Engine steps above ``longest`` [s] find no equilibrium."""

    def refusing(self, t, dt, *arguments):
        if dt > longest:
            raise StepError("the contact of the sheet's edge finds no equilibrium")
        return step(self, t, dt, *arguments)

    return refusing


def push_too_much(step, longest):
    """Engine steps above ``longest`` [s] book a contact force that is 0.1 % too large."""

    def wrong(self, t, dt, *arguments):
        made = step(self, t, dt, *arguments)
        if dt <= longest:
            return made
        return replace(made, stages=tuple(replace(s, contact=1.001 * s.contact) for s in made.stages))

    return wrong


@pytest.mark.parametrize("fault", [refuse, push_too_much])
def test_a_step_that_misses_its_bound_is_solved_in_halves(monkeypatch, fault):
    """Windows of 50 ms in steps of at most 15 ms are those of 12.5 ms, four by four, failures and all."""
    fine, parts = pressed_down(6.6, dt=0.0125)
    monkeypatch.setattr(Engine, "step", fault(Engine.step, 0.015))
    halved, outcomes = pressed_down(6.6)
    assert halved.energy.fracture > 0.0
    np.testing.assert_allclose(halved.state.q, fine.state.q, rtol=1e-9, atol=1e-12)
    np.testing.assert_array_equal(halved.intact, fine.intact)
    assert abs(halved.energy.residual) < 1e-9 * halved.energy.contact
    for k in (10, 80, 131):
        four = [p.contact_mean.sum(axis=0) for p in parts[4 * k : 4 * k + 4]]
        np.testing.assert_allclose(outcomes[k].contact_mean.sum(axis=0), np.mean(four, axis=0), rtol=1e-12)
        lift = np.mean([p.reaction.foundation[1] for p in parts[4 * k : 4 * k + 4]])
        assert outcomes[k].reaction.foundation[1] == pytest.approx(lift, rel=1e-12)
    assert [cell for o in outcomes for cell in o.failed] == [cell for p in parts for cell in p.failed]
    assert first_failure(outcomes) == pytest.approx(first_failure(parts), rel=1e-12)


def test_below_the_shortest_step_the_key_to_change_is_told(monkeypatch):
    monkeypatch.setattr(Engine, "step", refuse(Engine.step, 0.0))
    text = "finds no equilibrium, even in steps of 0.781 ms, 1/64 of the window; shorten coupling.window"
    with pytest.raises(StepError, match=text):
        pressed_down(0.05)


def test_a_long_step_without_equilibrium_is_a_shorter_one(monkeypatch):
    monkeypatch.setattr(Engine, "step", refuse(Engine.step, 0.12))
    sheet, outcomes = pressed_down(2.0, long_step=4)
    assert len(outcomes) == 40
    assert abs(sheet.energy.residual) < 1e-3 * sheet.energy.contact


def given_up(booked_as_a_step):
    """A floe whose contact has just begun, after one window of a long step that is then given up."""
    held = np.zeros(GRID.nodes, bool)
    held[GRID.edge_nodes("x-")] = True
    sheet = Sheet(Engine(GRID, ICE, hrennikoff(ICE), held_in_plane=held, damping=500.0), 0.05, long_step=4)
    contact, t = Spring(GRID.edge_nodes("x+")[5:7]), 0.0
    while sheet.ahead.under_way is None or sheet.ahead.under_way.served != 1 or t < 0.3:
        sheet.advance(t, [], contact, lambda nodes: None)
        t += 0.05
    read_off = sheet.state
    sheet._drop_long_step(t, contact if booked_as_a_step else None)
    assert sheet.ahead.under_way is None
    return sheet, read_off


def test_what_was_served_of_a_long_step_balances_however_little_work_was_done():
    """An interpolation is no step: its books miss so much of the first joules that a run would stop."""
    sheet, read_off = given_up(booked_as_a_step=True)
    assert 0.0 < sheet.energy.contact < 1e3
    assert abs(sheet.energy.residual) < 1e-9 * sheet.energy.contact
    np.testing.assert_allclose(sheet.state.q, read_off.q, atol=2e-4 * ICE.h)  # as good as a long step may be
    as_read, _ = given_up(booked_as_a_step=False)
    assert abs(as_read.energy.residual) > 1e-3 * as_read.energy.contact
