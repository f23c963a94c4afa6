"""The command line: exit codes, one line for each error, one JSON object for --json."""

import json
import subprocess
import sys
import types

import pytest

from cosim.cli import main
from coupling.interface import SimulationError

FLOE = "van_vliet_2018_floe_165m"


@pytest.fixture
def truncated(run_file, tmp_path):
    path = tmp_path / "killed.mcap"
    path.write_bytes(run_file.read_bytes()[:-5000])
    return path


def test_bad_input_is_exit_2_and_one_line(cosim, truncated, tmp_path):
    text = tmp_path / "text.mcap"
    text.write_text("hello")
    for arguments, says in [
        (("run", "nowhere"), "no such scenario"),
        (("run", FLOE, "--set", "ice.thickness=-1 m"), "greater than zero"),
        (("run", FLOE, "--set", "ice.thicknes=1 m"), "did you mean"),
        (("run", FLOE, "-o", tmp_path / "no/x.mcap"), "folder"),
        (("compare", tmp_path / "no.mcap"), "no such recording"),
        (("compare", text), "not an MCAP"),
        (("compare", truncated), "cosim recover"),
        (("info", truncated), "cosim recover"),
        (("replay", truncated, "--save", tmp_path / "x.rrd"), "cosim recover"),
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
    """Replace the simulation by synthetic frames; ``fail_at`` raises in that window."""

    def install(fail_at=None, error=None):
        def run_scenario(scenario, observers, stop=None):
            for observer in observers:
                observer.on_start(synthetic.run_info(scenario))
            for k, frame in enumerate(synthetic.frames(scenario)):
                if k == fail_at:
                    raise error
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
                "trust": {"trustworthy": True, "because": [], "lights": {}},
                "peaks": peak,
                "peaks_by_phase": {p: peak for p in ("breaking", "rotating", "sliding")},
                "events": [{"time": 4.0, "kind": "split", "fx": 1e6, "fz": float("nan"), "cells": 3}],
                "fragments": 2,
                "blocks": 18,
                "ledger": {"mass_error": 1e-12},
                "recording": None,
            }

        module = types.ModuleType("cosim.run")
        module.run_scenario = run_scenario
        monkeypatch.setitem(sys.modules, "cosim.run", module)

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
    assert json.loads(cosim("info", tmp_path / "run.mcap", "--json")[1])["windows"] == 30


def test_an_interrupted_run_keeps_its_recording(cosim, fake_run, tmp_path):
    fake_run(fail_at=30, error=KeyboardInterrupt())
    assert cosim("run", FLOE, *SHORT, "-o", tmp_path / "run.mcap")[0] == 130
    assert cosim("info", tmp_path / "run.mcap")[0] == 0


def test_an_unexpected_error_is_one_line_and_the_traceback_is_there_on_demand(cosim, fake_run, monkeypatch):
    fake_run(fail_at=3, error=ZeroDivisionError("oops"))
    code, _, err = cosim("run", FLOE, *SHORT)
    assert code == 1
    assert "unexpected ZeroDivisionError: oops" in err.splitlines()[-1]
    assert "Traceback" not in err
    monkeypatch.setenv("COSIM_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        main(["run", FLOE, *SHORT])


def test_help_imports_nothing_slow():
    code = (
        "import sys\nfrom cosim.cli import main\ntry:\n    main(['--help'])\nexcept SystemExit: pass\n"
        "slow = {'numba', 'rerun', 'matplotlib', 'scipy', 'pymunk', 'pint'} & set(sys.modules)\n"
        "assert not slow, slow"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
