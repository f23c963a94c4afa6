"""Nothing is destroyed: inputs, recordings and foreign files stay, what is written appears whole or not at all."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from cosim.errors import FailedError, InputError
from cosim.outputs import grow, rewrite, whole, writable
from cosim.recording.reader import read_run
from cosim.recording.writer import CHUNK_NS, Recorder
from cosim.scenario.loading import load_scenario
from cosim.signals import StoppedError
from cosim.study.sweep import row_of, with_ratios

FLOE = "van_vliet_2018_floe_165m"
SCENARIO = Path(__file__).parents[2] / "scenarios" / FLOE / "scenario.toml"


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "s.toml"
    path.write_bytes(SCENARIO.read_bytes())
    return path


@pytest.fixture
def recording(run_file, tmp_path):
    path = tmp_path / "y.mcap"
    path.write_bytes(run_file.read_bytes())
    return path


def ways(path):
    """Names of the same file: its own, a link, a hard link, a way round."""
    link, hard = path.with_name(f"link{path.suffix}"), path.with_name(f"hard{path.suffix}")
    link.symlink_to(path)
    os.link(path, hard)
    return [path, link, hard, path.parent / "." / ".." / path.parent.name / path.name]


@pytest.mark.parametrize(
    "command",
    [
        ("report", "{recording}", "-o", "{itself}"),
        ("replay", "{recording}", "--save", "{itself}"),
        ("replay", "{recording}", "--screenshot", "{itself}"),
        ("replay", "{recording}", "--video", "{itself}"),
        ("recover", "{recording}", "-o", "{itself}"),
        ("recover", "{recording}", "-o", "{itself}", "--force"),
    ],
    ids=" ".join,
)
def test_no_command_writes_over_the_recording_that_it_reads(cosim, recording, command):
    before = recording.read_bytes()
    for name in ways(recording):
        code, out, err = cosim(*(part.format(recording=recording, itself=name) for part in command))
        assert (code, out, err.count("\n")) == (2, "", 1), err
        assert "does not overwrite its source" in err
        assert recording.read_bytes() == before


@pytest.mark.parametrize(
    "command",
    [
        ("run", "{case}", "-o", "{itself}"),
        ("run", "{case}", "-o", "{itself}", "--force"),
        ("run", "{case}", "--ice", "{itself}"),
        ("fmu", "{case}", "-o", "{itself}"),
        ("fmu", "{case}", "-o", "{itself}", "--force"),
        ("sweep", "{case}", "--vary", "ice.thickness=1 m", "-o", "{itself}"),
        ("sweep", "{case}", "--vary", "ice.thickness=1 m", "--plot", "{itself}"),
        ("report", "{recording}", "-o", "{itself}"),
        ("replay", "{recording}", "--save", "{itself}"),
    ],
    ids=" ".join,
)
def test_no_command_writes_over_a_scenario(cosim, case, recording, command):
    before = case.read_bytes()
    for name in ways(case):
        code, out, err = cosim(*(part.format(case=case, recording=recording, itself=name) for part in command))
        assert (code, out, err.count("\n")) == (2, "", 1), err
        assert "it is not written over" in err
        assert case.read_bytes() == before


def test_a_copy_at_another_scale_is_no_file_that_is_there(cosim, case):
    before = case.read_bytes()
    for name in ways(case):
        code, out, err = cosim("scale", case, "1/4", "-o", name)
        assert (code, out, err.count("\n")) == (2, "", 1), err
        assert "is there already and is kept" in err
        assert case.read_bytes() == before


@pytest.mark.parametrize(
    ("key", "file", "command"),
    [
        ("sheet.broken", "ice.mcap", ("run", "-o")),
        ("sheet.broken", "ice.csv", ("run", "--ice")),
        ("ice.thickness_field.file", "ice.csv", ("run", "--ice")),
        ("structure.motion.file", "tower.fmu", ("fmu", "-o")),
    ],
)
def test_no_command_writes_over_a_file_that_the_scenario_names(cosim, run_file, tmp_path, key, file, command):
    """Each is of the kind that would be written in its place, and even force does not destroy it."""
    starts = {".csv": b'"x","y","what"\n1,1,"crack"\n', ".fmu": b"PK\x03\x04", ".mcap": run_file.read_bytes()}
    path = tmp_path / file
    path.write_bytes(starts[path.suffix])
    before, (name, option) = path.read_bytes(), command
    given = [f"--set={key}='{path}'", *(["--set=structure.motion.kind=fmu"] if file == "tower.fmu" else [])]
    for way in ways(path):
        for force in ([], ["--force"]):
            code, out, err = cosim(name, FLOE, *given, option, way, *force)
            assert (code, out, err.splitlines()[-1].startswith("cosim: ")) == (2, "", True), err
            assert "does not overwrite its source" in err
            assert path.read_bytes() == before


def test_a_recorder_keeps_what_its_run_reads(run_file, tmp_path, synthetic):
    """Also where no command line has looked at its place."""
    path = tmp_path / "ice.mcap"
    path.write_bytes(run_file.read_bytes())
    scenario = load_scenario(FLOE, [f"sheet.broken='{path}'"])
    with pytest.raises(InputError, match="does not overwrite its source"):
        Recorder(path, force=True).on_start(synthetic.run_info(scenario))
    assert path.read_bytes() == run_file.read_bytes()


def test_recordings_of_another_sweep_are_kept(cosim, case, recording, monkeypatch, tmp_path):
    folder = tmp_path / "r"
    folder.mkdir()
    kept = folder / "variant_00001.mcap"
    recording.rename(kept)
    before = kept.read_bytes()
    monkeypatch.setattr("cosim.study.command.sweep", lambda s, variants, r, done, k: quick(variants, done))
    given = ("sweep", case, "--vary", "ice.thickness=1 m", "--recordings", folder)
    code, out, err = cosim(*given, "-o", tmp_path / "t.csv")
    assert (code, out, err.count("\n")) == (2, "", 1), err
    assert f"{kept}: exists and is kept" in err
    assert not (tmp_path / "t.csv").exists()
    assert kept.read_bytes() == before
    assert cosim(*given, "--keep", "0")[0] == 0
    assert cosim(*given, "-o", tmp_path / "t.parquet", "--resume")[0] == 0  # it goes on with its own


def test_an_existing_recording_is_kept_unless_force(cosim, case, recording):
    before = recording.read_bytes()
    code, _, err = cosim("run", case, "-o", recording)
    assert code == 2
    assert "exists and is kept; name another file, or give --force" in err
    assert cosim("recover", recording, "-o", recording.with_name("y.recovered.mcap"))[0] == 0
    assert cosim("recover", recording)[0] == 2
    assert cosim("recover", recording, "--force")[0] == 0
    assert recording.read_bytes() == before
    for kind in (".rrd", ".png", ".html"):  # what can be drawn again does not replace what was simulated
        with pytest.raises(InputError, match=f"is no {kind} file"):
            writable(recording, kind, force=True)


def test_places_that_cannot_be_written_are_one_line(cosim, case, recording, tmp_path, monkeypatch):
    for target, says in [
        (tmp_path, "is a folder"),
        (tmp_path / "no" / "x", "no such folder"),
        (case / "x", "no such folder"),
    ]:
        for command in (("run", case, "-o"), ("report", recording, "-o"), ("replay", recording, "--save")):
            code, out, err = cosim(*command, target)
            assert (code, out, err.count("\n")) == (2, "", 1)
            assert f"{target}: " in err
            assert says in err
    real = os.access  # root may write to all folders: this one is made read-only here
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path and real(path, mode))
    code, _, err = cosim("report", recording, "-o", tmp_path / "r.html")
    assert (code, f"{tmp_path / 'r.html'}: no permission" in err) == (2, True)


def test_a_link_to_itself_is_one_line(cosim, recording, tmp_path):
    (tmp_path / "loop.html").symlink_to(tmp_path / "loop.html")
    code, _, err = cosim("report", recording, "-o", tmp_path / "loop.html")
    assert (code, err.count("\n")) == (2, 1)
    assert "loop.html" in err


def test_a_page_appears_whole_or_not_at_all(tmp_path):
    page = tmp_path / "r.html"
    page.write_text("<!doctype html> old")

    def half():
        with whole(page, ".html") as part:
            part.write_text("<!doctype html> half")
            assert page.read_text() == "<!doctype html> old"
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        half()
    assert page.read_text() == "<!doctype html> old"
    with whole(page, ".html") as part:
        part.write_text("<!doctype html> new")
    assert page.read_text() == "<!doctype html> new"
    assert list(tmp_path.iterdir()) == [page]


def test_a_link_is_followed_and_stays_a_link(tmp_path):
    target, link = tmp_path / "real.html", tmp_path / "link.html"
    target.write_text("<!doctype html> old")
    link.symlink_to(target)
    with whole(link, ".html") as part:
        part.write_text("<!doctype html> new")
    assert link.is_symlink()
    assert target.read_text() == "<!doctype html> new"


def test_the_second_of_two_writers_is_refused(synthetic, tmp_path):
    path = tmp_path / "run.mcap"
    info = synthetic.run_info(load_scenario(FLOE, ["scenario.duration='1 s'", "sheet.nodes=[40,40]"]))
    with Recorder(path) as first:
        first.on_start(info)
        with pytest.raises(InputError, match="exists and is kept"):
            Recorder(path).on_start(info)
        with pytest.raises(InputError, match="being written by another program"):
            Recorder(path, force=True).on_start(info)
        for frame in synthetic.frames(info.scenario):
            first.on_frame(frame)
    assert len(read_run(path).t_ns) == 20
    page = tmp_path / "r.html"
    with whole(page, ".html") as part:
        part.write_text("<!doctype html> first")
        with pytest.raises(InputError, match="being written"), whole(page, ".html"):
            pytest.fail("two writers")
    assert page.read_text() == "<!doctype html> first"
    (tmp_path / ".r.part.html").write_text("left by a killed program")
    with whole(page, ".html") as part:
        part.write_text("<!doctype html> second")
    assert page.read_text() == "<!doctype html> second"


FULL = Path("/dev/full")
needs_full = pytest.mark.skipif(not FULL.exists(), reason="no /dev/full on this machine")


@needs_full
def test_a_full_disk_is_one_line_that_names_the_file(cosim, recording, tmp_path):
    for name, command in [
        ("full.html", ("report", recording, "-o")),
        ("full.mcap", ("recover", recording, "-o")),
    ]:
        link = tmp_path / name
        link.symlink_to(FULL)
        code, out, err = cosim(*command, link, *(("--force",) if command[0] == "recover" else ()))
        assert (code, out, err) == (
            1,
            "",
            f"cosim: {link}: No space left on device; free space or write elsewhere\n",
        )
    assert FULL.is_char_device()
    done = shell(f"ulimit -f 50; cosim replay {recording} --save {tmp_path / 'x.rrd'}")
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)
    assert done.stderr.startswith(f"cosim: {tmp_path / 'x.rrd'}: ")
    assert done.stderr.endswith("; free space or write elsewhere\n")
    assert list(tmp_path.glob("*x*.rrd")) == []


@needs_full
def test_a_recording_on_a_full_disk_stops_the_run(synthetic):
    recorder = Recorder(FULL, force=True)
    info = synthetic.run_info(load_scenario(FLOE, ["scenario.duration='1 s'", "sheet.nodes=[40,40]"]))
    with pytest.raises(FailedError, match=r"/dev/full: No space left on device; free space"):
        recorder.on_start(info)
    recorder.on_close()  # nothing is left to be closed


LIMITED = """
import resource, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import synthetic
from cosim.errors import FailedError
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.signals import StoppedError

