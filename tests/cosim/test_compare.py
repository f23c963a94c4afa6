"""Features of a synthetic run whose values are known in closed form."""

import dataclasses
import math

import numpy as np
import pytest

from cosim.analysis import compare, features, peaks
from cosim.analysis.instants import first_contact
from cosim.analysis.reference import FeatureError, load_reference, parse_reference
from cosim.analysis.run_data import RunData
from cosim.recording.reader import read_run
from cosim.scenario.finding import find_scenarios
from coupling.interface import Event


@pytest.fixture(scope="module")
def run(run_file):
    return read_run(run_file)


def series(t, fx, events=()):
    """A run with one component of breaking load."""
    load = np.zeros((len(t), 3, 3))
    load[:, 0, 0] = fx
    return RunData(
        "x",
        {"window_ns": str(int(1e9 * (t[1] - t[0]))), "averaging_s": "0"},
        np.rint(t * 1e9).astype(int),
        load,
        tuple(events),
    )


def test_event_features(run, synthetic):
    at_split = synthetic.load(4.0).sum(axis=0)
    assert features.event_load(run, "split", "fx") == pytest.approx(at_split[0], rel=1e-12)
    assert features.event_load(run, "split", "f") == pytest.approx(np.linalg.norm(at_split), rel=1e-12)
    assert features.event_time(run, ["circumferential", "split"]) == pytest.approx(4.0, rel=1e-12)


def test_missing_features_are_none(run):
    assert features.event_load(run, "explosion") is None
    assert features.event_time(run, "explosion") is None
    assert features.build_up_time(run, "explosion") is None
    assert features.load_period(run, after="explosion") is None
    assert features.rubble_volume(dataclasses.replace(run, ledger={})) is None


def test_an_empty_run_has_no_features():
    empty = RunData("x", {"window_ns": "1", "averaging_s": "0"}, np.empty(0, int), np.empty((0, 3, 3)))
    assert features.peak_load(empty) is None
    assert features.peak_time(empty) is None
    assert first_contact(empty) is None
    assert peaks.peaks(empty)["fx"]["value"] is None


def test_times_count_from_first_contact():
    t = 0.1 * np.arange(1, 101)
    run = series(t, np.where(t > 2.05, t, 0.0))
    assert first_contact(run) == pytest.approx(2.0, rel=1e-9)
    assert features.peak_time(run) == pytest.approx(8.0, rel=1e-9)


@pytest.mark.parametrize("period", [0.7, 2.5, 6.0])
def test_period_of_cycles_on_a_trend(period):
    t = 0.05 * np.arange(1, 1001)
    run = series(t, 5.0 + 0.1 * t + np.sin(2 * math.pi * t / period))
    assert features.load_period(run) == pytest.approx(period, rel=0.02)


def test_windows_of_different_length_have_the_same_period_level_and_first_contact():
    t = np.sort(np.concatenate((0.1 * np.arange(1, 501), 0.1 * np.arange(300, 500) + 0.05)))
    swing = series(t, 5.0 + 0.1 * t + np.sin(2 * math.pi * t / 2.5))
    assert features.load_period(swing) == pytest.approx(2.5, rel=0.02)
    assert first_contact(series(t, np.where(t > 35.01, 1.0, 0.0))) == pytest.approx(35.0, rel=1e-9)
    broken = Event(round(20e9), "hand_over", (9.0, 0.0, 0.0), 3, (0.0, 0.0, 0.0), "")
    run = series(t, 0.0, [broken])
    run.load[:, 2, 0] = np.where(t < 40.01, 1.0, 3.0)  # sliding: half of the time 1, half of it 3
    run.load[:20, 0, 0] = 100.0
    assert features.level_between_peaks(run) == pytest.approx((1.0 * 20 + 3.0 * 10) / 30, rel=1e-9)


def test_a_steady_load_has_no_period():
    assert features.load_period(series(0.05 * np.arange(1, 101), np.full(100, 3.0))) is None


def test_level_between_peaks_is_the_sliding_level(synthetic, run):
    """Breaking swings to zero every 2.5 s; what is left there, late in the run, is sliding: 3 MN and little more."""
    level = features.level_between_peaks(run, "fx")
    assert 1.0e6 < level < 3.2e6


def test_build_up_ends_at_the_event_also_if_the_load_has_dropped_in_its_window():
    """The load of the event is the load before the break; the mean of the window of the break may be small."""
    t = 0.1 * np.arange(1, 101)
    broken = Event(round(5e9), "split", (5.0, 0.0, 0.0), 3, (0.0, 0.0, 0.0), "")
    run = series(t, np.where(t < 4.95, t, 0.0), [broken])
    assert features.build_up_time(run, "split") == pytest.approx(4.6, rel=1e-9)  # 0.4 is below a tenth of 5


def test_build_up_and_rubble(run):
    assert features.build_up_time(run, "circumferential") == pytest.approx(5.4, rel=0.02)
    assert features.rubble_volume(run) == pytest.approx(8.46e5 * 6 / 846, rel=1e-12)


@pytest.mark.parametrize(
    ("simulated", "value", "expected"),
    [
        (5.0, (10.0, 10.0), 0.5),
        (5.0, (4.0, 6.0), 1.0),
        (3.0, (4.0, 6.0), 0.75),
        (9.0, (4.0, 6.0), 1.5),
        (None, (4.0, 6.0), None),
        (3.0, None, None),
    ],
)
def test_ratio(simulated, value, expected):
    assert compare.ratio(simulated, value) == expected


def test_json_of_a_comparison(run):
    name, reference = compare.reference_of(run, None)
    content = compare.to_json(run, name, compare.compare(run, reference))
    assert set(content) == {"run", "reference", "remark", "features", "series", "peaks", "averaging_s"}
    assert content["series"] is None
    by_name = {f["name"]: f for f in content["features"]}
    first = by_name["circumferential_fx"]
    assert first["measured"] == 19e6
    assert first["thesis"] == 5.4e6
    assert first["ratio"] == pytest.approx(first["simulated"] / 19e6, rel=1e-12)
    level = by_name["level_between_peaks_fx"]
    assert (level["measured"], level["measured_range"]) == (6e6, [2e6, 10e6])
    assert all({"name", "simulated", "measured", "ratio", "source"} <= set(f) for f in content["features"])


def test_shipped_references_work_on_any_run(run):
    for folder in find_scenarios():
        if (folder / "reference.toml").is_file():
            assert compare.compare(run, load_reference(folder))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ('quantity = "event_lod"', "did you mean event_load?"),
        ('quantity = "event_load"\nevnt = "split"', "did you mean event?"),
        ('quantity = "event_load"', "event is missing"),
        ('quantity = "peak_load"\ncomponent = "fq"', "use one of fx, fy, fz, f"),
        ('quantity = "peak_load"\nmeasured = "3 m"', "wrong unit"),
        ('quantity = "peak_load"\nmeasured = 3', "unit"),
        ('quantity = "peak_load"\nmeasured = ["1 N", "2 N", "3 N"]', "pair"),
        ("", "quantity is missing"),
    ],
)
def test_faults_of_a_reference_are_one_line(change, says):
    text = f'[[feature]]\nname = "a"\nunit = "N"\nsource = "s"\n{change}\n'
    with pytest.raises(FeatureError) as error:
        parse_reference(text, "r.toml")
    assert says in str(error.value)
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("r.toml: ")


def test_a_run_without_reference_asks_for_one(run):
    with pytest.raises(FeatureError, match="name a reference file"):
        compare.reference_of(dataclasses.replace(run, texts={}), None)
