"""An interrupted run goes on from its checkpoint and ends with the bits of one that was not: loads, books, pictures."""

import os
import random
import shutil
import signal
import time
from dataclasses import replace

import pytest

from cosim import build, resume
from cosim.build import run_info
from cosim.checkpoint import file
from cosim.checkpoint.graph import GIVEN
from cosim.checkpoint.interrupted import interrupted
from cosim.checkpoint.restore import Restore
from cosim.errors import InputError
from cosim.recording.reader import read_run, recorded_pictures
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.signals import StoppedError, handled
from cosim.watched import simulate
from coupling.interface import SimulationError

TIMES = ("scenario.duration='0.8 s'", "recording.every='100 ms'", "recording.checkpoint_every='0.2 s'")
#: both engines; rubble lies there from the start, presses on sheet and structure and goes on over every checkpoint
CASES = {
    "explicit": ("basin_2010_floe_165m", "sheet.nodes=[16,16]", "rubble.initial_volume='300 m^3'", *TIMES),
    "implicit": (
        "van_vliet_2018_floe_55m_centre",
        "sheet.nodes=[12,12]",
        "drift.velocity='0.4 m/s'",
        "contact.strength='800 kPa'",
        "rubble.initial_volume='100 m^3'",
        *TIMES,
    ),
}
#: the same until ice has broken off and has been handed over
LONG = {
    "explicit": (*CASES["explicit"], "scenario.duration='6 s'", "recording.checkpoint_every='1 s'"),
    "implicit": (*CASES["implicit"], "scenario.duration='5 s'", "recording.checkpoint_every='0.75 s'"),
    "moving": (
        *CASES["explicit"],
        "scenario.duration='6 s'",
        "recording.checkpoint_every='1 s'",
        "structure.motion.kind='spring'",
        "structure.motion.surge={mass='1200 t',stiffness='600 MN/m',damping='500 kN*s/m'}",
    ),
    "waves": (*CASES["implicit"], "scenario.duration='4 s'", "fracture.propagation='dynamic'"),
    "iterated": (
        *CASES["implicit"],
        "scenario.duration='4 s'",
        "coupling.scheme='serial-implicit'",
        "coupling.unconverged='count'",
    ),
    "steered": (
        *CASES["implicit"],
        "scenario.duration='4 s'",
        "coupling.steering='power'",
        "recording.checkpoint_every='0.5 s'",
    ),
}
SMALL = ("van_vliet_2018_floe_55m_centre", "sheet.nodes=[12,12]", "rubble.enabled=false", *TIMES)
#: a state of each without which runs differ: velocities at the last meeting, running mean of the forces on the sheet
LEFT_OUT = {
    "explicit": ("coupling.sheet_port.meeting:Meeting", "_velocity"),
    "implicit": ("coupling.schemes:SerialExplicit", "_mean"),
}
needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")


class Tell:
    """Observer that tells of every window by a byte, after the recording has it."""

    def __init__(self, pipe):
        self.pipe = pipe

    def on_start(self, run_info):
        pass

    def on_frame(self, frame):
        os.write(self.pipe, b".")

    def on_close(self):
        pass


class Counts:
    """Observer that counts windows."""

    windows = 0

    def on_start(self, run_info):
        pass

    def on_frame(self, frame):
        self.windows += 1

    def on_close(self):
        pass


def case(options):
    return load_scenario(options[0], options[1:])


def whole(options, path):
    """Bytes of the recording of a run that is not interrupted, and what it tells."""
    told = simulate(case(options), [Recorder(path)])
    assert not file.place_of(path).exists()
    return path.read_bytes(), told


def kill(options, path, windows, after=0.0):
    """A run is killed when it has told of so many windows, and so many seconds later."""
    ours, theirs = os.pipe()
    child = os.fork()
    if child == 0:
        simulate(case(options), [Recorder(path), Tell(theirs)])
        os._exit(0)
    os.close(theirs)
    told = b""
    while len(told) < windows and (more := os.read(ours, windows - len(told))):
        told += more
    time.sleep(after)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    os.close(ours)


def resumed(path):
    """Bytes of the recording of a run that goes on to its end, and what it tells."""
    run = interrupted(path)
    told = simulate(run.scenario, [Recorder(path, since=run.since)], kept=run.kept)
    assert not file.place_of(path).exists()
    return path.read_bytes(), told


def same(told, other):
    """Whether two runs tell the same, but for how long they took."""
    differ = {key for key in told if told[key] != other[key]}
    return differ <= {"wall_s", "real_time_factor"}


