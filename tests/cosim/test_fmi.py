"""The ice as an FMU, and an FMU as the structure: bits, states, errors, validation by FMPy."""

import gc
import sys
from pathlib import Path

import numpy as np
import pytest

from cosim.build import build
from cosim.errors import InputError
from cosim.fmi.driven import Driven
from cosim.fmi.ice import Ice
from cosim.fmi.write import write_fmu
from cosim.scenario.loading import load_scenario
from coupling.interface import SimulationError

fmpy = pytest.importorskip("fmpy")
pytest.importorskip("pythonfmu")
pytest.importorskip("pythonfmu3")

CASE = "van_vliet_2018_floe_55m_centre"
SMALL = ("sheet.nodes=[14, 14]", "contact.strength='800 kPa'", "drift.velocity='0.4 m/s'", "scenario.duration='1.5 s'")
SHEET = (*SMALL, "rubble.enabled=false", "fracture.longest_step='50 ms'")
SOFT = ("structure.motion.kind='spring'", "structure.motion.surge.mass='1000 t'")
SOFT += ("structure.motion.surge.stiffness='4 MN/m'", "structure.motion.surge.damping='40 kN*s/m'")


def loads(*overrides):
    s = build(load_scenario(CASE, [*SHEET, *overrides]))
    return np.array([s.macro_step().load.sum(axis=0) for _ in range(30)])


@pytest.fixture(scope="module")
def rests():
    return loads()


@pytest.fixture(scope="module", params=[2, 3], ids=["fmi2", "fmi3"])
def ice_fmu(request, tmp_path_factory):
    out = tmp_path_factory.mktemp("fmu") / "ice.fmu"
    before = list(sys.path)
    write_fmu(load_scenario(CASE, list(SHEET)), out, request.param)
    assert sys.path == before
    assert {2: "brash_ice", 3: "brash_ice_3"}[request.param] not in sys.modules
    return out


def test_fmpy_finds_nothing_wrong(ice_fmu):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(ice_fmu)) == []
    about = fmpy.read_model_description(str(ice_fmu))
    units = {v.name: v.unit for v in about.modelVariables}
    assert (units["fx"], units["breaking_my"], units["surge"], units["pitch_rate"]) == ("N", "N.m", "m", "rad/s")
    assert all(v.description for v in about.modelVariables)
    assert about.defaultExperiment.stepSize == "0.05"
    assert about.coSimulation.canGetAndSetFMUstate
    assert about.coSimulation.canHandleVariableCommunicationStepSize


def test_it_gives_the_loads_of_a_run_twice_in_one_process(ice_fmu, rests):
    for _ in range(2):
        out = fmpy.simulate_fmu(str(ice_fmu), stop_time=1.5, step_size=0.05, output_interval=0.05, output=["fx", "fz"])
        got = np.column_stack((out["fx"], out["fz"]))[1:]
        assert np.abs(got - rests[:, ::2]).max() < 1e-9 * np.abs(rests).max()


