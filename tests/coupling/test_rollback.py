"""Participants set back to the start of a window go on with the bits of the first time, through failures and births."""

from copy import copy

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.scenario.loading import load_scenario

QUICK = ["sheet.nodes=[20, 20]", "drift.velocity='0.4 m/s'", "contact.strength='800 kPa'", "scenario.duration='10 s'"]


def picture(s, windows):
    """Everything that some windows show, as bytes."""
    out = []
    for _ in range(windows):
        f = s.macro_step()
        force, table = s.rubble.forces_on_sheet(), f.blocks
        arrays = (
            f.sheet.position,
            f.sheet.utilisation,
            f.sheet.intact,
            f.load,
            table.position,
            table.velocity,
            table.angle,
            table.load,
            force.nodes,
            force.force,
            np.array(list(f.ledger.values())),
        )
        out += [np.ascontiguousarray(a).tobytes() for a in arrays] + [repr(f.events).encode()]
    return b"".join(out)


def set_back(s, saved, t_ns):
    saved[0]()
    saved[3]()
    s.t_ns, s.jump, s.power = t_ns, saved[1], copy(saved[2])


def until(s, happens):
    """Runs to the start of the window in which something happens."""
    while True:
        saved, t_ns, before = (s.save(), s.jump, copy(s.power), s._scheme.save()), s.t_ns, s.fragments
        frame = s.macro_step()
        if happens(s, frame, before):
            return saved, t_ns, frame


@pytest.mark.parametrize("propagation", ["quasi-static", "dynamic"])
def test_a_window_with_failures_and_the_next_ones_are_repeated_bit_by_bit(propagation):
    with threadpool_limits(1):
        s = build(
            load_scenario(
                "van_vliet_2018_floe_55m_centre",
                [*QUICK, f"fracture.propagation='{propagation}'", "rubble.enabled=false"],
            )
        )
        saved, t_ns, first = until(s, lambda s, frame, _: bool(frame.events))
        runs = []
        for _ in range(3):
            set_back(s, saved, t_ns)
            runs.append(picture(s, 12))
        assert not s.sheet.sheet.intact.all()
        assert runs[0] == runs[1] == runs[2]
        assert runs[0].startswith(first.sheet.position.tobytes())  # as the first time
        for wrong in (0.0, 1e-12):
            set_back(s, saved, t_ns)
            s.macro_step()  # a long step that is given up here is solved anew, from where it began
            s.sheet.sheet.state.u[5, 0] += wrong
            runs.append(picture(s, 11))
        assert runs[-2] != runs[-1]  # a difference would be noticed


def test_births_collisions_and_windows_after_them_are_repeated_bit_by_bit():
    """From the window before the first hand-over, and from one in which blocks press on sheet and structure."""
    with threadpool_limits(1):
        s = build(load_scenario("van_vliet_2018_floe_55m_centre", QUICK))
        for happens in (
            lambda s, _, before: s.fragments > before,
            lambda s, _, before: len(s.rubble.forces_on_sheet().nodes) > 4,
        ):
            saved, t_ns, first = until(s, happens)
            runs = []
            for _ in range(3):
                set_back(s, saved, t_ns)
                runs.append(picture(s, 12))
            assert s.rubble.blocks().count >= 2
            assert s.rubble.load().any()
            assert runs[0] == runs[1] == runs[2]
            assert runs[0].startswith(first.sheet.position.tobytes())
            assert first.load.tobytes() in runs[0]