def killed_and_resumed(options, path, chance, reference, kills):
    """A run that is killed at random again and again ends as the one that was not; windows that the files held."""
    held, windows = [], len(read_run(path.with_name("whole.mcap")).t_ns)
    for k in range(kills):
        broken = path.with_name(f"{k}.mcap")
        kill(options, broken, chance.randrange(1, windows), chance.uniform(0.0, 0.02))
        held.append(len(read_run(broken).t_ns))
        if not file.place_of(broken).exists():  # before the first checkpoint, or after the end
            continue
        data, told = resumed(broken)
        assert data == reference[0], (k, held)
        assert same(told, reference[1])
    return held


@needs_fork
@pytest.mark.parametrize("engine", CASES)
def test_a_killed_run_ends_bit_equal(engine, monkeypatch, tmp_path):
    """Two kills: after the first checkpoint, and after the second in a run that was resumed before."""
    options, path = CASES[engine], tmp_path / "run.mcap"
    reference = whole(options, tmp_path / "whole.mcap")
    assert read_run(tmp_path / "whole.mcap").ledger["power_from_rubble"].any()  # blocks press on the sheet
    kill(options, path, 6)
    assert read_run(path).cut
    assert max(len(p.blocks.phase) for p in recorded_pictures(path)) >= 2
    first = interrupted(path)
    assert first.since.t_ns == 200_000_000
    pid = os.fork()
    if pid == 0:  # it goes on, and is killed again
        ended = Stop(9)
        simulate(first.scenario, [Recorder(path, since=first.since), ended], kept=first.kept)
    os.waitpid(pid, 0)
    assert interrupted(path).since.t_ns == 600_000_000
    for end in (".mcap", ".checkpoint"):
        shutil.copy(path.with_suffix(end), tmp_path / f"twin{end}")
    data, told = resumed(path)
    assert data == reference[0]
    assert same(told, reference[1])
    leave_out(monkeypatch, *LEFT_OUT[engine])
    assert resumed(tmp_path / "twin.mcap")[0] != reference[0]


def leave_out(monkeypatch, name, attribute):
    """Twin: what was kept of an attribute is not taken on; it stays as the scenario builds it."""
    usual = Restore._object

    def less(self, number, twin, cls, kept):
        return usual(self, number, twin, cls, kept | {attribute: GIVEN} if cls == name else kept)

    monkeypatch.setattr(Restore, "_object", less)


class Stop(Tell):
    """Observer that kills its own process after so many windows."""

    def __init__(self, windows):
        self.left = windows

    def on_frame(self, frame):
        self.left -= 1
        if self.left == 0:
            os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.slow
@needs_fork
@pytest.mark.parametrize("run", LONG)
def test_runs_that_are_killed_at_twenty_random_times_end_bit_equal(run, tmp_path):
    options = LONG[run]
    reference = whole(options, tmp_path / "whole.mcap")
    assert read_run(tmp_path / "whole.mcap").events
    held = killed_and_resumed(options, tmp_path / "run.mcap", random.Random(16), reference, 20)
    print(f"{run}: 20 kills, windows read: {held}")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_was_stopped_goes_on(number, cosim, tmp_path):
    """Its recording is finished with its reason; that goes when the run goes on."""
    reference = whole(SMALL, tmp_path / "whole.mcap")
    path = tmp_path / "run.mcap"

    class Raise(Tell):
        def __init__(self):
            pass

        def on_frame(self, frame):
            if frame.t_ns == 500_000_000:
                signal.raise_signal(number)

    with pytest.raises(StoppedError), handled():
        simulate(case(SMALL), [Recorder(path), Raise()])
    assert "stopped by" in read_run(path).ended
    code, _, err = cosim("resume", path, "--json")
    assert (code, path.read_bytes()) == (0, reference[0]), err
    code, _, err = cosim("resume", path)
    assert code == 2
    assert "no checkpoint run.checkpoint beside it: it has reached its end" in err


def test_bits_depend_on_checkpoints_and_not_on_whether_they_are_written(tmp_path):
    """Without a recording, or with one, the run passes through the same states."""
    written = simulate(case(CASES["explicit"]), [Recorder(tmp_path / "run.mcap")])
    assert same(simulate(case(CASES["explicit"]), []), written)


@pytest.fixture
def broken_off(tmp_path):
    """A recording whose run has failed after its checkpoints, and its bytes."""
    path = tmp_path / "run.mcap"

    class Fail(Tell):
        def __init__(self):
            pass

        def on_frame(self, frame):
            if frame.t_ns == 500_000_000:
                raise RuntimeError("no power")

    with pytest.raises(RuntimeError):
        simulate(case(SMALL), [Recorder(path), Fail()])
    return path


