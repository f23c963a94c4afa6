"""A recording is followed while it is written: everything of it arrives, and it ends with the run."""

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
import rerun_cli

from cosim.recording.reader import RecordingError, in_order, read_run
from cosim.recording.tail import Tail, begun
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.show.companion import Companion

OPTIONS = ["scenario.duration='6 s'", "sheet.nodes=[20,20]", "recording.every='500 ms'"]

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")


def written(synthetic, path, stop_after=None, observers=()):
    """A run that records a window every few milliseconds; killed in the middle of one if it is to stop. Its process."""
    scenario = load_scenario("van_vliet_2018_floe_165m", OPTIONS)
    child = os.fork()
    if child:
        return child
    watching = [Recorder(path), *observers]
    for observer in watching:
        observer.on_start(synthetic.run_info(scenario))
    for k, frame in enumerate(synthetic.frames(scenario)):
        if k == stop_after:
            os.kill(os.getpid(), signal.SIGKILL)
        for observer in watching:
            observer.on_frame(frame)
        time.sleep(0.005)
    for observer in reversed(watching):
        observer.on_close()
    os._exit(0)


def test_all_of_a_growing_file_arrives_in_order(synthetic, tmp_path):
    path = tmp_path / "run.mcap"
    child = written(synthetic, path)
    waited = []
    assert len(begun(path).t_ns) >= 1
    tail = Tail(path, lambda: (waited.append(1), time.sleep(0.002)))
    came = [r for r in in_order(path, tail) if isinstance(r, tuple)]
    os.waitpid(child, 0)
    whole = [r for r in in_order(path, Tail(path)) if isinstance(r, tuple)]
    assert waited  # it was there before the end
    assert came == whole
    assert not tail.cut
    assert read_run(path).ended == "complete"


def test_it_ends_with_a_run_that_is_killed(synthetic, tmp_path):
    path = tmp_path / "run.mcap"
    child = written(synthetic, path, stop_after=30)
    begun(path)
    tail = Tail(path, lambda: time.sleep(0.002))
    loads = [r for r in in_order(path, tail) if isinstance(r, tuple) and r[0] == "/load/structure"]
    os.waitpid(child, 0)
    assert tail.cut
    assert len(loads) == len(read_run(path).t_ns) == 30


def test_a_file_that_nobody_writes_is_read_to_its_end(run_file, tmp_path):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(run_file.read_bytes()[:-2000])
    assert list(in_order(cut, Tail(cut)))
    cut.write_bytes(cut.read_bytes()[:100])
    with pytest.raises(RecordingError):
        begun(cut)
    with pytest.raises(RecordingError, match="no such recording"):
        begun(tmp_path / "none.mcap")


def printed(path):
    """What a rerun file holds, as rerun tells it."""
    binary = Path(rerun_cli.__file__).with_name("rerun")
    done = subprocess.run([binary, "rrd", "print", "-v", path], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_a_run_is_shown_while_it_is_recorded(synthetic, tmp_path):
    """By a process of its own, as of `cosim run --follow`, here into a file: curves, ice, sections, log; it ends."""
    path, out = tmp_path / "run.mcap", tmp_path / "run.rrd"
    recorder, companion = Recorder(path), Companion(path, ["--save", str(out)])
    scenario = load_scenario("van_vliet_2018_floe_165m", OPTIONS)
    for observer in (recorder, companion):
        observer.on_start(synthetic.run_info(scenario))
    for frame in synthetic.frames(scenario):
        recorder.on_frame(frame)
        time.sleep(0.005)
    companion.on_close()
    recorder.on_close()
    assert companion.process.wait(timeout=120) == 0
    text = printed(out)
    for entity in ("load/fx/all", "load/fz/sliding", "world/sheet", "section", "plan", "events", "about"):
        assert entity in text, entity


def test_options_that_do_not_go_together(cosim, run_file, tmp_path):
    code, _, err = cosim("run", "first_cone", "--follow")
    assert code == 2
    assert "name a recording with -o" in err
    code, _, err = cosim("replay", run_file, "--follow", "--screenshot", tmp_path / "x.png")
    assert code == 2
    assert "--follow goes with a viewer or with --save" in err
