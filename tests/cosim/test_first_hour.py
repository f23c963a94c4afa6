"""The way of a new user, from an empty folder to a page: with the program of this environment, with pip, with uv."""

import json
import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def do(*command, folder, timeout=300):
    """Standard output of a command that succeeds; nothing of this environment reaches it."""
    bare = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "VIRTUAL_ENV", "COSIM"))}
    done = subprocess.run(
        [str(c) for c in command], cwd=folder, env=bare, capture_output=True, text=True, timeout=timeout
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def first_hour(cosim, folder):
    """new, two values edited, check, run, info, report."""
    assert list(folder.iterdir()) == []
    assert "van_vliet_2018_floe_165m" in do(*cosim, "list", folder=folder)
    assert "then `cosim check pier`" in do(*cosim, "new", "pier", folder=folder)
    file = folder / "pier/scenario.toml"
    before = file.read_text()
    after = before.replace('thickness = "0.8 m"', 'thickness = "60 cm"').replace(
        'duration = "30 s"', 'duration = "3 s"'
    )
    assert sum(a != b for a, b in zip(before.splitlines(), after.splitlines(), strict=True)) == 2
    file.write_text(after)
    assert "no fault" in do(*cosim, "check", "pier", folder=folder)
    ran = json.loads(do(*cosim, "run", "pier", "-o", "run.mcap", "--json", folder=folder, timeout=900))
    told = json.loads(do(*cosim, "info", "run.mcap", "--json", folder=folder))
    assert told["peaks"] == ran["peaks"]
    assert told["peaks"]["fx"]["value"] > 0.0
    assert (told["scenario"], told["simulated_s"], told["remark"]) == ("pier", 3.0, None)
    do(*cosim, "report", "run.mcap", "-o", "report.html", folder=folder)
    page = (folder / "report.html").read_text()
    assert page.count("data:image/") >= 3
    assert "60 cm" in page
    assert sorted(f.name for f in folder.iterdir()) == ["pier", "report.html", "run.mcap"]
    assert file.read_text() == after


def test_the_first_hour(tmp_path):
    first_hour([sys.executable, "-m", "cosim"], tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("tool", ["pip", "uv"])
def test_the_first_hour_of_a_fresh_environment(tmp_path, tool):
    """Nothing but Python and the tool; with uv an environment of its own as well."""
    env, work = tmp_path / "env", tmp_path / "work"
    work.mkdir()
    if tool == "pip":
        venv.create(env, with_pip=True)
        do(env / "bin/python", "-m", "pip", "install", "--quiet", ROOT, folder=tmp_path, timeout=900)
    else:
        uv = shutil.which("uv")
        if uv is None:
            pytest.skip("no uv on this machine")
        do(uv, "venv", "--quiet", "--python", sys.executable, env, folder=tmp_path)
        do(uv, "pip", "install", "--quiet", "--python", env / "bin/python", ROOT, folder=tmp_path, timeout=900)
    first_hour([env / "bin/cosim"], work)
