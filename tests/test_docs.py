"""The documentation cannot go stale: it builds, its commands and files are accepted, its tables hold what is there."""

from __future__ import annotations

import importlib.util
import math
import re
import shlex
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import typer
from pydantic import Field

from cosim.analysis.features import QUANTITIES
from cosim.analysis.reference import parse_reference
from cosim.build import build_structure
from cosim.cli.entry import app
from cosim.loads import LOADS
from cosim.recording import messages
from cosim.recording.channels import CHANNELS
from cosim.recording.reader import messages as stored
from cosim.recording.reader import read_run
from cosim.recording.writer import Recorder
from cosim.scenario.loading import load_scenario
from cosim.scenario.model import ScenarioModel
from cosim.scenario.section import Section
from cosim.scenario.units import Length
from cosim.simulation import run_scenario
from cosim.structures import KINDS
from coupling import schemes
from coupling.ledger import Ledger
from coupling.scheduler import Scheduler
from lattice import stiffness
from lattice.criteria.table import CRITERIA
from lattice.ice import Ice

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```', re.M | re.S)


def _module(name: str, file: Path) -> ModuleType:
    """A file that stands in no package."""
    spec = importlib.util.spec_from_file_location(name, file)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


HOOKS = _module("docs_hooks", ROOT / "docs" / "hooks.py")


class Depth(Section):
    """[planted.depth] Below water."""

    least: Length = 2.5  #: of the toe [m]


class Planted(Section):
    """[planted] A section with keys of every kind."""

    #: which way,
    #: in two lines
    way: str = "up"
    count: int = Field(3, ge=1, le=9)  #: of sides
    depth: Depth


class Mute(Section):
    """[mute] A key that says nothing."""

    size: Length


class Files(Section):
    """All sections of a planted file."""

    planted: Planted


class MuteFile(Section):
    """A planted file with a mute key."""

    mute: Mute


def _blocks(kind: str) -> list[tuple[str, str, str]]:
    """Page, title and text of all fenced blocks of a kind."""
    return [
        (page.name, title, text)
        for page in PAGES
        for found, title, text in BLOCK.findall(page.read_text("utf-8"))
        if found == kind
    ]


def _commands() -> list[str]:
    lines = [
        line
        for _, _, text in _blocks("sh")
        for line in text.replace("\\\n", " ").splitlines()
        if "uv run cosim" in line
    ]
    return [line.partition("uv run cosim ")[2].partition(" #")[0].strip() for line in lines]


def test_every_key_of_a_scenario_stands_in_the_reference_with_its_meaning() -> None:
    text = HOOKS.reference(ScenarioModel)
    for name, section in HOOKS.sections(ScenarioModel):
        table = text.split(f"## [{name}]\n")[1].split("\n## ")[0]
        keys = [k for k, f in section.model_fields.items() if HOOKS.model_of(f.annotation) is None]
        rows = re.findall(r"^\| `(\w+)` \|.*\| (.+) \|$", table, re.M)
        assert [key for key, _ in rows] == keys
        assert all(meaning.strip() for _, meaning in rows)


def test_the_reference_follows_the_models() -> None:
    text = HOOKS.reference(Files)
    assert "| `count` | - | whole number, >= 1 and <= 9 | `3` | of sides |" in text
    assert '| `least` | m | `"3 m"` | 2.5 m | of the toe |' in text
    assert "which way, in two lines |" in text
    assert "## [planted.depth]\n\nBelow water." in text


def test_a_key_without_a_meaning_is_refused() -> None:
    with pytest.raises(ValueError, match=r"mute\.size has no meaning"):
        HOOKS.reference(MuteFile)


def test_the_site_builds_strictly_and_loads_nothing_from_elsewhere(tmp_path: Path) -> None:
    pytest.importorskip("mkdocs")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "-d", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    pages = {p.relative_to(tmp_path).as_posix(): p.read_text("utf-8") for p in tmp_path.rglob("*.html")}
    assert "compressive_strength" in pages["scenario.html"]
    assert (tmp_path / "scenarios/basin_2010_floe_55m_centre/replay.png").is_file()
    for name, page in pages.items():
        assert not re.findall(r'<(?:script|img)[^>]+src="(?:https?:)?//|<link[^>]+stylesheet[^>]+"https?://', page), (
            name
        )


@pytest.mark.parametrize("line", _commands())
def test_commands_of_the_pages_are_accepted(line: str) -> None:
    name, *arguments = shlex.split(line)
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    commands[name].make_context(name, arguments)  # parses, does not run


def test_the_first_own_case_is_a_scenario_and_its_measurements_a_reference(tmp_path: Path) -> None:
    texts = {title: text for _, title, text in _blocks("toml") if title}
    (tmp_path / "pier.toml").write_text(texts["pier.toml"], "utf-8")
    scenario = load_scenario(tmp_path / "pier.toml")
    assert scenario.ice.thickness == 0.6
    assert not scenario.warnings
    assert len(parse_reference(texts["measured.toml"], "measured.toml").features) == 2


def _titled(title: str) -> str:
    """The example of this title."""
    return next(text for kind in ("python", "toml") for _, name, text in _blocks(kind) if name == title)


def _adds(monkeypatch: pytest.MonkeyPatch, title: str, table: dict[str, Any], name: str) -> dict[str, Any]:
    """Runs an example that adds a line to a table, which loses it again after the test; the names that it makes."""
    monkeypatch.setitem(table, name, None)
    made: dict[str, Any] = {"__name__": "example"}
    exec(compile(_titled(title), title, "exec", dont_inherit=True), made)
    assert table[name] is not None
    return made


QUICK = ("sheet.nodes=[20, 20]", "drift.velocity='0.4 m/s'", "contact.strength='800 kPa'", "rubble.enabled=false")


def test_the_example_of_a_criterion_fails_the_first_cell(monkeypatch: pytest.MonkeyPatch) -> None:
    made = _adds(monkeypatch, "largest_strain.py", CRITERIA, "largest-strain")
    assert made["largest_strain"] is CRITERIA["largest-strain"].judge
    options = (*QUICK, "scenario.duration='4 s'", "fracture.criteria=['largest-strain']")
    first = run_scenario(load_scenario("van_vliet_2018_floe_55m_centre", options)).events[0]
    assert (first.kind, first.cause) == ("cell_failure", "largest-strain")


def test_the_example_of_a_structure_pushes_aside(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without friction the load lies along the normal; the surface has the normal that it says, front and overlap."""
    _adds(monkeypatch, "askew_slope.py", KINDS, "askew-slope")
    smooth = ("structure.kind='askew-slope'", "contact.friction=0", "rubble.enabled=false", "scenario.duration='1 s'")
    scenario = load_scenario("upward_plane", smooth)
    slope, e = build_structure(scenario), 1e-6
    dx_dy, dx_dz = (
        (slope.face_x(3.0 + a * e, -1.0 + b * e) - slope.face_x(3.0, -1.0)) / e for a, b in ((1, 0), (0, 1))
    )
    normal = np.array([-1.0, dx_dy, dx_dz]) / np.linalg.norm([1.0, dx_dy, dx_dz])
    assert slope.normal(3.0, -1.0) == pytest.approx(normal, rel=1e-6)
    overlap, n = slope.overlap(np.array([float(slope.face_x(3.0, -1.0)) + 0.2]), np.array([[3.0]]), np.array([-1.0]))
    assert overlap[0, 0] == pytest.approx(0.2)
    assert n[0, 0] == pytest.approx(normal, rel=1e-6)
    fx, fy, _, _ = run_scenario(scenario).peaks.value
    assert fx > 1e3
    assert fy / fx == pytest.approx(-math.tan(0.2), rel=1e-6)


def test_the_example_of_a_load_has_its_terms(monkeypatch: pytest.MonkeyPatch) -> None:
    _adds(monkeypatch, "wind.py", LOADS, "wind")
    options = (*QUICK, "scenario.duration='1 s'")
    ledger = run_scenario(load_scenario("van_vliet_2018_floe_55m_centre", options)).ledger
    work = 1.3 * 1.5e-3 * 20.0**2 * 55.0**2 * 0.4  # force times drift, after the one second
    assert ledger["wind_load_work"] == pytest.approx(work, rel=0.1)


def test_the_example_of_a_channel_stands_in_a_recording(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    _adds(monkeypatch, "overturning.py", CHANNELS, "/load/overturning")
    options = (*QUICK, "scenario.duration='0.5 s'")
    with Recorder(tmp_path / "run.mcap") as recorder:
        run_scenario(load_scenario("van_vliet_2018_floe_55m_centre", options), [recorder])
    moment = [
        messages.Ledger.FromString(data).value[0] for _, _, data in stored(tmp_path / "run.mcap", ["/load/overturning"])
    ]
    assert moment == pytest.approx(20.0 * read_run(tmp_path / "run.mcap").component("fx"))


def test_the_example_of_a_stiffness_set_is_in_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stiffness, "STIFFNESS_SETS", dict(stiffness.STIFFNESS_SETS))
    exec(_titled("halfway.py"), {})
    ice = Ice(E=5e9, nu=0.2, h=0.6, rho_i=900.0, rho_w=1005.0)
    G = {name: springs(ice).G_dia for name, springs in stiffness.STIFFNESS_SETS.items()}
    assert G["hrennikoff"] < G["equations-matching"]
    assert G["halfway"] == pytest.approx(0.5 * (G["hrennikoff"] + G["equations-matching"]), rel=1e-12)


def test_the_example_of_a_coupling_scheme_couples_closer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(schemes, "SCHEMES", dict(schemes.SCHEMES))
    exec(_titled("serial_twice.py"), {})
    stubs = _module("stubs", ROOT / "tests" / "stubs.py")

    def error(scheme: str) -> float:
        sheet, rubble = stubs.MassOnSpring(), stubs.MassBehindSpring()
        s = Scheduler(sheet, rubble, Ledger(1.0), stubs.NS // 100, schemes.SCHEMES[scheme](schemes.Iteration()))
        for _ in range(200):
            s.macro_step()
        return float(np.linalg.norm(np.concatenate((sheet.state, rubble.state)) - stubs.exact(2.0)))

    assert error("serial-twice") < 0.2 * error("serial-explicit")


def test_the_example_of_an_observer_sees_every_window(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    short = (
        _titled("pier.toml").replace('"40 s"', '"200 ms"').replace("[drift]", "[recording]\nevery = '50 ms'\n[drift]")
    )
    (tmp_path / "pier.toml").write_text(short, "utf-8")
    exec(_titled("printer.py"), {})
    title, *windows = capsys.readouterr().out.splitlines()
    assert title == "Pier with a cone, ice of 60 cm"
    assert [line.split()[0] for line in windows] == ["0.05", "0.1", "0.15", "0.2"]
    assert float(windows[-1].split()[1]) > 1e4


def test_all_quantities_of_a_feature_are_explained() -> None:
    table = (ROOT / "docs/results.md").read_text("utf-8").split("| quantity | is | arguments |")[1].split("\n\n")[0]
    named = {n for row in table.splitlines()[2:] for n in re.findall(r"`(\w+)`", row.split("|")[1])}
    assert named == set(QUANTITIES)


def test_the_readme_is_short_and_leads_to_pages_that_are_there() -> None:
    text = (ROOT / "README.md").read_text("utf-8")
    assert text.count("\n") <= 150
    targets = re.findall(r"\]\(([^)#]+)\)", text)
    assert len(targets) > 10
    assert [t for t in targets if not (ROOT / t).is_file()] == []


def test_decisions_are_short() -> None:
    decisions = (ROOT / "docs/decisions.md").read_text("utf-8").split("\n## ")[1:]
    assert len(decisions) >= 12
    for text in decisions:
        assert len(text.strip().splitlines()) - 2 <= 12, text.splitlines()[0]
