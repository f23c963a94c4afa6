"""What a run says: quiet, usual, verbose, into a file; within 80 columns; and texts that are shown, never obeyed."""

import dataclasses
import io
import json
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console

from cosim.recording.reader import read_run
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.show.console import as_line
from cosim.show.progress import ProgressBar, event_lines
from cosim.show.report import write_report
from cosim.show.talk import QUIET, Talk

CASE = "van_vliet_2018_floe_55m_centre"
SHORT = ("--set", "sheet.nodes=[12, 12]", "--set", "scenario.duration='0.2 s'", "--set", "recording.every='0.1 s'")
BROKEN = (
    *("--set", "sheet.nodes=[12, 12]", "--set", "scenario.duration='6 s'", "--set", "drift.velocity='0.4 m/s'"),
    *("--set", "rubble.initial_volume='60 m^3'"),
)


def test_quiet_usual_and_verbose(cosim, tmp_path):
    quiet = cosim("run", CASE, *BROKEN, "-q")
    usual = cosim("run", CASE, *BROKEN)
    verbose = cosim("run", CASE, *BROKEN, "-v", "--log-file", tmp_path / "log.txt")
    assert quiet[::2] == (0, "")
    assert quiet[1].count("\n") == 2  # and what speaks against it
    assert quiet[1].startswith("peaks, means over 0.5 s: Fx ")
    assert "cell_failure" in usual[2]
    assert "characteristic length" not in usual[2]
    assert "characteristic length" in verbose[2]
    assert "at x = " in verbose[2]
    assert "Events, loads as means over 0.5 s" in verbose[1]
    assert "Events" not in usual[1]
    log = (tmp_path / "log.txt").read_text()
    assert all(line in log for line in verbose[2].splitlines())
    assert "6.00 s of 6 s" in log
    assert log.splitlines()[-2:] == quiet[1].splitlines()
    code, _, err = cosim("run", CASE, *SHORT, "-q", "-v")
    assert (code, "exclude each other" in err) == (2, True)


def test_a_piece_that_breaks_off_is_told_once():
    """It becomes rubble as well, which is told where nothing else tells of the piece."""

    def lines(*kinds):
        events = [SimpleNamespace(kind=kind, t_ns=k, text="a piece") for k, kind in enumerate(kinds)]
        return [line.split()[2] for line in event_lines(SimpleNamespace(events=events))]

    assert lines("circumferential", "hand_over", "circumferential", "hand_over") == ["circumferential:"]
    assert lines("split", "hand_over") == ["split:", "hand_over:"]
    assert lines("circumferential", "hand_over", "hand_over") == ["circumferential:", "hand_over:"]


def test_a_run_that_is_not_recorded_says_so(cosim, tmp_path):
    assert "nothing was recorded: -o run.mcap keeps a run" in cosim("run", CASE, *SHORT)[1]
    out = cosim("run", CASE, *SHORT, "-o", tmp_path / "run.mcap")[1]
    assert "nothing was recorded" not in out
    assert f"recording: {tmp_path / 'run.mcap'}" in out.replace("\n", "")


def test_a_log_file_is_appended_to_and_never_a_scenario(cosim, tmp_path):
    log = tmp_path / "log.txt"
    assert cosim("run", CASE, *SHORT, "-q", "--log-file", log)[0] == 0
    first = log.read_text()
    assert first.startswith("# cosim log\nchar")
    assert cosim("run", CASE, *SHORT, "-q", "--log-file", log)[0] == 0
    assert log.read_text().startswith(first + "char")
    assert log.read_text().count("# cosim log") == 1
    file, link = tmp_path / "mine.txt", tmp_path / "link.log"
    file.write_text("x")
    link.symlink_to(file)
    for name in (file, link, tmp_path, tmp_path / "no/log.txt"):
        code, _, err = cosim("run", CASE, *SHORT, "--log-file", name)
        assert (code, err.count("\n"), file.read_text()) == (2, 1, "x"), err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_a_log_file_on_a_full_disk_is_one_line(cosim):
    code, _, err = cosim("run", CASE, *SHORT, "-q", "--log-file", "/dev/full")
    assert (code, err.count("\n"), "/dev/full: No space left" in err) == (1, 1, True), err


