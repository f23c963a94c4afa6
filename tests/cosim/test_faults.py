"""What is wrong with a scenario: all of it at once, with the file that it stands in, and before anything runs."""

import time

import pytest

from cosim.analysis.reference import FeatureError, load_reference, parse_reference
from cosim.scenario.errors import ScenarioError
from cosim.scenario.loading import load_scenario
from cosim.scenario.rules.table import RULES
from cosim.scenario.units import Unit, to_si

CONE = "icefloe_gla_upward_cone"  #: 60 deg, radius 2.5 m, ice of 1 m, cells of 1 m
FLOE = "van_vliet_2018_floe_55m_centre"
CASE = """
[scenario]
title = "t"
duration = "10 s"
[ice]
thickness = "0.8 m"
density = "900 kg/m^3"
youngs_modulus = "5 GPa"
poisson_ratio = 0.3333333333333333
flexural_strength = "500 kPa"
compressive_strength = "2.5 MPa"
[water]
density = "1025 kg/m^3"
[sheet]
length = "80 m"
width = "60 m"
nodes = [41, 31]
back = "held"
[structure]
kind = "cone"
slope = "55 deg"
waterline_radius = "5 m"
[contact]
strength = "2.5 MPa"
friction = 0.1
[drift]
velocity = "0.3 m/s"
"""


def faults(case, *overrides):
    with pytest.raises(ScenarioError) as error:
        load_scenario(case, overrides)
    for line in error.value.faults:
        assert "\n" not in line
        assert len(line) < 400
    return error.value.faults


@pytest.mark.parametrize(
    ("key", "text", "says"),
    [
        ("ice.thickness", "12,5 m", "a comma is no decimal point; write 12.5 m"),
        ("ice.thickness", "1 500 mm", "digits are not grouped"),
        ("ice.thickness", "1\u202f500 mm", "digits are not grouped"),
        ("ice.thickness", "1.500,0 mm", "digits are not grouped"),
        ("ice.thickness", "1'500 mm", "digits are not grouped"),
        ("ice.thickness", "9**9**9 m", "nothing is computed"),
        ("ice.thickness", "2**2**2**2**2**2 m", "nothing is computed"),
        ("ice.thickness", "3 m**9**9**9", "not a quantity"),
        ("ice.thickness", "3 m + 2 m", "not a quantity"),
        ("ice.thickness", "3" * 100 + " m", "it has 102 characters"),
        ("ice.thickness", "\u0663 m", "not a quantity"),
        ("ice.thickness", "3 percent m", "wrong unit"),
        ("structure.slope", "45 %", "% is no unit"),
        ("structure.slope", "45 percent", "not a unit of angles"),
        ("structure.slope", "45 degC", "not a unit of angles"),
        (
            "ice.flexural_strength",
            "0.7 mPa",
            'outside of 1 kPa to 100 MPa; for example "500 kPa", did you mean "0.7 MPa"?',
        ),
    ],
)
def test_a_quantity_is_one_number_and_one_unit(key, text, says):
    began = time.monotonic()
    (line,) = faults(CONE, f"{key}={text!r}".replace("\\u202f", "\u202f"))
    assert time.monotonic() - began < 5.0  # towers of powers were computed
    assert line.startswith(f"--set: {key} = ")
    assert says in line


@pytest.mark.parametrize(
    ("text", "value"), [("3m", 3.0), ("3 m²", None), ("300\tcm", 3.0), ("+3e0 m", 3.0), ("3.\u00b7", None)]
)
def test_what_is_one_number_and_one_unit_is_read(text, value):
    if value is not None:
        assert to_si(text, Unit("m", "3 m")) == pytest.approx(value, rel=1e-15)
    else:
        with pytest.raises(ValueError, match="for example"):
            to_si(text, Unit("m", "3 m"))


def test_angles_in_their_units():
    for text in ("45 deg", "45°", "50 grad", "0.125 turn", "2700 arcmin"):
        assert to_si(text, Unit("rad", "")) == pytest.approx(0.7853981633974483, rel=1e-12)


@pytest.mark.parametrize(
    ("case", "overrides", "says"),
    [
        (CONE, ["structure.top='5 cm'"], "structure.top = '5 cm': the ice passes over it; use more than its freeboard"),
        (CONE, ["structure.top='5000 km'"], "structure.top = '5000 km': outside of"),
        (CONE, ["structure.toe_depth='1001 m'"], "structure.toe_depth = '1001 m': outside of"),
        (CONE, ["structure.toe_depth='0.5 m'"], "structure.toe_depth = '0.5 m': the ice passes under the slope"),
        (CONE, ["structure.waterline_radius='0.4 m'", "structure.neck_radius='0.2 m'"], "wider than the structure"),
        (CONE, ["contact.friction=1e300"], "contact.friction = 1e+300: "),
        (CONE, ["contact.friction=0.6"], "contact.friction = 0.6: ice does not slide on a slope of 60 deg"),
        (CONE, ["rubble.friction_structure=0.6"], "use less than 1 / tan(slope) = 0.577"),
        (CONE, ["ice.compressive_strength='600 kPa'"], "ice.compressive_strength = '600 kPa': 600 kPa is below the"),
        (FLOE, ["sheet.nodes=[5, 5]"], "sheet.nodes = [5, 5]: cells of 13.75 m are not below twice the width"),
        (FLOE, ["sheet.nodes=[40000, 40000]"], "1600000000 nodes are more than a machine holds"),
        (FLOE, ["scenario.seed=-1"], "scenario.seed = -1: input should be greater than or equal to 0"),
        (FLOE, ["scenario.duration='1e6 s'", "coupling.window='5 ms'"], "more than 1e+07 time windows"),
        (FLOE, ["water.current=['1e300 m/s', '0 m/s']"], "water.current"),
        (FLOE, ["scenario.title='a\u001b[31mb'"], "one line of plain text"),
    ],
)
def test_ranges_are_checked_before_the_run(case, overrides, says):
    lines = faults(case, *overrides)
    assert any(says in line for line in lines), lines


