"""A mass that ice presses on by a spring, window by window: order of the scheme, power over the interface, twins."""

from types import SimpleNamespace

import numpy as np
import pytest

from coupling.interface import NS, Path, SheetReport, SimulationError
from coupling.moving import WithStructure
from coupling.structure.motion import Prescribed, spring

MASS, CONTACT, SPEED, END = 1e6, 2e7, 0.1, 2.0
OMEGA = np.sqrt(CONTACT / MASS)


def ice_on(path, count):
    """A scheme: ice that presses with k (v t - d), d the way of the structure as it sees it; the mean of a window."""

    def window(s):
        middle = (s.t_ns + 0.5 * s.window_ns) / NS
        load = CONTACT * (SPEED * middle - path.at(middle)[0])
        count.append(s.t_ns)
        return SheetReport(load=np.array([load, 0.0, 0.0]), wrench=np.array([load, 0.0, 0.0, 0.0, 0.0, 0.0]))

    return window


def ice_that_jumps(every):
    """The same, a third harder in every other depth of contact: the load of a window jumps with the way it sees."""

    def ice(path, count):
        smooth = ice_on(path, count)

        def window(s):
            report, end = smooth(s), (s.t_ns + s.window_ns) / NS
            harder = 1.0 + 0.3 * (np.floor((SPEED * end - path.at(end)[0]) / every) % 2.0)
            return SheetReport(load=harder * report.load, wrench=harder * report.wrench)

        return window

    return ice


def system(windows):
    nothing = SimpleNamespace(on_structure=np.zeros(6), set_structure=lambda place, velocity: None)
    return SimpleNamespace(
        t_ns=0, window_ns=round(END * NS) // windows, rubble=nothing, notes={}, motion=None, save=lambda: lambda: None
    )


def run(windows, repeats=0, make=WithStructure, ice=ice_on):
    """Displacement and velocity at the end, the ledger, and how often the ice has gone through a window."""
    path, s, count = Path(), system(windows), []
    motion = spring([0], np.diag([MASS]), np.zeros((1, 1)), np.zeros((1, 1)))
    scheme = make(ice(path, count), motion, path, repeats)
    for _ in range(windows):
        scheme(s)
        s.t_ns += s.window_ns
    return np.array([motion.displacement[0], motion.velocity[0]]), s.notes, len(count)


def error(windows, **how):
    """Against d = v t - v / w sin(w t), d' = v (1 - cos(w t)); the velocity in units of w d."""
    exact = SPEED * np.array([END - np.sin(OMEGA * END) / OMEGA, 1.0 - np.cos(OMEGA * END)])
    return np.linalg.norm((run(windows, **how)[0] - exact) / [1.0, OMEGA])


@pytest.mark.parametrize("repeats", [0, 3])
def test_order_is_two(repeats):
    errors = np.array([error(n, repeats=repeats) for n in (80, 160, 320)])
    assert (np.abs(np.log2(errors[:-1] / errors[1:]) - 2.0) < 0.2).all(), errors


class Late(WithStructure):
    """Twin: the structure is moved on by the load of the window before, as a plain exchange would."""

    def __call__(self, s):
        before, advance = self._load, self.motion.advance
        self.motion.advance = lambda t, window, load: advance(t, window, before)
        report = super().__call__(s)
        self.motion.advance = advance
        return report


def test_a_load_that_comes_a_window_late_is_of_first_order():
    errors = np.array([error(n, make=Late) for n in (80, 160, 320)])
    assert (np.abs(np.log2(errors[:-1] / errors[1:]) - 1.0) < 0.2).all(), errors


def test_power_over_the_interface():
    """Falls with every repeat by k T^2 / 2 m; three close it to 1e-6. What the structure receives it has."""
    lost = []
    for repeats in range(4):
        _, books, _ = run(100, repeats=repeats)
        lost.append(abs(books["structure_interface_lost"]) / books["structure_interface_exchanged"])
        assert abs(books["structure_energy_residual"]) < 1e-10 * books["structure_interface_exchanged"]
    factor = CONTACT * (END / 100) ** 2 / (4.0 * MASS)  # of a load that is the mean over a chord
    assert lost[0] > 1e-4
    assert lost[3] < 1e-6
    assert np.array(lost[1:3]) / lost[:2] == pytest.approx(factor, rel=0.5)


class Sudden(WithStructure):
    """Twin: to the ice the structure jumps between windows, from where it was expected to where it has got."""

    def __call__(self, s):
        self._ahead = np.zeros(6)
        return super().__call__(s)


@pytest.mark.parametrize("repeats", [6, 7])
def test_where_loads_jump_the_way_that_ice_sees_goes_on(repeats):
    """No repeat ends such a window: two ways lead to each other's load. What one misses the next goes after."""

    def lost(make):
        books = [run(100, repeats, make, ice_that_jumps(every))[1] for every in np.linspace(5e-4, 1.5e-3, 11)]
        return sum(abs(b["structure_interface_lost"]) / b["structure_interface_exchanged"] for b in books)

    assert lost(Sudden) > 1e-4
    assert lost(WithStructure) < 0.5 * lost(Sudden)


def test_a_window_is_not_repeated_where_nothing_is_missed():
    path, s, count = Path(), system(10), []
    scheme = WithStructure(ice_on(path, count), Prescribed.steady(np.array([-SPEED, 0, 0, 0, 0, 0]), END), path, 5)
    for _ in range(10):
        scheme(s)
        s.t_ns += s.window_ns
    assert len(count) == 10
    assert abs(s.notes["structure_interface_lost"]) < 1e-12 * s.notes["structure_interface_exchanged"]
    assert s.notes["structure_drive_work"] > 0.0
    assert s.motion[0] == pytest.approx([-SPEED * END, 0, 0, 0, 0, 0])
    with pytest.raises(SimulationError, match=r"t = 2.000 s: the prescribed motion of the structure ends at 2 s"):
        scheme(s)