def test_a_log_file_that_is_being_written_is_refused(cosim, tmp_path):
    with Talk(QUIET, tmp_path / "l.log"):
        code, _, err = cosim("run", CASE, *SHORT, "-q", "--log-file", tmp_path / "l.log")
    assert (code, err.count("\n"), "is being written by another program" in err) == (2, 1, True), err


def test_a_sweep_talks_like_a_run(cosim, tmp_path):
    log = tmp_path / "l.log"
    given = ("sweep", CASE, *SHORT, "--vary", "scenario.seed=1")
    code, out, err = cosim(*given, "-q", "--log-file", log)
    assert (code, err) == (0, "")
    assert "scenario.seed = 1" in out
    lines = log.read_text().splitlines()
    assert lines[1].startswith("characteristic length")
    assert [line.split(":")[0] for line in lines[3:]] == ["base", "scenario.seed = 1"]
    assert "characteristic length" in cosim(*given, "-v")[2]


def test_an_error_stands_in_the_log_file(tmp_path):
    def fail():
        with Talk(QUIET, tmp_path / "l.txt") as talk:
            talk.note("first")
            raise ValueError("oops")

    with pytest.raises(ValueError, match="oops"):
        fail()
    assert (tmp_path / "l.txt").read_text().splitlines()[1] == "first"
    assert "oops" in (tmp_path / "l.txt").read_text()


def test_a_dry_run_writes_and_simulates_nothing(cosim, tmp_path, monkeypatch):
    monkeypatch.setattr("coupling.scheduler.Scheduler.macro_step", None)
    code, out, _ = cosim("run", CASE, *SHORT, "--dry-run", "-o", tmp_path / "x.mcap")
    assert code == 0
    assert "144 nodes, 4 windows" in out
    assert not (tmp_path / "x.mcap").exists()
    assert json.loads(cosim("run", CASE, *SHORT, "--dry-run", "--json")[1])["cost"]["windows"] == 4
    code, _, err = cosim("run", CASE, *SHORT, "--dry-run", "-o", tmp_path / "no/x.mcap")
    assert (code, "no such folder" in err) == (2, True)


