"""A case of the basin as it stands, full mesh and all, as an FMU beside `cosim run`: the same loads in every window."""

import time

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from cosim.build import build
from cosim.fmi.names import BY_PHASE
from cosim.fmi.write import write_fmu
from cosim.scenario.loading import load_scenario
from coupling.interface import NS

fmpy = pytest.importorskip("fmpy")
pytest.importorskip("pythonfmu")
pytest.importorskip("pythonfmu3")


def fmu_of(case, version, folder):
    """An FMU of it that has been initialised, and a function that gives its forces by phase (3, 3)."""
    write_fmu(case, folder / "ice.fmu", version)
    about = fmpy.read_model_description(str(folder / "ice.fmu"))
    fmu = fmpy.instantiate_fmu(fmpy.extract(str(folder / "ice.fmu")), about, "CoSimulation")
    number = {v.name: v.valueReference for v in about.modelVariables}
    forces = [number[name] for name in BY_PHASE if name.split("_")[-1] in ("fx", "fy", "fz")]
    if version == 2:
        fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
    else:
        fmu.enterInitializationMode(startTime=0.0)
    fmu.exitInitializationMode()
    read = fmu.getReal if version == 2 else fmu.getFloat64
    return fmu, lambda: np.reshape(read(forces), (3, 3))


def compare(case, version, folder, *, processor=np.inf, end=np.inf):
    """Largest difference over the peak so far, by window, until so many seconds of the processor or of the case."""
    with threadpool_limits(1):
        run = build(case)
    fmu, forces = fmu_of(case, version, folder)
    window, began, peak, off = case.window_ns / NS, time.process_time(), 0.0, 0.0
    while run.t_ns / NS < end and time.process_time() - began < processor:
        fmu.doStep(currentCommunicationPoint=run.t_ns / NS, communicationStepSize=window)
        with threadpool_limits(1):
            load = run.macro_step().load
        peak, off = max(peak, np.abs(load).max()), max(off, np.abs(forces() - load).max())
        yield run, peak, off / max(peak, 1.0)


def test_a_case_with_rubble(tmp_path):
    """Past hand-overs, in the other version of the interface than below."""
    *_, (run, peak, off) = compare(load_scenario("first_cone", ["drift.velocity='0.5 m/s'"]), 2, tmp_path, end=1.0)
    assert run.fragments == 3
    assert peak > 5e4
    assert off < 1e-9


@pytest.mark.slow
def test_the_case_of_the_basin_as_it_stands(tmp_path):
    """Past its first hand-overs; two minutes of a processor."""
    *_, (run, peak, off) = compare(load_scenario("basin_2010_floe_55m_centre"), 3, tmp_path, end=28.0)
    assert run.fragments >= 3
    assert peak > 6e6
    assert off < 1e-9
