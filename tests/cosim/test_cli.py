"""The command line: exit codes, one line for each error, one JSON object for --json."""

import json
import os
import re
import signal
import subprocess
import sys
import types
from pathlib import Path

import pytest

from cosim.cli import main
from cosim.recording.reader import read_run
from cosim.scenario.finding import locate
from cosim.scenario.loading import checked
from cosim.study.command import Where, plan
from cosim.study.design import Design
from coupling.interface import SimulationError

FLOE = "van_vliet_2018_floe_165m"


@pytest.fixture
def truncated(run_file, tmp_path):
    path = tmp_path / "killed.mcap"
    path.write_bytes(run_file.read_bytes()[:-5000])
    return path


@pytest.fixture
def damaged(run_file, tmp_path):
    path = tmp_path / "damaged.mcap"
    data = bytearray(run_file.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    return path


def test_bad_input_is_exit_2_and_one_line(cosim, damaged, tmp_path):
    text = tmp_path / "text.mcap"
    text.write_text("hello")
    for arguments, says in [
        (("run", "nowhere"), "no such scenario"),
        (("run", FLOE, "--set", "ice.thickness=-1 m"), "greater than zero"),
        (("run", FLOE, "--set", "ice.thicknes=1 m"), "did you mean"),
        (("run", FLOE, "--set", "scenario.seed=-1"), "greater than or equal to 0"),
        (("run", FLOE, "-o", tmp_path / "no/x.mcap"), "folder"),
        (("compare", tmp_path / "no.mcap"), "no such recording"),
        (("compare", text), "not an MCAP"),
        (("compare", damaged), "cosim recover"),
        (("info", damaged), "cosim recover"),
        (("report", damaged, "-o", tmp_path / "x.html"), "cosim recover"),
        (("replay", damaged, "--save", tmp_path / "x.rrd"), "cosim recover"),
        (("replay", text, "--web", "--save", "x.rrd"), "exclude"),
        (("replay", text, "--time", "3"), "--screenshot"),
        (("recover", text), "not an MCAP"),
        (("fly",), "No such command"),
        (("run",), "Missing argument"),
        (("info", "--fast", text), "No such option"),
    ]:
        code, out, err = cosim(*arguments)
        assert (code, out) == (2, ""), arguments
        assert says in err
        assert err.startswith("cosim: ")
        assert err.count("\n") == 1, err
        assert "Traceback" not in err


def test_help_and_list(cosim):
    for arguments in ((), ("--help",), ("run", "--help")):
        code, out, _ = cosim(*arguments)
        assert code == 0
        assert "Usage" in out
    code, out, err = cosim("list", "--json")
    assert code == 0
    assert err == ""
    assert FLOE in {row["name"] for row in json.loads(out)["scenarios"]}
    assert FLOE in cosim("list")[1]


def test_info_and_compare(cosim, run_file):
    code, out, err = cosim("info", run_file, "--json")
    content = json.loads(out)
    assert (code, err, content["windows"], content["seed"]) == (0, "", 240, 2018)
    assert content["peaks"]["fx"]["value"] > content["peaks_by_phase"]["sliding"]["fx"]["value"] > 0
    code, out, err = cosim("compare", run_file, "--json")
    assert (code, err, json.loads(out)["run"]) == (0, "", "run.mcap")
    assert json.loads(out)["design"]["methods"]["croasdale"]["fx"] == pytest.approx(13.1e6, abs=0.1e6)
    code, out, _ = cosim("compare", run_file)
    assert code == 0
    assert "circumferential_fx" in out
    assert "van Vliet 2018" in out
    assert "circumferential" in cosim("info", run_file)[1]


def test_recover(cosim, truncated, tmp_path):
    code, out, err = cosim("recover", truncated, "-o", tmp_path / "clean.mcap", "--json")
    assert (code, err) == (0, "")
    assert json.loads(out)["windows"] > 200
    assert cosim("info", tmp_path / "clean.mcap")[0] == 0
    assert cosim("recover", truncated)[0] == 0
    assert truncated.with_suffix(".recovered.mcap").is_file()


@pytest.fixture
def fake_run(monkeypatch, synthetic):
    """Replace the simulation by synthetic frames; ``fail_at`` raises in that window, ``signal_at`` sends signals."""

    def install(fail_at=None, error=None, signal_at=(-1,)):
        def run_scenario(scenario, observers, at_end=None, checkpoints=None):
            for observer in observers:
                observer.on_start(synthetic.run_info(scenario))
            for k, frame in enumerate(synthetic.frames(scenario)):
                if k == fail_at:
                    raise error
                for number in signal_at[1:] if k == signal_at[0] else ():
                    signal.raise_signal(number)
                for observer in observers:
                    observer.on_frame(frame)
            return types.SimpleNamespace(to_json=lambda: result(scenario))

        def result(scenario):
            peak = {key: {"value": 1e6, "time": 2.0} for key in ("fx", "fz", "f")}
            return {
                "scenario": scenario.name,
                "simulated_s": 12.0,
                "wall_s": 1.0,
                "real_time_factor": 12.0,
                "averaging_s": 0.5,
                "window_s": 0.05,
                "substep_s": 0.005,
                "trust": {"trustworthy": True, "because": [], "lights": {}},
                "peaks": peak,
                "peaks_by_phase": {p: peak for p in ("breaking", "rotating", "sliding")},
                "events": [{"time": 4.0, "kind": "split", "fx": 1e6, "fz": float("nan"), "cells": 3}],
                "fragments": 2,
                "blocks": 18,
                "ledger": {"mass_error": 1e-12},
                "recording": None,
            }

        module = types.ModuleType("cosim.simulation")
        module.run_scenario = run_scenario
        monkeypatch.setitem(sys.modules, "cosim.simulation", module)

    return install


SHORT = ("--set", "scenario.duration=12 s", "--set", "sheet.nodes=[40,40]")


def test_run_prints_one_json_object(cosim, fake_run, tmp_path):
    fake_run()
    code, out, err = cosim("run", FLOE, *SHORT, "-o", tmp_path / "run.mcap", "--json")
    content = json.loads(out)
    assert code == 0
    assert content["recording"] == str(tmp_path / "run.mcap")
    assert content["events"][0]["fz"] is None
    assert "split" in err
    assert cosim("info", tmp_path / "run.mcap")[0] == 0
    code, out, _ = cosim("run", FLOE, *SHORT)
    assert code == 0
    assert "breaking" in out
    assert "12.00 x real time" in out


def test_a_failed_run_is_exit_1_and_keeps_its_recording(cosim, fake_run, tmp_path):
    line = "ledger: mass is lost at 1.5 s in window 30; report it"
    fake_run(fail_at=30, error=SimulationError(line))
    code, out, err = cosim("run", FLOE, *SHORT, "-o", tmp_path / "run.mcap", "--json")
    assert (code, out) == (1, "")
    assert err.splitlines()[-1] == f"cosim: {line}"
    assert "Traceback" not in err
    content = json.loads(cosim("info", tmp_path / "run.mcap", "--json")[1])
    assert (content["windows"], content["ended"]) == (30, line)


@pytest.mark.parametrize(("number", "name"), [(signal.SIGINT, "Ctrl-C"), (signal.SIGTERM, "SIGTERM")])
def test_a_signal_ends_a_run_after_its_window(cosim, fake_run, tmp_path, number, name):
    path = tmp_path / "run.mcap"
    fake_run(signal_at=(30, number))
    code, out, err = cosim("run", FLOE, *SHORT, "-o", path, "--json")
    assert (code, out) == (128 + number, "")
    assert err.splitlines()[-1] == (
        f"cosim: stopped by {name} after 1.55 of 12 s; {path} holds what was simulated until then"
    )
    run = read_run(path)
    assert len(run.t_ns) == 31
    assert not run.cut
    assert run.ended == f"stopped by {name} after 1.55 of 12 s"
    code, out, err = cosim("info", path, "--json")
    assert (code, json.loads(out)["ended"]) == (0, run.ended)
    assert err.startswith("warning: run.mcap is of a run that did not reach its end: stopped by")
    assert cosim("report", path, "-o", tmp_path / "r.html")[0] == 0
    assert f"<b>Not a whole run:</b> run.mcap is of a run that did not reach its end: {run.ended}" in (
        tmp_path / "r.html"
    ).read_text("utf-8")


def test_a_signal_before_the_first_window_leaves_no_recording(cosim, fake_run, tmp_path):
    fake_run(signal_at=(0, signal.SIGINT, signal.SIGTERM))
    code, out, err = cosim("run", FLOE, *SHORT, "-o", tmp_path / "run.mcap")
    assert (code, out, err.splitlines()[-1]) == (143, "", "cosim: stopped by SIGTERM")
    assert list(tmp_path.iterdir()) == []


def test_a_second_signal_does_not_wait_for_the_window(cosim, fake_run, tmp_path):
    fake_run(signal_at=(30, signal.SIGINT, signal.SIGTERM))
    code, _, err = cosim("run", FLOE, *SHORT, "-o", tmp_path / "run.mcap")
    assert (code, err.splitlines()[-1].split(";")[0]) == (143, "cosim: stopped by SIGTERM")
    assert len(read_run(tmp_path / "run.mcap").t_ns) == 30
    assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL


def test_an_unexpected_error_is_one_line_and_the_traceback_is_there_on_demand(cosim, fake_run, monkeypatch):
    fake_run(fail_at=3, error=ZeroDivisionError("oops"))
    code, _, err = cosim("run", FLOE, *SHORT)
    assert code == 1
    assert "unexpected ZeroDivisionError: oops" in err.splitlines()[-1]
    assert "Traceback" not in err
    monkeypatch.setenv("COSIM_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        main(["run", FLOE, *SHORT])


@pytest.mark.parametrize(("command", "besides"), [("--help", ("numpy", "pydantic")), ("list", ())])
def test_help_and_list_import_nothing_slow(command, besides):
    slow = ("numba", "rerun", "matplotlib", "scipy", "pymunk", "pint", *besides)
    code = (
        f"import sys\nfrom cosim.cli import main\ntry:\n    main(['{command}'])\nexcept SystemExit: pass\n"
        f"slow = set({slow}) & set(sys.modules)\n"
        "assert not slow, slow"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


def test_version_and_module():
    done = subprocess.run([sys.executable, "-m", "cosim", "--version"], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    assert re.fullmatch(r"cosim \d+\.\d+\.\d+ \(([0-9a-f]{40}\+?|unknown)\)\n", done.stdout)


def test_shells_complete_commands_and_scenarios():
    def completed(words):
        environment = {**os.environ, "_COSIM_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": "2"}
        environment["COMP_CWORD"] = str(len(words.split()) - 1)
        command = [sys.executable, "-c", "from cosim.cli import main; main()"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, env=environment)
        assert done.stderr == ""
        return done.stdout.split()

    assert {"replay", "report", "recover"} <= set(completed("cosim re"))
    assert completed("cosim run icef") == ["icefloe_gla_upward_cone"]


def scenario_in(folder, name, title):
    (folder / name).mkdir(parents=True)
    (folder / name / "scenario.toml").write_text(f'[scenario]\ntitle = "{title}"\nduration = "3 s"\n')


def test_a_name_here_comes_before_one_of_the_project_and_a_bad_scenario_blocks_nothing(cosim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scenario_in(tmp_path / "scenarios", FLOE, "mine")
    (tmp_path / "scenarios" / "broken").mkdir()
    (tmp_path / "scenarios" / "broken" / "scenario.toml").write_text("[scenario\n")
    (tmp_path / "scenarios" / "empty").mkdir()
    (tmp_path / "scenarios" / "empty" / "scenario.toml").write_text("x = 1")
    scenario_in(tmp_path / "scenarios", "odd", "[/x] odd")
    assert locate(FLOE).resolve() == tmp_path / "scenarios" / FLOE / "scenario.toml"
    code, out, err = cosim("list", "--json")
    rows = {row["name"]: row for row in json.loads(out)["scenarios"]}
    assert (code, err, rows[FLOE]["title"], rows[FLOE]["duration_s"]) == (0, "", "mine", 3.0)
    assert rows["upward_plane"]["duration_s"] == 150.0
    assert "not valid TOML" in rows["broken"]["fault"]
    assert "scenario is missing" in rows["empty"]["fault"]
    code, out, err = cosim("list")
    assert (code, err) == (0, "")
    assert "[/x] odd" in out
    assert "cannot be read, see below" in out
    assert "not valid TOML" in out
    scenario_in(tmp_path, FLOE, "nearest")  # a folder of that name comes before all
    assert locate(FLOE).resolve() == tmp_path / FLOE / "scenario.toml"


def test_all_processes_of_a_sweep_have_the_same_scenario(tmp_path, monkeypatch):
    """It is read once, and goes to the processes as it was read."""
    monkeypatch.chdir(tmp_path)
    text = (Path(__file__).parents[2] / "scenarios" / FLOE / "scenario.toml").read_text("utf-8")
    (tmp_path / "scenarios" / FLOE).mkdir(parents=True)
    (tmp_path / "scenarios" / FLOE / "scenario.toml").write_text(text.replace("165 m floe", "mine"))
    the = plan(FLOE, ["ice.thickness=1 m"], (), Design(), Where())
    (tmp_path / "scenarios" / FLOE / "scenario.toml").unlink()
    assert the.base.title.startswith("mine")
    assert checked(the.study.written, the.variants[1].overrides).ice.thickness == 1.0
