"""Order and limit of the coupling schemes, measured on two masses of which the exact motion is known."""

import importlib.util
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from coupling.interface import SheetForces, SimulationError
from coupling.ledger import Ledger
from coupling.relaxation import combined
from coupling.scheduler import Scheduler
from coupling.schemes import SCHEMES, Iteration

SPEC = importlib.util.spec_from_file_location("stubs", Path(__file__).parents[1] / "stubs.py")
stubs = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(stubs)

TIGHT = Iteration(tolerance=1e-12, max_iterations=60, floor=1e-9)
END = 2.0  #: [s]


def run(scheme, windows, iteration=TIGHT):
    s = Scheduler(
        stubs.MassOnSpring(),
        stubs.MassBehindSpring(),
        Ledger(1.0),
        round(END * stubs.NS) // windows,
        SCHEMES[scheme](iteration),
    )
    frames = [s.macro_step() for _ in range(windows)]
    return np.concatenate((s.sheet.state, s.rubble.state)), s, frames


def error(scheme, windows):
    return np.linalg.norm(run(scheme, windows)[0] - stubs.exact(END))


@pytest.mark.parametrize(
    ("scheme", "order"), [("serial-explicit", 1), ("parallel-explicit", 1), ("serial-implicit", 2)]
)
def test_order(scheme, order):
    """A force that lags by a window costs one order; a mean force and a straight way that fit each other leave two."""
    errors = [error(scheme, n) for n in (100, 200, 400)]
    p = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (np.abs(p - order) < 0.2).all(), p


def monolithic(windows):
    """The same discretisation with force and motion solved for together: one linear equation in each window."""
    sheet, rubble, dt = stubs.MassOnSpring(), stubs.MassBehindSpring(), END / windows

    def answer(force):
        at = sheet.save(), rubble.save()
        rubble._force = force
        sheet.advance(0, round(dt * stubs.NS), rubble.forces_on_sheet(), None)
        rubble.set_sheet(sheet.path([0]), None, None)
        rubble.advance(round(dt * stubs.NS))
        out = rubble._force
        after = sheet.save(), rubble.save()
        at[0]()
        at[1]()
        return out, after

    for _ in range(windows):
        a, slope = answer(0.0)[0], answer(1.0)[0] - answer(0.0)[0]
        after = answer(a / (1.0 - slope))[1]
        after[0]()
        after[1]()
    return np.concatenate((sheet.state, rubble.state))


@pytest.mark.parametrize("relaxation", [0.1, 0.5, 1.0])
def test_the_implicit_scheme_leaves_no_error_of_the_coupling(relaxation):
    """Its answer is the one of both solved together, from wherever the iteration starts."""
    state, _, _ = run("serial-implicit", 40, Iteration(1e-12, 60, relaxation, 1e-9))
    assert state == pytest.approx(monolithic(40), abs=1e-10)
    assert run("serial-explicit", 40)[0] != pytest.approx(monolithic(40), abs=1e-3)


def test_no_power_is_lost_on_an_interface_that_agrees():
    implicit, explicit = (run(scheme, 40)[2] for scheme in ("serial-implicit", "serial-explicit"))
    power = max(abs(f.ledger["power_to_sheet"]) for f in implicit)
    assert power > 0.1
    assert max(abs(f.ledger["power_residual"]) for f in implicit) < 1e-9 * power
    assert max(abs(f.ledger["power_residual"]) for f in explicit) > 1e-2 * power


def test_a_window_that_does_not_converge_is_not_passed_over():
    short = {"tolerance": 1e-12, "max_iterations": 2, "floor": 1e-9}
    with pytest.raises(SimulationError, match=r"t = 0.000 s: .* after 2 iterations of the window of 50 ms .*shorten"):
        run("serial-implicit", 40, Iteration(**short))
    first, *_, last = run("serial-implicit", 40, Iteration(**short, stop=False))[2]
    assert first.ledger["interface_residual"] > 1e-12
    assert last.ledger["unconverged_windows"] == 1.0  # from then on omega is known and two passes are enough


def test_aitken_needs_fewer_iterations_than_a_fixed_share():
    """Of a linear answer the secant is exact: two passes find it, the third confirms it."""
    _, s, frames = run("serial-implicit", 40)
    assert max(f.ledger["iterations"] for f in frames) <= 4.0
    assert s.rubble.calls == sum(f.ledger["iterations"] for f in frames)


