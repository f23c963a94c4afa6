"""Writing a case: `cosim new`, `keys`, `check`, the schema for editors, and a run that is only tried."""

import json
import re
import subprocess
import sys
import tomllib

import pytest
from jsonschema import Draft202012Validator

from cosim.scenario.finding import find_scenarios, locate
from cosim.scenario.judge import JUDGES, doubts_of
from cosim.scenario.keys import keys_of
from cosim.scenario.loading import load_scenario
from cosim.scenario.model import ScenarioModel
from cosim.scenario.schema import schema_of

SCHEMA = Draft202012Validator(schema_of(ScenarioModel))


@pytest.mark.parametrize(("option", "breaking"), [((), "upward"), (("--cone",), "upward"), (("--slope",), "downward")])
def test_a_new_scenario_is_one_without_fault_or_doubt(cosim, tmp_path, option, breaking):
    code, out, err = cosim("new", tmp_path / "pier", *option)
    assert (code, err) == (0, "")
    assert "cosim check" in out
    s = load_scenario(tmp_path / "pier")
    assert (s.structure.breaking, s.warnings, doubts_of(s.model)) == (breaking, (), [])
    for line in s.text.splitlines():
        assert "=" not in line or line.startswith("#") or "  # " in line  # every key with its meaning
    SCHEMA.validate(tomllib.loads(s.text))
    assert json.loads((tmp_path / "pier/scenario.schema.json").read_text()) == schema_of(ScenarioModel)
    assert s.text.startswith("#:schema ./scenario.schema.json\n")
    assert not re.search(r"\d", s.title)  # what is edited next is not in its title


@pytest.mark.parametrize("name", ["icefloe_gla_upward_cone", "basin_2010_floe_55m_centre"])
def test_a_new_scenario_from_another_one(cosim, tmp_path, name):
    assert cosim("new", tmp_path / "mine", "--from", name)[0] == 0
    assert load_scenario(tmp_path / "mine").model == load_scenario(name).model
    assert "base" not in tomllib.loads((tmp_path / "mine/scenario.toml").read_text())
    copied = (tmp_path / "mine/reference.toml").read_text()
    assert copied == (locate(name).parent / "reference.toml").read_text()


def test_new_keeps_what_is_there(cosim, tmp_path):
    (tmp_path / "scenario.toml").write_text("mine")
    code, _, err = cosim("new", tmp_path)
    assert (code, err.count("\n")) == (2, 1)
    assert "is there already and is kept" in err
    assert (tmp_path / "scenario.toml").read_text() == "mine"
    code, _, err = cosim("new", tmp_path / "scenario.toml")
    assert (code, "is a file" in err) == (2, True)
    code, _, err = cosim("new", tmp_path / "a", "--cone", "--slope")
    assert (code, "exclude each other" in err) == (2, True)
    assert not (tmp_path / "a").exists()


NARROW = """
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
from cosim.cli import main
main()
"""


def test_a_new_case_appears_whole_or_not_at_all(cosim, tmp_path):
    """The scenario fits on the disk, its schema does not; and of two files one is there already."""
    for folder in (tmp_path / "pier", tmp_path):
        done = subprocess.run([sys.executable, "-c", NARROW, "new", folder], capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr.count("\n")) == (1, 1), done.stderr
        assert "scenario.schema.json: File too large; free space or write elsewhere" in done.stderr
        assert list(tmp_path.iterdir()) == []
    (tmp_path / "scenario.schema.json").write_text("mine")
    code, _, err = cosim("new", tmp_path)
    assert (code, err.count("\n"), "is there already and is kept" in err) == (2, 1, True)
    assert [(f.name, f.read_text()) for f in tmp_path.iterdir()] == [("scenario.schema.json", "mine")]
    (tmp_path / "link").mkdir()
    (tmp_path / "link/scenario.toml").symlink_to(tmp_path / "elsewhere.toml")
    assert cosim("new", tmp_path / "link")[0] == 2
    assert not (tmp_path / "elsewhere.toml").exists()
    code, _, err = cosim("new", tmp_path / "no/pier")
    assert (code, err.count("\n")) == (2, 1)


