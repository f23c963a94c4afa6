"""A run is written and read back; a killed one is recovered; the bits depend on the scenario alone."""

import json
from pathlib import Path

import numpy as np
import pytest

from cosim.recording.reader import RecordingError, messages, read_run
from cosim.recording.records import Records
from cosim.recording.recover import recover
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario

CASE = "van_vliet_2018_floe_55m_centre"
WINDOWS = 240  # 12 s of 50 ms


def test_round_trip(run_file, synthetic):
    run = read_run(run_file)
    assert len(run.t_ns) == WINDOWS
    assert run.t_ns[-1] == 12 * 10**9
    expected = np.array([synthetic.load(t) for t in run.t])
    assert np.array_equal(run.load, expected)
    assert [(e.kind, e.t_ns, e.cells) for e in run.events] == [
        ("split", 4 * 10**9, 24),
        ("circumferential", 6 * 10**9, 31),
        ("hand_over", 6 * 10**9, 0),
    ]
    assert run.events[0].force == pytest.approx(tuple(synthetic.load(4.0).sum(axis=0)), rel=1e-15)
    assert np.array_equal(run.ledger["energy_residual"], 2.0 * run.t)


def test_components(run_file):
    run = read_run(run_file)
    assert np.allclose(run.component("fx"), run.load[:, :, 0].sum(axis=1), rtol=1e-15)
    assert np.allclose(run.component("f", "sliding"), np.linalg.norm(run.load[:, 2], axis=1), rtol=1e-15)


def test_scenario_and_run_data_travel_along(run_file, tmp_path):
    run = read_run(run_file)
    copy = tmp_path / "copy.toml"
    copy.write_text(run.texts["scenario.toml"])
    original = load_scenario("van_vliet_2018_floe_165m", run.overrides)
    assert load_scenario(copy).model == original.model
    assert run.texts["scenario.as-written.toml"] == original.text
    assert "feature" in run.texts["reference.toml"]
    assert (run.metadata["seed"], run.metadata["nodes"]) == ("2018", "[40, 40]")


def test_the_lights_of_a_run_stand_last(tmp_path, cosim):
    from mcap.records import Metadata

    out = tmp_path / "r.mcap"
    options = ("scenario.duration='200 ms'", "sheet.nodes=[12,12]", "rubble.enabled=false")
    code, told, _ = cosim("run", CASE, "-o", out, "--json", "-q", *(f"--set={o}" for o in options))
    assert code == 0
    last = [r for r in Records(out) if isinstance(r, Metadata)][-1]
    assert json.loads(last.metadata["lights"]) == json.loads(told)["trust"]
    assert read_run(out).ended == "complete"


def test_pictures_come_every_so_often_and_at_events(run_file):
    times = {topic: [t for _, t, _ in messages(run_file, [topic])] for topic in ("/ice/sheet", "/view/sheet", "/tf")}
    half_seconds = {k * 5 * 10**8 for k in range(1, 25)}
    assert half_seconds | {5 * 10**7} == set(times["/ice/sheet"])
    assert set(times["/view/sheet"]) <= set(times["/ice/sheet"])
    assert times["/tf"] == [0]