def test_friction_that_slides_is_taken_up_to_the_limit():
    assert load_scenario(CONE, ["contact.friction=0.57", "rubble.friction_structure=0.57"]).contact.friction == 0.57


@pytest.mark.parametrize(
    ("points", "overrides", "says"),
    [
        ("[['-4 m', '0.6 m'], ['4 m', '1 m']]", [], "wider than the structure of 1.6 m"),
        ("[['-4 m', '3 m'], ['4 m', '4.2 m']]", ["contact.friction=0.2"], "slope of 81.5 deg"),
        ("[['-4 m', '3 m'], ['4 m', '4.2 m']]", ["structure.top='3 m'"], "ends at 4 m, the structure at 3 m"),
        ("[['1 m', '3 m'], ['4 m', '4.2 m']]", [], "misses the waterline"),
        ("[]", [], "write several values in brackets"),
        ("[['-1 m', '1 m']]", [], "two or more points"),
    ],
)
def test_a_profile_is_checked_where_the_ice_meets_it(tmp_path, points, overrides, says):
    file = tmp_path / "mine.toml"
    shape = 'kind = "cone"\nslope = "55 deg"\nwaterline_radius = "5 m"\n'
    file.write_text(CASE.replace(shape, f'kind = "profile"\ntop = "4 m"\nprofile = {points}\n'))
    lines = faults(file, *overrides)
    assert any(says in line for line in lines), lines


def test_all_faults_are_told_at_once(tmp_path):
    file = tmp_path / "mine.toml"
    text = CASE.replace('"0.8 m"', "0.8").replace('"55 deg"', '"55 %"').replace('back = "held"', "bck = 1")
    text = text.replace('"1025 kg/m^3"', '"1025 kg"').replace('"0.3 m/s"\n', '"0.3 m/s"\n[fnord]\nx = 1\n')
    file.write_text(text.replace('"500 kPa"', '"5 MPa"').replace('"10 s"', '"10.01 s"'))
    lines = [line.removeprefix(f"{file}: ") for line in faults(file)]
    keys = sorted(line.split(" = ")[0].split(":")[0].split(" is missing")[0] for line in lines)
    assert keys == sorted(
        [
            "fnord",
            "ice.compressive_strength",  # below the flexural strength: a rule, although other keys cannot be read
            "ice.thickness",
            "scenario.duration",  # no whole number of windows
            "sheet.back",
            "sheet.bck",
            "structure.slope",
            "water.density",
        ]
    )
    with pytest.raises(ScenarioError, match=r"\(and 7 more: `cosim check` tells all\)"):
        load_scenario(file)