def test_two_values_are_edited_checked_and_tried(cosim, tmp_path):
    """The way of a new user, without the run itself."""
    cosim("new", tmp_path / "pier")
    file = tmp_path / "pier/scenario.toml"
    file.write_text(file.read_text().replace('"0.8 m"', '"60 cm"').replace('"0.3 m/s"', '"0.2 m/s"'))
    code, out, err = cosim("check", tmp_path / "pier")
    assert (code, err) == (0, "")
    assert "no fault" in out
    content = json.loads(cosim("check", tmp_path / "pier", "--json")[1])
    assert content["faults"] == []
    assert content["facts"]["averaging_s"] == pytest.approx(0.5 * 0.6**0.5, rel=1e-12)
    assert content["facts"]["characteristic_length_m"] == pytest.approx(10.02, abs=0.01)
    assert (content["cost"]["nodes"], content["cost"]["windows"]) == (1681, 600)


def test_check_tells_every_fault_on_a_line_of_its_own(cosim, tmp_path):
    overrides = ("--set", "ice.thickness=3", "--set", "structure.slope='45 %'", "--set", "contact.frction=0.1")
    code, out, err = cosim("check", "icefloe_gla_upward_cone", *overrides)
    assert (code, out) == (2, "")
    lines = err.splitlines()
    assert len(lines) == 4
    assert all(line.startswith("cosim: ") for line in lines)
    assert lines[-1] == "cosim: icefloe_gla_upward_cone: 3 faults; correct them"
    code, out, _ = cosim("check", "icefloe_gla_upward_cone", *overrides, "--json")
    assert (code, len(json.loads(out)["faults"])) == (2, 3)


def test_check_tells_what_is_wrong_with_files_that_the_scenario_names(cosim, tmp_path):
    """Each as a run would, but all of them at once."""
    (tmp_path / "bad.csv").write_text("x,y,strength\n1,2,much\n")
    given = {
        "sheet.broken": "'nowhere.csv'",
        "ice.strength_field.file": f"'{tmp_path / 'bad.csv'}'",
        "ice.thickness_field": "{variation=0.9,distribution='normal'}",
        "structure.motion": "{kind='prescribed',file='nowhere.csv'}",
    }
    options = [f"--set={key}={value}" for key, value in given.items()]
    code, out, err = cosim("check", "icefloe_gla_upward_cone", *options)
    lines = err.splitlines()
    assert (code, len(lines)) == (2, 5), err
    for line, says in zip(
        lines,
        ("column strength holds what is no number", "use lognormal", "no such file", "nowhere.csv", "4 faults"),
        strict=True,
    ):
        assert says in line
    assert "no fault" not in out
    assert len(json.loads(cosim("check", "icefloe_gla_upward_cone", *options, "--json")[1])["faults"]) == 4


def test_a_sheet_that_does_not_fit_this_machine_is_refused_before_it_is_tried(cosim, monkeypatch):
    monkeypatch.setattr("cosim.scenario.cost.memory_of_this_machine", lambda: 1e9)
    options = ("--set", "sheet.nodes=[501,301]")
    for command in (("check",), ("run", "--dry-run"), ("run",)):
        code, _, err = cosim(*command, "icefloe_gla_upward_cone", *options)
        assert code == 2
        assert "150801 nodes need about 1.5 GB of memory, this machine has 1 GB" in err