resource.setrlimit(resource.RLIMIT_FSIZE, (250_000, 250_000))
scenario = load_scenario("van_vliet_2018_floe_165m", ["scenario.duration='12 s'", "sheet.nodes=[40,40]"])
recorder, seen = Recorder(sys.argv[2]), 0
try:
    recorder.on_start(synthetic.run_info(scenario))
    for frame in synthetic.frames(scenario):
        recorder.on_frame(frame)
        seen += 1
except FailedError as error:
    print(seen, error)
recorder.on_close()
"""


def test_what_was_recorded_before_the_disk_was_full_can_be_read(tmp_path):
    path = tmp_path / "run.mcap"
    command = [sys.executable, "-c", LIMITED, str(Path(__file__).parent), str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    seen, _, line = done.stdout.partition(" ")
    assert (done.returncode, done.stderr) == (0, "")
    assert line == f"{path}: File too large; free space or write elsewhere\n"
    run = read_run(path)
    assert run.cut
    assert int(seen) > 10
    assert 0 <= int(seen) - len(run.t_ns) < CHUNK_NS // 50_000_000  # windows of 50 ms that were not flushed yet


def shell(line, **kwargs):
    command = line.replace("cosim ", f"{sys.executable} -m cosim ")
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True, timeout=60, **kwargs)


def test_output_that_takes_no_more_is_one_line():
    done = shell("cosim list --json >/dev/full")
    assert (done.returncode, done.stderr.count("\n")) == (1, 1)
    assert done.stderr.startswith("cosim: standard output: No space left on device")
    for line in ("list --json", "--help"):
        done = shell(f"{{ sleep 1; cosim {line}; echo $? >&2; }} | true")
        assert done.stderr == "cosim: standard output: closed by its reader\n1\n"


def test_a_table_grows_and_holds_what_is_there(tmp_path):
    path = tmp_path / "t.csv"
    with grow(path, ".csv") as file:
        rewrite(file, b"variant,1\nlong line\n")
        assert path.read_bytes() == b"variant,1\nlong line\n"
        rewrite(file, b"variant,2\n")
        assert path.read_bytes() == b"variant,2\n"
        with pytest.raises(InputError, match="being written"):
            grow(path, ".csv", force=True)
    with pytest.raises(InputError, match="exists and is kept"):
        grow(path, ".csv")


def test_a_recording_without_a_window_does_not_stay(synthetic, tmp_path):
    path = tmp_path / "run.mcap"
    with Recorder(path) as recorder:
        recorder.on_start(synthetic.run_info(load_scenario(FLOE, ["scenario.duration='1 s'", "sheet.nodes=[40,40]"])))
        assert path.exists()
    assert not path.exists()


def quick(variants, done, error=None):
    """A sweep whose variants end at once, or with an error after the first."""
    load = {f"{c}_peak": 1e6 for c in ("fx", "fz", "f")} | {f"{c}_time": 1.0 for c in ("fx", "fz", "f")}
    phases = {f"{p}_fx_peak": 1.0 for p in ("breaking", "rotating", "sliding")}
    rows = []
    for k, variant in enumerate(variants):
        values = {**load, **phases, "fx_mean": 1.0, "wall_s": 1.0, "simulated_s": 2.0}
        rows.append(row_of(k, variant, values | {"averaging_s": 0.5, "not_trustworthy": ""}))
        done(rows[-1])
        if error:
            raise error
    return with_ratios(rows)


@needs_full
def test_a_sweep_shows_its_table_whatever_happens_to_the_file(cosim, case, monkeypatch, tmp_path):
    monkeypatch.setattr("cosim.study.command.sweep", lambda s, variants, r, done, k: quick(variants, done))
    code, out, err = cosim("sweep", case, "--vary", "ice.thickness=1 m,2 m", "-o", FULL)
    assert code == 1
    assert "ice.thickness = 2 m" in out
    assert err.splitlines()[-1] == "cosim: /dev/full: No space left on device; free space or write elsewhere"
    content = json.loads(cosim("sweep", case, "--vary", "ice.thickness=1 m,2 m", "-o", FULL, "--json")[1])
    assert len(content["variants"]) == 3


def test_a_sweep_that_is_stopped_shows_what_has_ended(cosim, case, monkeypatch, tmp_path):
    stop = StoppedError(signal.SIGTERM)
    monkeypatch.setattr("cosim.study.command.sweep", lambda s, variants, r, done, k: quick(variants, done, stop))
    code, out, err = cosim("sweep", case, "--vary", "ice.thickness=1 m,2 m", "-o", tmp_path / "t.csv")
    assert (code, err.splitlines()[-1]) == (143, "cosim: stopped by SIGTERM")
    assert "base" in out
    assert (tmp_path / "t.csv").read_text().splitlines()[1].startswith("base,,1000000.0")
    code, _, err = cosim("sweep", case, "--vary", "ice.thickness=1 m", "-o", tmp_path / "t.csv")
    assert (code, "exists and is kept" in err) == (2, True)
