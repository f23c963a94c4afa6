"""Scenario files: read strictly, one line for each fault."""

import dataclasses
import math
import tomllib

import pytest

from cosim.analysis.reference import load_reference
from cosim.scenario.errors import ScenarioError
from cosim.scenario.finding import find_scenarios
from cosim.scenario.loading import load_scenario
from cosim.scenario.model import ScenarioModel
from cosim.scenario.scenario import Scenario

CASES = [
    "van_vliet_2018_floe_165m",
    "van_vliet_2018_floe_34x68m",
    "van_vliet_2018_floe_55m_centre",
    "van_vliet_2018_floe_55m_corner",
]
UPWARD = ["icefloe_gla_upward_cone", "upward_plane"]
FLOE = CASES[0]


def fault(*overrides: str) -> str:
    with pytest.raises(ScenarioError) as error:
        load_scenario(FLOE, overrides)
    text = str(error.value)
    assert "\n" not in text
    assert "pydantic" not in text
    assert len(text) < 300
    return text


@pytest.mark.parametrize(
    ("override", "says"),
    [
        ("ice.thickness=3", ["ice.thickness", "3", "unit", '"3 m"']),
        ("ice.thickness=-3 m", ["ice.thickness", "-3 m", "greater than zero"]),
        ("ice.thickness=3 kg", ["ice.thickness", "3 kg", "wrong unit", "measured in m"]),
        ("ice.thickness=3 blub", ["ice.thickness", "unknown unit"]),
        ("ice.thicknes='3 m'", ["ice.thicknes", "unknown key", "did you mean ice.thickness?"]),
        ("sheet.thickness='3 m'", ["sheet.thickness", "unknown key", "did you mean ice.thickness?"]),
        ("ice.beam_test.lenght='3 m'", ["ice.beam_test.lenght", "did you mean ice.beam_test.length?"]),
        ("fnord.x=1", ["fnord", "unknown key"]),
        ("ice.poisson_ratio=0.4", ["ice.poisson_ratio", "0.4", "negative stiffness: use a value in [0, 1/3]"]),
        ("ice.poisson_ratio=-0.1", ["ice.poisson_ratio", "[0, 1/3]"]),
        ("ice.poisson_ratio=nan", ["ice.poisson_ratio", "finite"]),
        ("ice.poisson_ratio='0.3'", ["ice.poisson_ratio", "number"]),
        ("sheet.nodes=[2, 2]", ["sheet.nodes", "at least 3"]),
        ("sheet.nodes=[60]", ["sheet.nodes", "[60, 60]"]),
        ("sheet.nodes=[60, 40]", ["sheet.nodes", "square", "[60, 60]"]),
        ("sheet.axis_from_side=200 m", ["sheet.axis_from_side", "200 m", "0 to 165 m"]),
        ("coupling.window=7 ms", ["coupling.window", "7 ms", "5 ms or 10 ms"]),
        ("coupling.window=1 ms", ["coupling.window", "nearest: 5 ms"]),
        ("scenario.duration=10.02 s", ["scenario.duration", "10 s or 10.05 s"]),
        ("recording.every=20 ms", ["recording.every", "nearest: 50 ms"]),
        ("coupling.longest_window=100 ms", ["coupling.longest_window", "steering"]),
        ("coupling.tolerance=0", ["coupling.tolerance", "greater than 0"]),
        ("coupling.max_iterations=1", ["coupling.max_iterations", "greater than or equal to 2"]),
        ("coupling.relaxation=1.5", ["coupling.relaxation", "less than or equal to 1"]),
        ("coupling.unconverged=ignore", ["coupling.unconverged", "stop", "count"]),
        ("coupling.steering=wind", ["coupling.steering", "fixed", "power"]),
        ("coupling.scheme=fancy", ["coupling.scheme", "fancy", "known: lockstep, serial-explicit, parallel-explicit"]),
        ("coupling.scheme=serial-implict", ["coupling.scheme", "did you mean serial-implicit?"]),
        ("contact.model=crush", ["contact.model", "crush", "did you mean crushing?"]),
        ("structure.neck_radius=16 m", ["structure.neck_radius", "15 m"]),
        ("structure.kind=plane", ["structure.waterline_radius", "plane"]),
        ("structure.slope=95 deg", ["structure.slope", "1 deg to 89 deg"]),
        ("ice.density=1100 kg/m^3", ["ice.density", "sinks", "1006"]),
        ("ice.density=1006 kg/m^3", ["ice.density", "sinks", "1006"]),
        ("rubble.iterations=0", ["rubble.iterations", "greater than or equal to 1"]),
        ("rubble.enabled=1", ["rubble.enabled", "boolean"]),
        ("contact.friction=inf", ["contact.friction", "finite"]),
        ("thickness=3", ["--set thickness=3", "section.key=value"]),
    ],
)
def test_fault_names_key_value_and_remedy(override, says):
    text = fault(override)
    assert all(part in text for part in says), text


