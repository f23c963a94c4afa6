"""SIGKILL at any moment: all but the last quarter of a simulated second can be read, by every command."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from cosim.recording.reader import RecordingError, read_run
from cosim.recording.writer import CHUNK_NS, Recorder
from cosim.scenario.loading import load_scenario

KILLS = 20
OPTIONS = ["scenario.duration='12 s'", "sheet.nodes=[40,40]", "recording.every='500 ms'"]

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")


def record_and_tell(synthetic, scenario, path, pipe):
    """A run that tells of every window that it has recorded, by one byte; never returns."""
    with Recorder(path) as recorder:
        recorder.on_start(synthetic.run_info(scenario))
        for frame in synthetic.frames(scenario):
            recorder.on_frame(frame)
            os.write(pipe, b".")
    os._exit(0)


def killed(synthetic, scenario, path, windows, after):
    """Windows that a run has told of which is killed some time [s] after so many of them, 0: after its file is there.

    Counted in windows, so that a slow machine kills as late as a fast one.
    """
    ours, theirs = os.pipe()
    child = os.fork()
    if child == 0:
        record_and_tell(synthetic, scenario, path, theirs)
    os.close(theirs)
    while not path.exists():
        time.sleep(0.001)
    told = b""
    while len(told) < windows:
        told += os.read(ours, windows - len(told))
    time.sleep(after)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    with os.fdopen(ours, "rb") as rest:
        return len(told) + len(rest.read())


def test_a_killed_run_loses_a_quarter_of_a_second_at_most(synthetic, run_file, tmp_path):
    whole, scenario = read_run(run_file), load_scenario("van_vliet_2018_floe_165m", OPTIONS)
    lost = CHUNK_NS // scenario.window_ns  # at most, besides the window under way
    cut, chance = [], random.Random(16)
    for k in range(KILLS):
        path = tmp_path / f"{k}.mcap"
        told = killed(synthetic, scenario, path, chance.randrange(60), chance.uniform(0.0, 0.02))
        if told == 0:
            with pytest.raises(RecordingError, match=r"not a recording of cosim|holds no data|not an MCAP"):
                read_run(path)
            continue
        run = read_run(path)
        assert told - lost < len(run.t_ns) <= told + 1
        assert (run.load == whole.load[: len(run.t_ns)]).all()
        assert run.metadata == whole.metadata
        assert ("truncated" in run.remark) == run.cut
        cut.append(path)
    assert len(cut) > KILLS // 2
    print(f"{KILLS} kills, windows read: {[len(read_run(path).t_ns) for path in cut]}")


def test_every_reading_command_takes_a_cut_file_and_says_what_is_missing(cosim, run_file, tmp_path):
    path = tmp_path / "cut.mcap"
    path.write_bytes(run_file.read_bytes()[: run_file.stat().st_size * 2 // 3])
    held = read_run(path).t[-1]
    warning = (
        "warning: cut.mcap is truncated (its run goes on, was killed, or the copy is not whole): "
        f"it holds {held:g} of 12 s\n"
    )
    assert 5.0 < held < 12.0
    for command in (
        ("info", path),
        ("info", path, "--json"),
        ("compare", path),
        ("compare", path, "--json"),
        ("report", path, "-o", tmp_path / "r.html"),
        ("replay", path, "--save", tmp_path / "r.rrd"),
    ):
        code, out, err = cosim(*command)
        assert (code, err) == (0, warning), command
        if "--json" in command:
            assert warning == f"warning: {json.loads(out)['remark']}\n"
    assert "Not a whole run:</b> cut.mcap is truncated" in (tmp_path / "r.html").read_text("utf-8")
    code, out, err = cosim("recover", path)
    assert (code, err) == (0, "")
    assert cosim("info", path.with_suffix(".recovered.mcap"))[2].startswith(
        "warning: cut.recovered.mcap is of a run that did not reach its end: its end is missing"
    )


SWEEP = """
import os, sys, time
sys.path.insert(0, sys.argv[1])
from cosim.cli import main
from cosim.study import sweep
from test_killed import linger
sweep.sweep.__defaults__ = (None, linger)
main(["sweep", "van_vliet_2018_floe_165m", "--vary", "ice.thickness=1 m,2 m,3 m", "-j", "2", "-o", sys.argv[2]])
"""


def linger(study, number, variant):
    """A task that leaves the number of its process, and goes on for minutes unless it is the base."""
    with open(os.environ["PIDS"], "a") as file:
        file.write(f"{os.getpid()}\n")
    if variant.changes:
        time.sleep(300)
    return {f"{c}_peak": 1e6 for c in ("fx", "fz", "f")} | {
        **{f"{p}_fx_peak": 0.0 for p in ("breaking", "rotating", "sliding")},
        **{"fx_time": 1.0, "fz_time": 1.0, "fx_mean": 0.0, "wall_s": 1.0, "simulated_s": 2.0},
        **{"averaging_s": 0.5, "not_trustworthy": ""},
    }


def alive(pid):
    try:
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().split(")")[1].split()[0]
    except OSError:
        return False


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="needs /proc")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_the_processes_of_a_sweep_end_with_it_and_its_table_holds_what_has_ended(tmp_path, number):
    table, pids = tmp_path / "t.csv", tmp_path / "pids"
    process = subprocess.Popen(
        [sys.executable, "-c", SWEEP, str(Path(__file__).parent), str(table)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PIDS": str(pids)},
    )
    until = time.monotonic() + 60
    while not (table.exists() and "base" in table.read_text() and len(pids.read_text().split()) >= 3):
        assert time.monotonic() < until, process.stderr.read() if process.poll() is not None else "too slow"
        time.sleep(0.05)
    process.send_signal(number)
    out, err = process.communicate(timeout=20)
    workers = {int(pid) for pid in pids.read_text().split()}
    until = time.monotonic() + 10
    while any(map(alive, workers)):
        assert time.monotonic() < until, "workers go on"
        time.sleep(0.05)
    assert table.read_text().splitlines()[1].startswith("base,,1000000.0")
    if number != signal.SIGKILL:
        assert process.returncode == 128 + number
        assert "base" in out
        assert err.splitlines()[-1].startswith("cosim: stopped by ")
        assert "Traceback" not in err