@pytest.mark.parametrize(
    ("override", "key"),
    [
        ("ice.flexural_strength='2 MPa'", "ice.flexural_strength"),
        ("ice.compressive_strength='20 MPa'", "ice.compressive_strength"),
        ("contact.strength='100 MPa'", "contact.strength"),
        ("ice.youngs_modulus='20 GPa'", "ice.youngs_modulus"),
        ("ice.density='700 kg/m^3'", "ice.density"),
        ("water.density='1200 kg/m^3'", "water.density"),
        ("drift.velocity='1 mm/s'", "drift.velocity"),
        ("drift.velocity='5 m/s'", "drift.velocity"),
        ("ice.poisson_ratio=0.2", "ice.poisson_ratio"),
        ("sheet.nodes=[11,11]", "sheet.nodes"),
        ("sheet.nodes=[301,301]", "sheet.nodes"),
        ("structure.waterline_radius='2.5 m'", "sheet.nodes"),
        ("ice.thickness='3 m'", "sheet.length"),
        ("structure.waterline_radius='20 m'", "sheet.width"),
        ("scenario.duration='2 s'", "scenario.duration"),
        ("scenario.duration='300 s'", "scenario.duration"),
    ],
)
def test_what_is_unlikely_is_told_and_stops_nothing(cosim, tmp_path, override, key):
    cosim("new", tmp_path / "pier")
    code, out, _ = cosim("check", tmp_path / "pier", "--set", override)
    assert code == 0
    assert f"doubtful: {key}: " in out


def test_every_judge_is_in_the_table():
    assert len({judge.__name__ for judge in JUDGES}) == len(JUDGES) == 8


def test_keys_tell_all_of_them_with_meaning_unit_range_and_default(cosim):
    found = {row["key"]: row for row in json.loads(cosim("keys", "--json")[1])}
    assert set(found) == {key.name for key in keys_of(ScenarioModel)}
    assert len(found) > 80
    assert all(row["meaning"] and row["example"] != "..." for row in found.values())
    assert all(row["range"] for row in found.values() if row["unit"] and not row["example"].startswith("["))
    h = found["ice.thickness"]
    assert (h["unit"], h["range"], h["required"], h["default"]) == ("m", "1 mm to 30 m", True, None)
    assert found["recording.every"]["default"] == "0.5 s"
    assert found["coupling.window"]["default"] is None  # follows from the case
    assert found["structure.kind"]["choices"] == ["cone", "multi-sided-cone", "plane", "profile"]
    assert found["structure.slope"]["example"] != found["baseline.rubble_slope"]["example"]  # by key, not by kind
    out = cosim("keys", "ice.th")[1]
    assert out.startswith("ice.thickness: [m], ")
    assert cosim("keys", "drift")[1].count("drift.") == 1
    code, _, err = cosim("keys", "ice.thicknes_")
    assert (code, "did you mean ice.thickness?" in err) == (2, True)


def test_the_examples_of_all_keys_can_be_read():
    from pydantic import ValidationError

    from cosim.scenario.keys import example_value, field_of

    for key in keys_of(ScenarioModel):
        path = key.name.split(".")
        table = value = {}
        for part in path[:-1]:
            table[part] = table = {}
        table[path[-1]] = example_value(field_of(ScenarioModel, path))
        with pytest.raises(ValidationError) as error:  # other keys are missing
            ScenarioModel.model_validate(value)
        assert key.name not in {".".join(map(str, e["loc"])) for e in error.value.errors()}


def test_the_schema_takes_every_scenario_of_the_project_and_refuses_slips():
    for folder in find_scenarios():
        SCHEMA.validate(tomllib.loads((folder / "scenario.toml").read_text()))
        good = tomllib.loads(load_scenario(folder).resolved_toml())
        SCHEMA.validate(good)
    for section, key, value in [
        ("ice", "thickness", 3.0),
        ("ice", "thickness", "12,5 m"),
        ("ice", "thicknes", "3 m"),
        ("structure", "kind", "cube"),
        ("contact", "friction", -0.1),
        ("rubble", "enabled", "yes"),
        ("scenario", "seed", -1),
    ]:
        bad = good | {section: good[section] | {key: value}}
        assert not SCHEMA.is_valid(bad), (section, key)
    assert not SCHEMA.is_valid({k: v for k, v in good.items() if k != "ice"})
    assert SCHEMA.is_valid({"base": "common.toml"})


def test_the_schema_is_printed(cosim):
    assert json.loads(cosim("keys", "--schema")[1]) == schema_of(ScenarioModel)
    described = schema_of(ScenarioModel)["properties"]["ice"]["properties"]["thickness"]
    assert described["examples"] == ["0.8 m"]
    assert described["description"] == "h, the same everywhere [m]; 1 mm to 30 m"
