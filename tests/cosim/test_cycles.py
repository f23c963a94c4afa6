"""Features of loading cycles on runs whose answers are known in closed form."""

import dataclasses
import itertools

import numpy as np
import pytest

from cosim.analysis import cycles, features
from cosim.analysis.instants import encounters
from cosim.analysis.reference import parse_reference
from cosim.analysis.run_data import RunData
from cosim.recording import messages, reader
from cosim.recording.reader import read_run
from coupling.interface import NS, Event

DT = 0.05
PERIOD = 6.0


def saw(n=4, sliding=1e6, events=True, drop=1.0):
    """A load that grows from 1 s on to 5, 6, 7 ... MN every 6 s and drops at once, on a steady sliding load."""
    t = DT * np.arange(1, round((1.0 + PERIOD * n) / DT) + 1)
    cycle, phase = np.divmod(np.maximum(t - 1.0 - 1e-9, 0.0), PERIOD)
    load = np.zeros((len(t), 3, 3))
    load[:, 0, 0] = (5e6 + 1e6 * cycle) * (phase / PERIOD)
    load[:, 2, 0] = np.where(t > 1.0, sliding, 0.0)
    load[t <= 1.0 + 1e-9] = 0.0
    pieces = [
        Event(
            round((1.0 + PERIOD * (k + 1)) * NS),
            "circumferential",
            (0.0, 0.0, 0.0),
            3,
            (0.0, 0.0, 0.0),
            "",
            10.0 + k,
            100.0 * (1 + k),
        )
        for k in range(n)
        for _ in range(2)
    ]
    rubble, cleared = 3e5 * t, 1e5 * t
    return RunData(
        "x",
        {"window_ns": str(round(DT * NS))},
        np.rint(t * NS).astype(int),
        load,
        tuple(pieces) if events else (),
        {"rubble_mass": rubble, "cleared_mass": cleared},
    )


def test_encounters_go_from_drop_to_drop():
    """Two pieces of one drop are one encounter; the first begins with the first touch."""
    found = encounters(saw())
    assert len(found) == 4
    assert [round(DT * (e.event + 1), 6) for e in found] == [7.0, 13.0, 19.0, 25.0]
    assert found[0].begin == round(1.0 / DT)
    assert all(a.end + 1 == b.begin for a, b in itertools.pairwise(found))


@pytest.mark.parametrize(("at", "which"), [(7.4, 0), (13.4, 1), (19.4, 2)])
def test_pieces_that_follow_before_the_load_builds_up_belong_to_the_encounter(at, which):
    run = saw()
    late = Event(round(at * NS), "circumferential", (0.0, 0.0, 0.0), 3, (0.0, 0.0, 0.0), "", 1.0, 1.0)
    found = encounters(dataclasses.replace(run, events=(*run.events, late)))
    assert [round(DT * (e.event + 1), 6) for e in found] == [7.0, 13.0, 19.0, 25.0]
    without = encounters(run)
    assert [k for k in range(4) if found[k].end != without[k].end] == [which]
    assert found[which].end == round(at / DT) - 1


@pytest.mark.parametrize(("share", "counts"), [(0.4, False), (0.6, True)])
def test_a_build_up_to_less_than_half_of_the_first_is_no_encounter(share, counts):
    """It neither ends the one before nor begins the next, whose build-up it interrupts."""
    run = saw()
    second = (run.t > 7.0 + 1e-9) & (run.t <= 13.0 + 1e-9)
    run.load[second, 0, 0] *= share * 6.0 / 8.0  # of 6 MN and 1 MN of sliding load
    found = encounters(run)
    assert [round(DT * (e.event + 1), 6) for e in found] == [7.0, *[13.0] * counts, 19.0, 25.0]
    assert cycles.encounter_load(run, 2 + counts) == pytest.approx(8e6, rel=0.01)


@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_the_largest_load_of_each_encounter(n):
    run = saw()
    assert cycles.encounter_load(run, n) == pytest.approx(1e6 + (4e6 + 1e6 * n), rel=0.01)
    assert cycles.encounter_load(run, n, phase="sliding") == pytest.approx(1e6)
    assert cycles.encounter_time(run, n) == pytest.approx(PERIOD, abs=2 * DT)


def test_what_a_run_does_not_have_is_none():
    run, empty = saw(events=False), RunData("x", {"window_ns": "1"}, np.empty(0, int), np.empty((0, 3, 3)))
    for r in (run, empty):
        assert encounters(r) == []
        assert cycles.encounter_load(r) is None
        assert cycles.encounter_time(r) is None
        assert cycles.piece_length(r) is None
        assert cycles.piece_area(r) is None
        assert cycles.feed_rate(r, cycle=1) is None
        assert cycles.mean_load(r, after="split") is None
    assert cycles.largest_load(empty) is None
    assert cycles.cycle_period(empty) is None
    assert cycles.largest_load(run, begin=100.0) is None
    assert cycles.encounter_load(saw(), 5) is None
    assert cycles.encounter_load(saw(), 0) is None