def test_a_rule_on_a_value_that_could_not_be_read_is_silent(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(CASE.replace('"1025 kg/m^3"', '"1025 kg"').replace('"900 kg/m^3"', '"1100 kg/m^3"'))
    (line,) = faults(file)
    assert "water.density" in line  # whether the ice sinks is not known


def test_every_rule_can_be_broken(tmp_path):
    """Each rule has a fault above or in `test_scenario.py`; here: none of them is silent for all cases."""
    changes = {
        "stiffness_is_positive": ["ice.poisson_ratio=0.4"],
        "ice_floats": ["ice.density='1100 kg/m^3'"],
        "ice_floats_over_the_bed": ["water.depth='70 cm'"],
        "compression_is_strongest": ["ice.compressive_strength='200 kPa'"],
        "criteria_have_their_strengths": ["fracture.criteria=['spalling']"],
        "is_a_square_lattice": ["sheet.nodes=[41, 41]"],
        "structure_is_before_the_sheet": ["sheet.axis_from_side='70 m'"],
        "beam_test_holds_for_the_mesh": [
            "ice.beam_test={length='6 m', width='0.5 m', failure_load='10 kN'}",
            "fracture.cracks='open'",
            "ice.tensile_strength='500 kPa'",
        ],
        "structure_is_wider_than_a_cell": ["structure.waterline_radius='0.8 m'"],
        "has_a_shape": ["structure.kind='plane'"],
        "narrows_to_its_neck": ["structure.neck_radius='6 m'"],
        "ends_at_its_tip": ["structure.toe_depth='9 m'", "structure.slope='30 deg'"],
        "profile_is_that_of_a_body": ["structure.profile=[['-1 m', '1 m'], ['-2 m', '3 m']]"],
        "ice_meets_the_slope": ["structure.top='1 cm'"],
        "ice_can_slide": ["contact.friction=0.9"],
        "lockstep_marches": ["coupling.scheme='lockstep'", "fracture.cracks='open'", "ice.tensile_strength='500 kPa'"],
        "bounds_enclose_the_window": ["coupling.longest_window='0.1 s'"],
        "times_are_whole_multiples": ["coupling.window='7 ms'"],
        "duration_is_whole": ["scenario.duration='10.01 s'"],
        "frames_are_whole": ["recording.every='10 ms'"],
        "fields_are_drawn_or_read": ["ice.strength_field={}"],
        "card_marches_open_cracks": ["fracture.device='cuda'"],
        "motion_has_its_keys": ["structure.motion.kind='modal'"],
        "rubble_comes_from_one_place": ["sheet.gap='5 m'", "rubble.initial_volume='20 m^3'"],
        "something_moves": ["drift.velocity='0 m/s'"],
    }
    assert set(changes) == {rule.__name__ for rule in RULES}
    file = tmp_path / "mine.toml"
    file.write_text(CASE)
    load_scenario(file)
    for name, overrides in changes.items():
        assert faults(file, *overrides), name


def test_a_fault_of_a_base_names_the_base(tmp_path):
    (tmp_path / "common.toml").write_text(CASE.replace('"0.8 m"', '"0.8"'))
    case = tmp_path / "case.toml"
    case.write_text('base = "common.toml"\n[drift]\nvelocity = "0.3 km"\n')
    lines = faults(case)
    assert [line.split(": ")[0].rsplit("/")[-1] for line in lines] == ["common.toml", "case.toml"]
    (line,) = faults(case, "ice.thickness=1 m", "drift.velocity=1 m")
    assert line.startswith("--set: drift.velocity")


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (CASE.encode("utf-16"), "it looks like UTF-16"),
        (CASE.replace('"t"', '"Tür"').encode("latin-1"), "byte 0xfc in line 3"),
        (b"\x00\x01\x02", "not valid TOML"),
        (b"a = " + b"[" * 100_000, "nested too deeply"),
        (b"a = " + b"9" * 10_000, "not valid TOML"),
        (b"a = 0x" + b"f" * 10_000, "unknown key"),
        (b"#" * 2_000_000, "2.0 MB is no scenario"),
        (b"ice = 3\nwater.density = 3", "ice = 3: is a section; write it as [ice] with its keys below"),
        (b'base = "' + b"x" * 5000 + b'"', "is no file"),
    ],
)
def test_what_is_no_scenario_is_one_line(tmp_path, data, says):
    file = tmp_path / "mine.toml"
    file.write_bytes(data)
    assert any(says in line for line in faults(file))


def test_a_byte_order_mark_is_read(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_bytes(b"\xef\xbb\xbf" + CASE.encode())
    assert load_scenario(file).ice.thickness == 0.8
    reference = load_scenario(FLOE).folder / "reference.toml"
    (tmp_path / "reference.toml").write_bytes(b"\xef\xbb\xbf" + reference.read_bytes())
    assert load_reference(tmp_path) == load_reference(reference)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ('quantity = "peak_load"\nunit = "m"', "unit = 'm': peak_load is measured in N; write \"N\""),
        ('quantity = "event_time"\nunit = "N"\nevent = "split"', "event_time is measured in s"),
        ('quantity = "peak_load"\nunit = "N"\nmeasured = ["3 N", "2 N"]', "from the lower to the higher value"),
        ('quantity = "peak_load"\nunit = "N"\nphase = "melting"', "use one of breaking, rotating, sliding"),
        ('quantity = "peak_load"\nunit = "N"\ncomponent = 3', "component = 3"),
        ('quantity = "encounter_load"\nunit = "N"\nn = "one"', "n = 'one'"),
        ('quantity = "cycle_period"\nunit = "s"\nsmooth = -1.0', "smooth = -1.0: use a value from 0 to 1e6"),
        ('quantity = "cycle_period"\nunit = "s"\nsmooth = nan', "finite number"),
        ('quantity = "peak_load"\nunit = "N"\nover = "-1 s"', "give a time"),
        ('quantity = "peak_load"\nunit = "N"\nsource = ["a"]', "one line of plain text"),
    ],
)
def test_a_reference_is_read_as_strictly(change, says):
    text = f'[[feature]]\nname = "a"\n{change}\n' + ("" if "source" in change else 'source = "s"\n')
    with pytest.raises(FeatureError) as error:
        parse_reference(text, "r.toml")
    assert says in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("text", ["feature = 3", "feature = [3]", 'title = 3\n[[feature]]\nname = "a"', "fnord = 1"])
def test_a_reference_of_wrong_form_is_one_line(text):
    with pytest.raises(FeatureError, match=r"^r\.toml: "):
        parse_reference(text, "r.toml")
