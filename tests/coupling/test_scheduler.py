"""The macro step as a drawing: who ran when, with what."""

import numpy as np
import pytest

from coupling.interface import BlockTable, SheetForces, SimulationError
from coupling.ledger import Ledger
from coupling.rubble_port import HandOver
from coupling.scheduler import Scheduler
from coupling.schemes import SCHEMES
from coupling.sheet_port import SheetReport


class StubSheet:
    """Breaks off a piece of 10 kg in its second window."""

    def __init__(self, trace):
        self.trace, self.mass, self.crushed, self.energy = trace, 100.0, 0.0, {}

    def advance(self, t_ns, window_ns, rubble, rubble_load):
        self.trace.append(f"sheet {t_ns}-{t_ns + window_ns} under {rubble.force.sum():g}")
        fragments = ["piece"] if t_ns == window_ns else []
        self.mass -= 10.0 * len(fragments)
        return SheetReport(np.array([1.0, 0.0, 2.0]), fragments, [])

    def edges(self, sections):
        self.trace.append(f"edge for sections {list(sections)}")
        return {}

    def view(self):
        return None


class StubRubble:
    """Pushes the sheet with as many newtons as it has been advanced windows."""

    def __init__(self, trace, loss=0.0):
        self.trace, self.mass, self.cleared_mass, self.windows, self.loss = trace, 0.0, 0.0, 0, loss

    def add(self, fragment):
        self.trace.append(f"born {fragment}")
        self.mass += 10.0 - self.loss
        return HandOver(1, 10.0, 0.0, 0.0)

    def sections_in_use(self):
        return [3] if self.mass else []

    def set_sheet(self, edges):
        self.trace.append("rubble sees sheet")

    def advance(self, window_ns):
        self.windows += 1
        self.trace.append(f"rubble +{window_ns}")

    def forces_on_sheet(self):
        return SheetForces(np.array([0]), np.full((1, 3), self.windows / 3.0))

    def load(self):
        return np.zeros((3, 3))

    def blocks(self):
        return BlockTable.empty()


def scheduler(trace, loss=0.0):
    return Scheduler(StubSheet(trace), StubRubble(trace, loss), Ledger(100.0), 50, SCHEMES["serial-explicit"])


def test_serial_explicit_is_drawn_as():
    trace = []
    s = scheduler(trace)
    frames = [s.macro_step(), s.macro_step()]
    assert trace == [
        "sheet 0-50 under 0", "edge for sections []", "rubble sees sheet", "rubble +50",
        "sheet 50-100 under 1", "born piece", "edge for sections [3]", "rubble sees sheet", "rubble +50",
    ]
    assert [f.t_ns for f in frames] == [50, 100]
    np.testing.assert_array_equal(frames[0].load.sum(axis=0), [1.0, 0.0, 2.0])
    assert frames[1].ledger["mass_error"] == 0.0


def test_ice_that_gets_lost_stops_the_run():
    s = scheduler([], loss=1e-3)
    s.macro_step()
    with pytest.raises(SimulationError, match="balance of mass is off by 1e-05"):
        s.macro_step()


def test_momentum_that_gets_lost_stops_the_run():
    with pytest.raises(SimulationError, match="momentum of a hand-over"):
        Ledger(100.0).hand_over(50, 10.0, 0.0, 1e-6)
