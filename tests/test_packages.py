"""What pip installs is the whole program: scenarios, page of the report, types, licence, commit of the sources."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from cosim.provenance import commit_of

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """A wheel of the sources as they are, built without a network."""
    pytest.importorskip("hatchling")
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return next(folder.glob("*.whl"))


def test_the_wheel_holds_the_scenarios_and_what_else_is_no_code(wheel):
    names = set(zipfile.ZipFile(wheel).namelist())
    scenarios = {f.relative_to(ROOT / "scenarios").as_posix() for f in (ROOT / "scenarios").rglob("*") if f.is_file()}
    assert {f"cosim/shipped/{name}" for name in scenarios} <= names
    assert {
        "cosim/show/report.html.j2",
        *(f"{p}/py.typed" for p in ("cosim", "coupling", "lattice", "rubble")),
    } <= names
    assert any(name.endswith("licenses/LICENSE") for name in names)
    assert not [name for name in names if name.startswith(("tests", "docs", "scenarios"))]


def test_an_installed_program_finds_its_scenarios_from_everywhere(wheel, tmp_path):
    """Unpacked as pip would, away from the checkout; its own modules come first on the path."""
    site, work = tmp_path / "site", tmp_path / "work"
    zipfile.ZipFile(wheel).extractall(site)
    work.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(site)}

    def python(*arguments):
        done = subprocess.run(
            [sys.executable, *arguments], cwd=work, env=environment, capture_output=True, text=True, timeout=60
        )
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout

    assert python("-c", "import cosim; print(cosim.__file__)").startswith(str(site))
    found = {row["name"] for row in json.loads(python("-m", "cosim", "list", "--json"))["scenarios"]}
    assert found == {file.parent.name for file in (ROOT / "scenarios").glob("*/scenario.toml")}
    code = "from cosim.scenario.finding import locate; print(locate('upward_plane'))"
    assert python("-c", code).strip() == str(site / "cosim" / "shipped" / "upward_plane" / "scenario.toml")
    assert commit_of(ROOT) in python("-m", "cosim", "--version")


def test_the_commit_of_a_checkout_and_of_something_else(tmp_path):
    def git(*arguments):
        identity = ("-c", "user.name=x", "-c", "user.email=x@example.org")
        subprocess.run(["git", *identity, *arguments], cwd=tmp_path, check=True, capture_output=True)

    assert commit_of(tmp_path) == "unknown"
    git("init")
    assert commit_of(tmp_path) == "unknown"
    (tmp_path / "a.py").write_text("x = 1")
    git("add", "a.py")
    git("commit", "-m", "first")
    clean = commit_of(tmp_path)
    assert len(clean) == 40
    (tmp_path / "a.py").write_text("x = 2")
    assert commit_of(tmp_path) == f"{clean}+"


def test_versions_agree():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert f"\nversion: {project['version']}\n" in (ROOT / "CITATION.cff").read_text("utf-8")
    assert f"## {project['version']}" in (ROOT / "CHANGELOG.md").read_text("utf-8")