@pytest.mark.parametrize(
    ("bounds", "says"),
    [
        (["coupling.shortest_window=60 ms"], ["coupling.shortest_window", "at most the first window of 50 ms"]),
        (["coupling.longest_window=20 ms"], ["coupling.longest_window", "at least the first window of 50 ms"]),
        (["coupling.longest_window=52 ms"], ["coupling.longest_window", "rubble sub-step 5 ms", "50 ms or 55 ms"]),
    ],
)
def test_bounds_of_steered_windows(bounds, says):
    text = fault("coupling.steering=power", *bounds)
    assert all(part in text for part in says), text


def test_defaults_of_steered_windows():
    c = load_scenario(FLOE, ["coupling.steering=power"]).coupling
    assert c.bounds(0.005) == (0.005, 0.2)


def test_missing_value_shows_an_example(tmp_path):
    text = (load_scenario(FLOE).folder / "scenario.toml").read_text()
    file = tmp_path / "mine.toml"
    file.write_text("\n".join(line for line in text.splitlines() if not line.startswith("thickness")))
    with pytest.raises(ScenarioError, match=r'mine.toml: ice.thickness is missing; add thickness = "0.8 m"'):
        load_scenario(file)


def test_missing_section_is_named(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('[scenario]\ntitle = "x"\nduration = "1 s"\n')
    with pytest.raises(ScenarioError, match=r"ice is missing; add the section \[ice\] \(and 5 more"):
        load_scenario(file)


def test_broken_toml_and_missing_files(tmp_path):
    file = tmp_path / "broken.toml"
    file.write_text("[ice\n")
    with pytest.raises(ScenarioError, match=r"broken.toml: not valid TOML"):
        load_scenario(file)
    with pytest.raises(ScenarioError, match="no such scenario"):
        load_scenario(tmp_path)


def test_faults_of_a_file_name_the_file_and_those_of_an_override_say_so():
    assert fault("ice.thickness=-3 m").startswith("--set: ")
    assert "scenario.toml: structure.waterline_radius" in fault("structure.kind=plane")


def test_poisson_ratio_of_one_third_is_silent_and_less_warns():
    assert load_scenario(FLOE).warnings == ()
    (warning,) = load_scenario(FLOE, ["ice.poisson_ratio=0.3"]).warnings
    assert "rigid rotation" in warning


def test_overrides_are_toml_or_text():
    s = load_scenario(
        FLOE,
        [
            "ice.thickness=2 m",
            'coupling.window="20 ms"',
            "sheet.nodes=[40,40]",
            "rubble.enabled=false",
            "scenario.seed=7",
        ],
    )
    assert (s.ice.thickness, s.window_ns, s.substeps, s.seed) == (2.0, 20_000_000, 4, 7)
    assert s.sheet.nodes == (40, 40)
    assert s.rubble.enabled is False


@pytest.mark.parametrize("overrides", [(), ("ice.thickness=2 m", "rubble.substep=10 ms")])
@pytest.mark.parametrize("case", [*CASES, *UPWARD])
def test_resolved_toml_gives_the_same_scenario(case, overrides, tmp_path):
    s = load_scenario(case, overrides)
    assert ScenarioModel.model_validate(tomllib.loads(s.resolved_toml())) == s.model
    file = tmp_path / "again.toml"
    file.write_text(s.resolved_toml())
    assert load_scenario(file).model == s.model


def test_a_scenario_is_frozen():
    s = load_scenario(FLOE)
    with pytest.raises(dataclasses.FrozenInstanceError):
        s.name = "x"
    with pytest.raises(Exception, match="frozen"):
        s.ice.thickness = 2.0
    with pytest.raises(AttributeError):
        _ = s.fnord


def test_shipped_scenarios_are_found():
    names = [*UPWARD, *CASES]
    assert [folder.name for folder in find_scenarios() if folder.name in names] == sorted(names)


@pytest.mark.parametrize("case", CASES)
def test_table_6_1(case):
    """Van Vliet (2018), Table 6-1, full scale; shear strength and beam test from 6.1, damping from 4.2.1."""
    s: Scenario = load_scenario(case)
    ice, beam = s.ice, s.ice.beam_test
    assert (ice.thickness, ice.density, s.water.density, s.water.gravity) == (3.0, 846.0, 1006.0, 9.81)
    assert ice.youngs_modulus == pytest.approx(8.7e9, rel=1e-12)
    assert (ice.flexural_strength, ice.tensile_strength, ice.compressive_strength) == (750e3, 750e3, 4e6)
    assert (ice.shear_strength, ice.poisson_ratio, ice.material_damping) == (700e3, 1 / 3, 1e-3)
    assert (2 * s.structure.waterline_radius, s.drift.velocity) == (30.0, 0.1)
    assert s.structure.slope == pytest.approx(math.radians(45), rel=1e-12)
    assert (s.contact.friction, s.contact.strength, s.rubble.friction_structure) == (0.1, 200e3, 0.1)
    assert (beam.length, beam.width, beam.failure_load, beam.factor) == (18.0, 6.0, 375e3, 0.75)
    assert 6 * beam.failure_load * beam.length / (beam.width * ice.thickness**2) == pytest.approx(750e3, rel=1e-12)
    assert (s.window_ns, s.substeps, s.water.damping, s.sheet.back) == (50_000_000, 10, 0.1, "held")


@pytest.mark.parametrize(
    ("case", "length", "width", "nodes", "axis"),
    [
        (CASES[0], 165.0, 165.0, (60, 60), 82.5),
        (CASES[1], 34.0, 68.0, (31, 61), 34.0),
        (CASES[2], 55.0, 55.0, (40, 40), 27.5),
        (CASES[3], 55.0, 55.0, (40, 40), 19.0),
    ],
)
def test_floes(case, length, width, nodes, axis):
    sheet = load_scenario(case).sheet
    assert (sheet.length, sheet.width, sheet.nodes, sheet.axis) == (length, width, nodes, axis)
    assert sheet.spacing == pytest.approx(length / (nodes[0] - 1), rel=1e-12)


@pytest.mark.parametrize("case", [*CASES, *UPWARD])
def test_every_value_has_its_source_and_every_case_its_reference(case):
    s = load_scenario(case)
    for line in s.text.splitlines():
        if (
            "=" in line
            and not line.startswith("#")
            and line.split(" =")[0] not in ("title", "description", "scheme", "enabled")
        ):
            assert "#" in line, line
    assert load_reference(s.folder).features
    assert 30 <= len((s.folder / "SOURCE.md").read_text().splitlines()) <= 60


def test_cases_share_a_base(tmp_path):
    """Keys of the case replace those of its base, table by table; what is recorded stands alone."""
    shared = load_scenario("scenarios/van_vliet_2018_floe_165m")
    (tmp_path / "common.toml").write_text(shared.text)
    case = tmp_path / "case.toml"
    case.write_text('base = "common.toml"\n[scenario]\ntitle = "a case"\n[sheet]\nnodes = [40, 40]\n')
    found = load_scenario(case)
    assert found.title == "a case"
    assert found.sheet.nodes == (40, 40)
    assert found.sheet.length == 165.0
    assert found.ice == shared.ice
    assert "Table 6-1" in found.text
    (tmp_path / "alone.toml").write_text(found.resolved_toml())
    assert load_scenario(tmp_path / "alone.toml").model == found.model


@pytest.mark.parametrize(
    ("line", "words"),
    [('base = "nowhere.toml"', "nowhere.toml"), ("base = 3", "base = 3"), ('base = "case.toml"', "its own base")],
)
def test_a_base_that_cannot_be_read_is_named(tmp_path, line, words):
    case = tmp_path / "case.toml"
    case.write_text(line + "\n")
    with pytest.raises(ScenarioError, match=words):
        load_scenario(case)