class Held:
    """The ice FMU, step by step."""

    def __init__(self, file):
        about = fmpy.read_model_description(str(file))
        self.number = {v.name: v.valueReference for v in about.modelVariables}
        self.fmu = fmpy.instantiate_fmu(fmpy.extract(str(file)), about, "CoSimulation")
        if about.fmiVersion == "2.0":
            self._get, self._set = self.fmu.getReal, self.fmu.setReal
            self.fmu.setupExperiment(startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self._get, self._set = self.fmu.getFloat64, self.fmu.setFloat64
            self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()

    def step(self, t, length):
        self.fmu.doStep(currentCommunicationPoint=t, communicationStepSize=length)

    def set(self, **values):
        self._set([self.number[n] for n in values], list(values.values()))

    def get(self, *names):
        return self._get([self.number.get(n, 9999) for n in names])


def test_steps_states_and_what_is_refused(ice_fmu, rests):
    from fmpy.fmi1 import FMICallException

    ice = Held(ice_fmu)
    for t, length in ((0.0, 0.03), (0.05, 0.05), (0.0, 2.0), (0.0, float("nan")), (float("inf"), 0.05)):
        with pytest.raises(FMICallException):
            ice.step(t, length)
    ice.step(0.0, 0.1)  # two windows: their mean
    assert ice.get("fx")[0] == pytest.approx(rests[:2, 0].mean(), rel=1e-12)
    state = ice.fmu.getFMUState()
    ends = []
    for _ in range(2):
        ice.set(surge=0.01, surge_rate=0.2)
        ice.step(0.1, 0.05)
        ends.append(ice.get("fx", "breaking_my", "fz"))
        ice.fmu.setFMUState(state)
    assert ends[0] == ends[1]
    assert abs(ends[0][0] - rests[2, 0]) > 1e-2 * rests[2, 0]  # twin: the motion is felt
    ice.set(surge=float("nan"))
    with pytest.raises(FMICallException):
        ice.step(0.1, 0.05)
    ice.set(surge=0.0, surge_rate=0.0)
    ice.step(0.1, 0.05)
    assert ice.get("fx")[0] == pytest.approx(rests[2, 0], rel=1e-12)


def test_a_wrong_call_is_an_error_and_no_crash(ice_fmu, rests):
    """A variable that does not exist, or is not to be set; after a collection of garbage the ice still stands there."""
    from fmpy.fmi1 import FMICallException

    ice = Held(ice_fmu)
    for _ in range(3):
        with pytest.raises(FMICallException, match=r"status 4"):
            ice.get("no such variable")
        with pytest.raises(FMICallException, match=r"status 4"):
            ice.set(fx=1.0)
        gc.collect()
        assert ice.get("surge") == [0.0]
    ice.step(0.0, 0.05)
    assert ice.get("fx")[0] == pytest.approx(rests[0, 0], rel=1e-12)
    ice.fmu.terminate()
    ice.fmu.freeInstance()


def test_a_state_of_another_instance_and_a_step_after_the_end_are_errors(ice_fmu, rests):
    """Neither ice is moved by it."""
    from fmpy.fmi1 import FMICallException

    one, other = Held(ice_fmu), Held(ice_fmu)
    one.step(0.0, 0.05)
    state = one.fmu.getFMUState()
    one.step(0.05, 0.05)
    with pytest.raises(FMICallException, match=r"status 4"):
        other.fmu.setFMUState(state)
    assert one.get("fx")[0] == pytest.approx(rests[1, 0], rel=1e-12)
    other.step(0.0, 0.05)
    assert other.get("fx")[0] == pytest.approx(rests[0, 0], rel=1e-12)
    one.fmu.setFMUState(state)
    assert one.get("fx")[0] == pytest.approx(rests[0, 0], rel=1e-12)
    one.fmu.terminate()
    with pytest.raises(FMICallException):
        one.step(0.05, 0.05)


def test_a_run_that_stops_is_an_error_until_a_state_is_set(monkeypatch, tmp_path):
    case = load_scenario(CASE, list(SHEET))
    (tmp_path / "scenario.toml").write_text(case.resolved_toml(), encoding="utf-8")
    driven = Driven(str(tmp_path))
    assert driven.step(0.0, 0.05) == (True, "a step before the initialization has ended")
    driven.start()
    assert driven.step(0.0, 0.05) == (True, "")
    back, fx = driven.save(), driven.values["fx"]
    with monkeypatch.context() as patched:
        patched.setattr(driven._ice._scheduler, "macro_step", lambda: 1 / 0)
        assert driven.step(0.05, 0.05) == (False, "ZeroDivisionError: division by zero")
    assert driven.step(0.05, 0.05)[0] is False
    back()
    assert driven.values["fx"] == fx
    assert driven.step(0.05, 0.05) == (True, "")


def test_the_ice_says_what_is_wrong_with_a_step():
    ice = Ice(load_scenario(CASE, list(SHEET)))
    none = np.zeros(6)
    with pytest.raises(SimulationError, match=r"a step of 0.03 s is no whole number of windows of 0.05 s"):
        ice.step(0.0, 0.03, none, none)
    with pytest.raises(SimulationError, match=r"a step from 1 s, but the ice is at 0 s"):
        ice.step(1.0, 0.05, none, none)
    with pytest.raises(SimulationError, match=r"the case ends at 1.5 s"):
        ice.step(0.0, 5.0, none, none)


@pytest.fixture(scope="module")
def tower(tmp_path_factory):
    """The FMU of `tower_fmu.py`, one that can go back and one that cannot."""
    from pythonfmu import FmuBuilder

    folder, before = tmp_path_factory.mktemp("tower"), list(sys.path)
    script = Path(__file__).with_name("tower_fmu.py")
    for name, back in (("back.fmu", True), ("forth.fmu", False)):
        FmuBuilder.build_FMU(script, folder / name, [], None, None, canGetAndSetFMUstate=back)
    sys.path[:] = before
    return folder


@pytest.mark.parametrize(("file", "near"), [("back.fmu", 1e-12), ("forth.fmu", 2e-2)])
def test_an_fmu_is_the_structure(tower, file, near):
    """As our own spring; without a state to go back to the ice expects it on a straight line."""
    own = loads(*SOFT)
    got = loads("structure.motion.kind='fmu'", f"structure.motion.file='{tower / file}'")
    assert np.abs(got - own).max() < near * np.abs(own).max()


@pytest.fixture(scope="module")
def tower_3(tmp_path_factory):
    """build(name, back, limit, end): the FMU of FMI 3.0 of `tower_fmu_3.py`, with such an end."""
    from pythonfmu3 import FmuBuilder

    folder, text = tmp_path_factory.mktemp("tower3"), Path(__file__).with_name("tower_fmu_3.py").read_text()

    def build_tower(name, back=True, limit="1e12", end="1e9"):
        (folder / name).mkdir()
        script, before = folder / name / f"{name}.py", list(sys.path)
        script.write_text(text.replace("LIMIT, END = 1e12, 1e9", f"LIMIT, END = {limit}, {end}"))
        made = FmuBuilder.build_FMU(script, folder / name / "out", canGetAndSetFMUState=back)
        sys.path[:] = before
        sys.modules.pop(name, None)
        return (f"structure.motion.file='{made}'", "structure.motion.kind='fmu'")

    return build_tower


def test_an_fmu_of_fmi_3_is_the_structure_as_its_twin_of_fmi_2_is(tower, tower_3):
    """To the last bit, with and without a way back; a tower four times as soft is another one."""
    for back, twin in ((True, "back.fmu"), (False, "forth.fmu")):
        two = loads("structure.motion.kind='fmu'", f"structure.motion.file='{tower / twin}'")
        three = loads(*tower_3(f"three_{back}".lower(), back))
        assert np.array_equal(three, two)
    own = loads(*SOFT)
    assert np.abs(three - own).max() > 1e-6 * np.abs(own).max()  # it cannot go back
    softer = loads(*SOFT[:2], "structure.motion.surge.stiffness='1 MN/m'", SOFT[3])
    assert np.abs(softer - own).max() > 1e-3 * np.abs(own).max()


def test_windows_are_repeated_with_an_fmu_of_fmi_3(tower_3):
    own = loads(*SOFT, "structure.motion.repeats=2")
    got = loads(*tower_3("repeated"), "structure.motion.repeats=2")
    assert np.abs(got - own).max() < 1e-9 * np.abs(own).max()


@pytest.mark.parametrize(("limit", "end", "says"), [("1e3", "1e9", "stops"), ("1e12", "0.42", "wants to end")])
def test_an_fmu_of_fmi_3_that_stops_ends_the_run_with_one_line(tower_3, limit, end, says):
    with pytest.raises(SimulationError, match=says) as told:
        loads(*tower_3(f"stops_{says[:2]}", limit=limit, end=end))
    assert str(told.value).startswith("t = ")
    assert "\n" not in str(told.value)


def test_an_fmu_of_fmi_3_that_cannot_go_back_is_told_from_one_that_can(tower_3):
    case = load_scenario(CASE, [*SHEET, *tower_3("forth3", False), "structure.motion.repeats=2"])
    with pytest.raises(InputError, match="cannot get and set its state"):
        build(case)


def test_what_is_no_structure_is_refused(tower, ice_fmu, tmp_path):
    wrong = tmp_path / "wrong.fmu"
    wrong.write_bytes(b"PK no zip")
    for file, more, says in (
        (wrong, (), "cannot be read as an FMU"),
        (ice_fmu, (), "none of the inputs fx"),
        (tower / "forth.fmu", ("structure.motion.repeats=2",), "cannot get and set its state"),
    ):
        case = load_scenario(CASE, [*SHEET, "structure.motion.kind='fmu'", f"structure.motion.file='{file}'", *more])
        with pytest.raises(InputError, match=says):
            build(case)
    with pytest.raises(InputError, match="comes from the other side"):
        write_fmu(load_scenario(CASE, [*SHEET, *SOFT]), tmp_path / "ice.fmu")


@pytest.mark.parametrize("version", [2, 3])
def test_the_command_writes_it(cosim, tmp_path, version):
    out = tmp_path / "ice.fmu"
    code, said, _ = cosim("fmu", CASE, "-o", str(out), "--fmi", str(version), "--set", SHEET[0])
    assert (code, "steps are whole multiples of 0.05 s" in said) == (0, True)
    assert fmpy.read_model_description(str(out)).fmiVersion == f"{version}.0"


def test_another_version_is_refused(cosim, tmp_path):
    code, _, said = cosim("fmu", CASE, "-o", str(tmp_path / "ice.fmu"), "--fmi", "1", "--set", SHEET[0])
    assert (code, "FMI 1: give one of 2, 3" in said) == (2, True)
