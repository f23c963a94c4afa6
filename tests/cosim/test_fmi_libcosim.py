"""The ice as an FMU under another master than FMPy: libcosim of the Open Simulation Platform.

It is no part of the tests' environment: uv run --with libcosimpy pytest tests/cosim/test_fmi_libcosim.py
"""

import sys
from pathlib import Path

import numpy as np
import pytest

from cosim.build import build
from cosim.fmi.write import write_fmu
from cosim.scenario.loading import load_scenario

pytest.importorskip("libcosimpy")
pytest.importorskip("pythonfmu")

CASE = "van_vliet_2018_floe_55m_centre"
SHEET = ("sheet.nodes=[14, 14]", "contact.strength='800 kPa'", "drift.velocity='0.4 m/s'", "scenario.duration='1.5 s'")
SHEET += ("rubble.enabled=false", "fracture.longest_step='50 ms'")
FORCES = ("fx", "fy", "fz")
STEPS, STEP_NS = 30, 50_000_000


SOFT = ("structure.motion.kind='spring'", "structure.motion.surge.mass='1000 t'")
SOFT += ("structure.motion.surge.stiffness='4 MN/m'", "structure.motion.surge.damping='40 kN*s/m'")


def own_loads(*overrides):
    scheduler = build(load_scenario(CASE, [*SHEET, *overrides]))
    return np.array([scheduler.macro_step().load.sum(axis=0) for _ in range(STEPS)])


@pytest.fixture(scope="module")
def ice_fmu(tmp_path_factory):
    out = tmp_path_factory.mktemp("fmu") / "ice.fmu"
    write_fmu(load_scenario(CASE, list(SHEET)), out)
    return out


@pytest.fixture(scope="module")
def rests():
    return own_loads()


def loads_by_libcosim(*files):
    """The ice at fixed steps, alone or with a tower that takes its load and moves it."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(step_size=STEP_NS)
    slaves = [execution.add_local_slave(CosimLocalSlave(fmu_path=str(f), instance_name=f.stem)) for f in files]
    numbers = [{v.name.decode(): v.reference for v in execution.slave_variables(s)} for s in slaves]
    for source, target, name in ((0, 1, "fx"), (1, 0, "surge"), (1, 0, "surge_rate")) if len(files) > 1 else ():
        ends = (slaves[source], numbers[source][name], slaves[target], numbers[target][name])
        assert execution.connect_real_variables(*ends) == 0
    seen = CosimObserver.create_last_value()
    execution.add_observer(observer=seen)
    rows = []
    for _ in range(STEPS):
        assert execution.step()
        rows.append(seen.last_real_values(slave_index=slaves[0], variable_references=[numbers[0][n] for n in FORCES]))
    return np.array(rows)


def test_loads_are_those_of_our_own_master(ice_fmu, rests):
    assert np.abs(rests).max() > 1e6
    assert np.abs(loads_by_libcosim(ice_fmu) - rests).max() < 1e-9 * np.abs(rests).max()


def test_it_joins_the_ice_to_a_tower(ice_fmu, rests, tmp_path):
    """Both step side by side with values of the step before: near our own spring, not the cone that rests."""
    from pythonfmu import FmuBuilder

    before = list(sys.path)
    FmuBuilder.build_FMU(Path(__file__).with_name("tower_fmu.py"), tmp_path / "tower.fmu", [], None, None)
    sys.path[:] = before
    own, joined = own_loads(*SOFT), loads_by_libcosim(ice_fmu, tmp_path / "tower.fmu")
    assert np.abs(joined - own).max() < 0.1 * np.abs(own).max()
    assert np.abs(rests - own).max() > 0.1 * np.abs(own).max()
