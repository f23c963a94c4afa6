"""The macro step as a drawing: who ran when, with what."""

from functools import partial

import numpy as np
import pytest

from coupling.interface import BlockTable, HandOver, SheetForces, SheetReport, SimulationError
from coupling.ledger import Ledger
from coupling.scheduler import Scheduler
from coupling.schemes import SCHEMES, Iteration


class StubSheet:
    """Breaks off a piece of 10 kg in its second window."""

    def __init__(self, trace):
        self.trace, self.mass, self.crushed, self.energy, self.power = trace, 100.0, 0.0, {}, 0.0

    def save(self):
        mass = self.mass

        def restore():
            self.trace.append("set back")
            self.mass = mass

        return restore

    def advance(self, t_ns, window_ns, rubble, rubble_load):
        self.trace.append(f"sheet {t_ns}-{t_ns + window_ns} under {rubble.force.sum():g}")
        fragments = ["piece"] if t_ns == window_ns else []
        self.mass -= 10.0 * len(fragments)
        return SheetReport(np.array([1.0, 0.0, 2.0]), fragments, [])

    def edges(self, sections):
        self.trace.append(f"edge for sections {list(sections)}")
        return {}

    def path(self, sections):
        self.trace.append(f"path for sections {list(sections)}")
        return {}

    def compliance(self, sections):
        return np.zeros((2, len(sections), len(sections)))

    def view(self):
        return None


class StubRubble:
    """Pushes the sheet with as many newtons as it has been advanced windows, and a ``share`` of what it carries."""

    def __init__(self, trace, loss=0.0, share=0.0):
        self.trace, self.mass, self.cleared_mass, self.power, self.loss = trace, 0.0, 0.0, 0.0, loss
        self.windows, self.force, self.share, self.carried, self.budget = 0, 0.0, share, 0.0, {}
        self.energy, self.momenta = {}, {}

    def save(self):
        names = ("mass", "windows", "force")
        return partial(vars(self).update, {name: getattr(self, name) for name in names})

    def add(self, fragment):
        self.trace.append(f"born {fragment}")
        self.mass += 10.0 - self.loss
        return HandOver(1, 10.0, 0.0, 0.0)

    def sections_in_use(self):
        return [3] if self.mass else []

    def set_sheet(self, edges, carried, compliance):
        self.carried = carried.force.sum()
        self.trace.append(f"rubble sees sheet that carries {self.carried:g}")

    def advance(self, window_ns):
        self.windows += 1
        self.force = self.windows + self.share * self.carried
        self.trace.append(f"rubble +{window_ns}")

    def forces_on_sheet(self):
        return SheetForces(np.array([0]), np.array([[self.force, 0.0, 0.0]]))

    def events(self, t_ns, load):
        return []

    def load(self):
        return np.zeros((3, 3))

    def blocks(self):
        return BlockTable.empty()


def scheduler(trace, scheme="serial-explicit", *, loss=0.0, share=0.0):
    iteration = Iteration(tolerance=1e-9, floor=1.0)
    return Scheduler(StubSheet(trace), StubRubble(trace, loss, share), Ledger(100.0), 50, SCHEMES[scheme](iteration))


def test_serial_explicit_is_drawn_as():
    """The sheet under the last forces, then the rubble against the way that the sheet has gone.

    Of the first newton the running mean has taken in a fifth, of the rest the sheet is given half.
    """
    trace = []
    s = scheduler(trace)
    frames = [s.macro_step(), s.macro_step()]
    assert trace == [
        "sheet 0-50 under 0",
        "path for sections []",
        "rubble sees sheet that carries 0",
        "rubble +50",
        "sheet 50-100 under 0.6",
        "born piece",
        "path for sections [3]",
        "rubble sees sheet that carries 0.6",
        "rubble +50",
    ]
    assert [f.t_ns for f in frames] == [50, 100]
    np.testing.assert_array_equal(frames[0].load.sum(axis=0), [1.0, 0.0, 2.0])
    assert frames[1].ledger["mass_error"] == 0.0


def test_parallel_explicit_is_drawn_as():
    """The rubble's edge is the one before the sheet moves, with what it carried then; not where a piece is born."""
    trace = []
    s = scheduler(trace, "parallel-explicit")
    for _ in range(4):
        s.macro_step()
    assert trace == [
        "sheet 0-50 under 0",
        "path for sections []",
        "rubble sees sheet that carries 0",
        "rubble +50",
        "edge for sections []",
        "sheet 50-100 under 1",
        "born piece",
        "path for sections [3]",
        "rubble sees sheet that carries 1",
        "rubble +50",
        "edge for sections [3]",
        "sheet 100-150 under 2",
        "rubble sees sheet that carries 1",
        "rubble +50",
        "edge for sections [3]",
        "sheet 150-200 under 3",
        "rubble sees sheet that carries 2",
        "rubble +50",
    ]


def test_serial_implicit_is_drawn_as():
    """Passes of a window differ in the forces alone. The window of a hand-over is run once and drops all history."""
    trace = []
    s = scheduler(trace, "serial-implicit", share=0.5)  # the answer to F is n + F/2: they agree at 2 n
    frames = [s.macro_step() for _ in range(5)]

    def one_pass(begin, force, born=()):
        return [
            f"sheet {begin}-{begin + 50} under {force}",
            *born,
            f"path for sections {[3] if begin >= 50 else []}",
            f"rubble sees sheet that carries {force}",
            "rubble +50",
        ]

    assert trace == [
        *one_pass(0, 0),
        "set back",
        *one_pass(0, 1),
        "set back",
        *one_pass(0, 2),  # omega 1, then Aitken's 2
        *one_pass(50, 2, ["born piece"]),  # 2 + 2/2 = 3 is not 2: not repeated
        *one_pass(100, 3),
        "set back",
        *one_pass(100, 4.5),
        "set back",
        *one_pass(100, 6),  # neither 4 nor omega 2
        *one_pass(150, 6),
        "set back",
        *one_pass(150, 7),
        "set back",
        *one_pass(150, 8),  # omega at most 1 at first
        *one_pass(200, 10),  # predicted from 6 and 8
    ]
    assert [f.ledger["iterations"] for f in frames] == [3.0, 1.0, 3.0, 3.0, 1.0]
    assert frames[1].ledger["interface_residual"] == pytest.approx(1 / 3)
    assert frames[-1].ledger["mass_error"] == 0.0
    assert s.fragments == 1


def test_a_fragment_of_a_repeated_window_is_booked_once():
    s = scheduler([], "serial-implicit", share=0.5)
    start = s.save()
    s.t_ns = 50
    s.move_sheet(SheetForces.none())
    assert (s.fragments, s.ledger.handed_over_mass, s.sheet.mass) == (1, 10.0, 90.0)
    start()
    assert (s.fragments, s.ledger.handed_over_mass, s.sheet.mass, s.rubble.mass) == (0, 0.0, 100.0, 0.0)


def test_ice_that_gets_lost_stops_the_run():
    s = scheduler([], loss=1e-3)
    s.macro_step()
    with pytest.raises(SimulationError, match="balance of mass is off by 1e-05"):
        s.macro_step()


def test_momentum_that_gets_lost_stops_the_run():
    with pytest.raises(SimulationError, match="momentum of a hand-over"):
        Ledger(100.0).hand_over(50, HandOver(1, 10.0, 0.0, 1e-6))