def test_a_run_goes_on_from_python(broken_off, tmp_path):
    reference = whole(SMALL, tmp_path / "whole.mcap")
    seen = Counts()
    run = resume(broken_off, observers=[seen])
    assert broken_off.read_bytes() == reference[0]
    assert not file.place_of(broken_off).exists()
    assert 0 < seen.windows < len(run.loads)
    with pytest.raises(InputError, match="beside it: it has reached its end"):
        resume(broken_off)


def test_what_cannot_go_on_says_so_in_one_line(broken_off, cosim, tmp_path):
    place, data = file.place_of(broken_off), broken_off.read_bytes()
    kept = file.read(place)

    def refused(*words):
        code, _, err = cosim("resume", broken_off)
        assert code == 2
        assert err.strip().count("\n") == 0
        assert all(word in err for word in words), err
        assert broken_off.read_bytes() == data  # nothing is changed before all is checked

    libraries = {**kept.header["run"], "version": "0.0.1"}
    file.write(place, replace(kept, header={**kept.header, "run": libraries}))
    refused("version was 0.0.1 when the run began", "run the scenario again")
    file.write(place, replace(kept, header={**kept.header, "since": {"t_ns": 700_000_000, "due_ns": 0, "view_ns": 0}}))
    refused("ends at 0.5 s, before its checkpoint at 0.7 s")
    file.write(place, replace(kept, header={**kept.header, "scenario": {"name": 1}}))
    refused("checkpoint cannot be read")
    file.write(place, kept)
    whole_file = place.read_bytes()
    for damaged in (whole_file[:-1], whole_file[:200], whole_file[:-9] + b"\0" + whole_file[-8:]):
        place.write_bytes(damaged)
        refused("checkpoint is damaged")
    place.write_bytes(b"PAR1")
    refused("no checkpoint of cosim")
    place.unlink()
    refused("no checkpoint run.checkpoint beside it")
    file.write(place, kept)
    data = data[:6000] + bytes([data[6000] ^ 1]) + data[6001:]
    broken_off.write_bytes(data)
    refused("run.mcap")


def test_a_machine_of_another_kind_is_told(broken_off, cosim):
    place = file.place_of(broken_off)
    kept = file.read(place)
    file.write(place, replace(kept, header={**kept.header, "machine": "Plan9 vax"}))
    code, _, err = cosim("resume", broken_off, "-q")
    assert code == 0
    assert "another machine (Plan9 vax, here " in err


def test_another_file_is_not_written_over_and_an_old_checkpoint_goes_with_its_run(broken_off, cosim):
    place = file.place_of(broken_off)
    arguments = ("run", SMALL[0], *(a for option in SMALL[1:3] for a in ("--set", option)), "-q")
    arguments = (*arguments, "--set", "scenario.duration='0.2 s'", "-o", broken_off)
    code, _, err = cosim(*arguments)
    assert "exists and is kept" in err
    assert place.exists()
    assert cosim(*arguments, "--force")[0] == 0
    assert not place.exists()
    place.write_text("my notes")
    code, _, err = cosim(*arguments, "--force", "--checkpoint-every", "0.1 s")
    assert code == 2
    assert "run.checkpoint: exists and is no .checkpoint file" in err
    assert place.read_text() == "my notes"


def test_a_recording_that_is_being_written_does_not_go_on(broken_off):
    run = interrupted(broken_off)
    first = Recorder(broken_off, since=run.since)
    first.on_start(run_info(run.scenario))
    with pytest.raises(InputError, match="is being written by another program"):
        Recorder(broken_off, since=run.since).on_start(run_info(run.scenario))
    first.on_close()


def test_a_participant_that_cannot_be_kept_ends_the_run_at_its_first_checkpoint():

    class Keeps:
        """A load that holds a file."""

        name = "wind"

        def __init__(self):
            self.file = open(os.devnull)  # noqa: SIM115

        def on_sheet(self, t, sheet):
            return 0.0 * sheet.velocity

    usual = build.loads_of
    try:
        build.loads_of = lambda scenario: [*usual(scenario), Keeps()]
        with pytest.raises(SimulationError, match=r"cannot keep .*TextIOWrapper at sheet\.loads\[0\]\.file"):
            simulate(case(SMALL), [])
    finally:
        build.loads_of = usual