def test_the_bar_and_the_end_fit_a_screen_of_80_columns(cosim, synthetic):
    scenario = load_scenario(
        CASE, ["scenario.title='A title that is much longer than any bar can be, 80 characters and more'"]
    )
    out = io.StringIO()
    console = Console(file=out, force_terminal=True, width=80, color_system=None)
    bar = ProgressBar(Talk(), console)
    bar.on_start(synthetic.run_info(scenario))
    for frame in synthetic.frames(scenario):
        bar.on_frame(frame)
        if frame.t_ns > 3_000_000_000:
            break
    bar._progress.refresh()
    bar.on_close()
    shown = [line for line in re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "\n", out.getvalue()).splitlines() if "/60 s" in line]
    assert shown
    assert max(len(line.strip("\r")) for line in shown) <= 80
    assert re.search(r"A title that is much … .*3\.05/60 s \S+x \d\d:\d\d left", shown[-1])
    text = cosim("run", CASE, *SHORT)[1]
    rows = sum(1 + (len(line) - 1) // 80 for line in text.splitlines())
    assert rows <= 24


WILD = ["[/x]", "[red]a[/red] <b>b</b> &amp;", "$x^$ $$", "{0} %s {task}", "a" * 200]


@pytest.mark.parametrize("title", WILD)
def test_a_title_is_shown_as_it_is(cosim, tmp_path, title):
    """Markup stopped a run; in tables, bars, pages and pictures a title is a text."""
    path = tmp_path / "run.mcap"
    given = ("--set", f"scenario.title='{title}'")
    code, _, err = cosim("run", CASE, *SHORT, *given, "-o", path)
    assert code == 0, err
    code, out, err = cosim("info", path)
    assert (code, err) == (0, "")
    assert title in out.replace("\n", "")
    write_report(read_run(path), tmp_path / "r.html")
    page = (tmp_path / "r.html").read_text()
    assert "<b>b" not in page
    assert cosim("baseline", CASE, *given)[0] == 0
    assert cosim("check", CASE, *given)[1].startswith(title[:20])
    assert cosim("sweep", CASE, *SHORT, *given, "--vary", "scenario.seed=1", "--plot", tmp_path / "t.png")[0] == 0


@pytest.mark.parametrize("title", ["a\x1b[2Jb", "a\x07", "a\u202eb", "line\nline", "\x9b31m"])
def test_a_title_that_a_terminal_would_obey_is_refused(cosim, title):
    code, out, err = cosim("run", CASE, "--set", f"scenario.title={json.dumps(title)}")
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert "one line of plain text: remove" in err
    assert title not in err


def test_no_escape_sequence_of_a_file_or_an_argument_reaches_the_terminal(cosim, tmp_path, synthetic):
    bad = "x\x1b]0;gotcha\x07\x1b[31m"
    for arguments in (
        ("run", bad),
        ("run", CASE, "--set", f"ice.{bad}=1"),
        ("run", CASE, "--set", bad),
        ("info", bad),
        ("keys", bad),
    ):
        code, out, err = cosim(*arguments)
        assert (code, "\x1b" in out + err, err.count("\n")) == (2, False, 1), err
    scenario = load_scenario(CASE, ["scenario.duration='1 s'"])
    path = tmp_path / "run.mcap"
    with Recorder(path) as recorder:
        recorder.on_start(synthetic.run_info(scenario))
        for frame in synthetic.frames(scenario):
            recorder.on_frame(frame)
    data = read_run(path)

    from cosim.analysis.summary import summary
    from cosim.show.tables import print_info

    foreign = dataclasses.replace(data, metadata={**data.metadata, "title": bad, "scenario": bad, "version": "[/x]"})
    print_info(summary(foreign))


def test_a_line_shows_what_it_hides():
    assert as_line("Tür 3 m²") == "Tür 3 m²"
    assert as_line("a\x1b[2J\n") == "a\\x1b[2J\\n"
    assert as_line("\u202e") == "\\u202e"


def test_markup_in_the_name_of_a_scenario(cosim, tmp_path):
    file = tmp_path / "[red]x[b].toml"
    file.write_text(load_scenario(CASE).text)
    assert cosim("run", file, *SHORT)[0] == 0


def test_info_counts_events_and_lists_all_of_them_on_request(cosim, tmp_path, synthetic):
    """Sixty events: in one line, and one by one."""
    from coupling.interface import Event

    scenario = load_scenario(CASE, ["scenario.duration='4 s'"])
    path = tmp_path / "run.mcap"
    with Recorder(path) as recorder:
        recorder.on_start(synthetic.run_info(scenario))
        for frame in synthetic.frames(scenario):
            event = Event(frame.t_ns, "cell_failure", (1e6, 0.0, 2e6), 3, (0.0, 0.0, 0.0), "3 cells fail", cause="[/x]")
            recorder.on_frame(dataclasses.replace(frame, events=(event,)))
    short, full = cosim("info", path)[1], cosim("info", path, "--events")[1]
    assert "events: 80 cell_failure (from 0.05 s); `cosim info --events` lists them" in short
    assert short.count("cell_failure") == 1
    assert full.count("cell_failure") == 80
    assert full.count("[/x]") == 80
    assert len(json.loads(cosim("info", path, "--json")[1])["events"]) == 80