def test_a_time_window_counts_from_first_contact():
    run = saw()
    assert cycles.largest_load(run, begin=0.0, end=3.0) == pytest.approx(1e6 + 2.5e6, rel=1e-6)
    assert cycles.largest_load(run) == features.peak_load(run)


def test_mean_load():
    run = saw(n=1, sliding=2e6)
    assert cycles.mean_load(run) == pytest.approx(2e6 + 2.5e6, rel=0.01)
    assert cycles.mean_load(run, phase="sliding") == pytest.approx(2e6, rel=1e-12)
    assert cycles.mean_load(saw(n=2), after="circumferential") == pytest.approx(1e6 + 3e6, rel=0.01)


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_period_of_a_saw(noise):
    """By its peaks, also with noise of a twentieth; the spectrum says the same."""
    run = saw(n=8)
    run.load[:, 0, 0] *= 1.0 + noise * np.random.default_rng(1).standard_normal(len(run.t))
    assert cycles.cycle_period(run) == pytest.approx(PERIOD, rel=0.02)
    assert features.load_period(run) == pytest.approx(PERIOD, rel=0.05)
    assert cycles.cycle_period(saw(n=2)) is None


def test_pieces():
    run = saw(n=2)
    assert cycles.piece_length(run) == pytest.approx((10.0 * 100 + 11.0 * 200) / 300)
    assert cycles.piece_area(run) == pytest.approx(150.0)


@pytest.mark.parametrize("cycle", [None, 1, 3])
def test_feed_and_clearing(cycle):
    assert cycles.feed_rate(saw(), cycle) == pytest.approx(4e5, rel=1e-9)
    assert cycles.clearing_rate(saw(), cycle) == pytest.approx(1e5, rel=1e-9)


def test_of_the_last_part_of_a_run():
    """Rubble that is cleared from half of the run on: rates and mean of the last quarter are not those of the run."""
    run = saw()
    t, half = run.t, 0.5 * run.t[-1]
    cleared = 4e5 * np.maximum(t - half, 0.0)
    run = dataclasses.replace(
        run,
        ledger={"rubble_mass": 4e5 * t - cleared, "cleared_mass": cleared},
        metadata={**run.metadata, "ice_density": "800.0"},
    )
    assert cycles.clearing_rate(run, last=0.25) == pytest.approx(4e5, rel=1e-9)
    assert cycles.clearing_rate(run) == pytest.approx(2e5, rel=0.01)
    assert cycles.feed_rate(run, last=0.25) == pytest.approx(4e5, rel=1e-9)
    assert cycles.rubble_mean(run, last=0.25) == pytest.approx(4e5 * half / 800.0, rel=1e-9)
    assert cycles.rubble_mean(run) == pytest.approx(0.75 * 4e5 * half / 800.0, rel=0.01)
    assert cycles.rubble_mean(dataclasses.replace(run, ledger={})) is None


def test_a_reference_may_name_them():
    text = '[[feature]]\nname = "a"\nunit = "N"\nsource = "s"\nquantity = "encounter_load"\nn = 2\ncomponent = "fx"\n'
    (feature,) = parse_reference(text, "r.toml").features
    assert features.QUANTITIES[feature.quantity](saw(), **feature.arguments) == pytest.approx(7e6, rel=0.01)


def test_phases_add_up_to_the_total_at_every_sample(run_file):
    """The recorded totals are the sums of the recorded phases, to 1e-9."""
    run, totals = read_run(run_file), []
    for _, _, data in reader.messages(run_file, ["/load/structure"]):
        message = messages.Load.FromString(data)
        totals.append((message.fx, message.fy, message.fz))
    assert np.array(totals) == pytest.approx(run.load.sum(axis=1), rel=1e-9)
    assert len(totals) == len(run.t)


def test_a_structure_that_is_pressed_down_has_its_largest_load_below_zero():
    run = saw()
    load = run.load.copy()
    load[:, 0, 2] = -load[:, 0, 0]
    up = dataclasses.replace(run, load=load)
    assert cycles.encounter_load(up, 2, component="fz") == pytest.approx(-load[:, 0, 0][:260].max(), rel=0.02)
    assert cycles.largest_load(up, "fz") == load[:, 0, 2].min()