def test_pictures_come_at_the_first_window_past_their_time(synthetic, tmp_path):
    """Windows that are steered need not end at whole multiples of recording.every."""
    scenario = load_scenario("van_vliet_2018_floe_165m", ["scenario.duration='3 s'", "sheet.nodes=[40,40]"])
    frames = [f for k, f in enumerate(synthetic.frames(scenario)) if k % 3 == 2]  # 150 ms
    with Recorder(tmp_path / "run.mcap") as recorder:
        recorder.on_start(synthetic.run_info(scenario))
        for frame in frames:
            recorder.on_frame(frame)
    times = [t // 10**6 for _, t, _ in messages(tmp_path / "run.mcap", ["/ice/sheet"])]
    assert times == [600, 1050, 1500, 2100, 2550, 3000]


def test_same_scenario_same_bits(run_file, record, tmp_path):
    again = record(tmp_path / "elsewhere.mcap")
    assert again.read_bytes() == run_file.read_bytes()


def test_another_seed_gives_other_bits(run_file, record, tmp_path):
    other = record(tmp_path / "other.mcap", ("scenario.duration='12 s'", "sheet.nodes=[40,40]", "scenario.seed=1"))
    assert other.read_bytes() != run_file.read_bytes()


def test_nothing_of_the_machine_is_written(run_file):
    data = run_file.read_bytes()
    assert str(Path.cwd()).encode() not in data
    assert str(run_file.parent).encode() not in data


@pytest.fixture
def truncated(run_file, tmp_path):
    def cut(share):
        """At a share of what the run wrote; a summary follows, and after it its place, in the footer."""
        data = run_file.read_bytes()
        written = int.from_bytes(data[-28:-20], "little")
        path = tmp_path / "killed.mcap"
        path.write_bytes(data[: int(written * share)])
        return path

    return cut


@pytest.mark.parametrize("share", [0.3, 0.6, 0.9])
def test_a_truncated_recording_is_read_and_says_what_is_missing(truncated, run_file, tmp_path, share):
    path = truncated(share)
    run, whole = read_run(path), read_run(run_file)
    n = len(run.t_ns)
    assert n > 0.5 * share * WINDOWS
    assert np.array_equal(run.load, whole.load[:n])
    assert run.cut
    assert run.remark.startswith(
        f"killed.mcap is truncated (its run goes on, was killed, or the copy is not whole): it "
        f"holds {run.t[-1]:g} of 12 s"
    )
    rescued = recover(path, tmp_path / "clean.mcap")
    clean = read_run(tmp_path / "clean.mcap")
    assert len(clean.t_ns) == len(rescued.t_ns) == n
    assert not clean.cut
    assert (
        clean.remark
        == f"clean.mcap is of a run that did not reach its end: its end is missing; it holds {run.t[-1]:g} of 12 s"
    )
    assert clean.metadata == whole.metadata
    assert clean.texts == whole.texts
    assert list(messages(tmp_path / "clean.mcap", ["/ice/sheet"])) == list(messages(path, ["/ice/sheet"]))
    assert (whole.remark, whole.ended) == ("", "complete")


def test_every_byte_that_is_missing_is_noticed(run_file, tmp_path):
    data = run_file.read_bytes()
    for missing in (1, 9, 200):
        (tmp_path / "short.mcap").write_bytes(data[:-missing])
        run = read_run(tmp_path / "short.mcap")
        assert "truncated" in run.remark
        assert len(run.t_ns) == WINDOWS
    (tmp_path / "long.mcap").write_bytes(data + b"x")
    assert read_run(tmp_path / "long.mcap").cut


def test_a_flipped_byte_is_noticed(run_file, tmp_path):
    data = bytearray(run_file.read_bytes())
    data[len(data) // 2] ^= 0xFF
    (tmp_path / "flipped.mcap").write_bytes(data)
    with pytest.raises(RecordingError, match="damaged"):
        read_run(tmp_path / "flipped.mcap")


def test_nothing_to_recover(truncated, tmp_path):
    for share in (0.0005, 0.001, 0.01):
        with pytest.raises(RecordingError, match=r"not a recording of cosim|holds no data|not an MCAP"):
            recover(truncated(share), tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()


def test_recovery_does_not_overwrite_its_source(run_file, cosim):
    before = run_file.read_bytes()
    code, out, err = cosim("recover", run_file, "-o", run_file, "--force")
    assert (code, out) == (2, "")
    assert "does not overwrite its source" in err
    assert run_file.read_bytes() == before


def test_foreign_files(tmp_path):
    foreign = tmp_path / "x.mcap"
    foreign.write_text("hello, this is text")
    with pytest.raises(RecordingError, match="not an MCAP recording"):
        read_run(foreign)
    with pytest.raises(RecordingError, match="no such recording"):
        read_run(tmp_path / "none.mcap")


def test_a_run_that_stops_early_is_a_complete_file(record, tmp_path):
    run = read_run(record(tmp_path / "short.mcap", stop_after=7))
    assert len(run.t_ns) == 7


def test_versions_of_libraries_are_those_of_their_metadata():
    from importlib import metadata

    from cosim import provenance

    found = provenance.libraries()
    assert {name: found[name] for name in provenance.LIBRARIES} == {
        n: metadata.version(n) for n in provenance.LIBRARIES
    }
    assert provenance.version() == metadata.version("brash-ice")