class Wall:
    """Rubble jammed against a wall of stiffness k_w; the sheet's edge is a body on a spring k that carries a force."""

    def __init__(self, k):
        self.k, self.mass, self.cleared_mass, self.power, self.pressed = k, 0.0, 0.0, 0.0, 0.0
        self.budget = {}
        self.energy, self.momenta = {}, {}

    def save(self):
        return partial(setattr, self, "pressed", self.pressed)

    def sections_in_use(self):
        return [0]

    def set_sheet(self, edges, carried, compliance):
        way = edges[0].x[0] + edges[0].velocity[0, 0] * WINDOW - carried.force[:, 0].sum() / self.k
        self.pressed = WALL * way / (1.0 + WALL / self.k)

    def advance(self, window_ns):
        pass

    def forces_on_sheet(self):
        return stubs.SheetForces(np.array([0]), np.array([[-self.pressed, 0.0, 0.0]]))

    def events(self, t_ns, load):
        return []

    def load(self):
        return np.zeros((3, 3))

    def blocks(self):
        return stubs.BlockTable.empty()


class Pusher(stubs.MassOnSpring):
    """A sheet that is pushed on by 1 mm per window and yields by F / STIFFNESS."""

    def advance(self, t_ns, window_ns, rubble, rubble_load):
        self._before, self._window = self.state, WINDOW
        self.state = np.array([1e-3 * (t_ns / window_ns + 1) + rubble.force[:, 0].sum() / STIFFNESS, 0.0])
        return stubs.SheetReport(np.zeros(3))


WALL, STIFFNESS, WINDOW = 1e9, 1e8, 0.05


@pytest.mark.parametrize("k", [0.3 * STIFFNESS, STIFFNESS, 5.0 * STIFFNESS])
def test_the_stiffness_of_the_rubbles_edge_changes_the_way_not_the_answer(k):
    """Springs that carry the forces of the pass are at rest in the end: only the lattice's own stiffness counts."""
    s = Scheduler(Pusher(), Wall(k), Ledger(1.0), round(WINDOW * stubs.NS), SCHEMES["serial-implicit"](TIGHT))
    frames = [s.macro_step() for _ in range(5)]
    assert s.rubble.pressed == pytest.approx(5e-3 / (1.0 / WALL + 1.0 / STIFFNESS), rel=1e-9)
    assert max(f.ledger["iterations"] for f in frames) <= (2.0 if k == STIFFNESS else 4.0)


@pytest.mark.parametrize(("k", "grows"), [(0.5, False), (1.0, False), (2.0, False), (5.0, True)])
def test_the_explicit_scheme_needs_an_edge_no_stiffer_than_the_sheet_is_in_a_window(k, grows):
    """The error of the rubble's answer is r = -(k / K - 1) k_w / (k_w + k) times that of the force on the sheet.

    K is the stiffness of the sheet in a window. With the running mean the errors go on by the matrix
    [[0.6 r, 0.4], [0.2 r, 0.8]]: its largest eigenvalue tells whether they grow.
    """
    scheme = SCHEMES["serial-explicit"](TIGHT)
    s = Scheduler(Pusher(), Wall(k * STIFFNESS), Ledger(1.0), round(WINDOW * stubs.NS), scheme)
    error = []
    for n in range(1, 60):
        s.macro_step()
        error.append(s.rubble.pressed - n * 1e-3 / (1.0 / WALL + 1.0 / STIFFNESS))
    r = -(k - 1.0) * WALL / (WALL + k * STIFFNESS)
    largest = np.abs(np.linalg.eigvals([[0.6 * r, 0.4], [0.2 * r, 0.8]])).max()
    steady = np.diff(error)  # the load grows evenly: the lag is constant
    assert bool(largest > 1.0) == grows
    assert bool(np.abs(steady[-3:]).max() > np.abs(steady[:3]).max() + 1.0) == grows


class WeakGaussSeidel:
    """A scheme from outside: the sheet feels the mean of the rubble's last two answers."""

    def __init__(self):
        self.before = SheetForces.none()

    def __call__(self, s):
        force = combined(0.5, s.rubble.forces_on_sheet(), 0.5, self.before)
        self.before = s.rubble.forces_on_sheet()
        report = s.move_sheet(force)
        s.move_rubble(s.sheet.path(s.rubble.sections_in_use()), force)
        return report


def test_a_scheme_from_outside_is_one_entry_of_the_table(monkeypatch):
    """It runs by its name and is another scheme: of first order, with another error than those that are there."""
    monkeypatch.setitem(SCHEMES, "weak-gauss-seidel", lambda _: WeakGaussSeidel())
    errors = {name: [error(name, n) for n in (200, 400)] for name in ("weak-gauss-seidel", "serial-explicit")}
    assert np.log2(np.divide(*errors["weak-gauss-seidel"])) == pytest.approx(1.0, abs=0.2)
    assert abs(errors["weak-gauss-seidel"][1] / errors["serial-explicit"][1] - 1.0) > 0.2
