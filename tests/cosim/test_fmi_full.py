"""A case of the basin as it stands, full mesh and rubble, as an FMU beside `cosim run`: the same loads, window by window."""

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

CASE = "basin_2010_floe_55m_centre"


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


def compare(version, folder, *, processor=np.inf, end=np.inf):
    """Largest difference over the peak so far, by time, until so many seconds of the processor or of the case."""
    case = load_scenario(CASE)
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


@pytest.mark.slow
@pytest.mark.parametrize("version", [2, 3])
def test_the_case_of_the_basin_as_it_stands(version, tmp_path):
    """Until some pieces have become rubble."""
    *_, (run, peak, off) = compare(version, tmp_path, end=SECONDS)
    assert run.fragments >= PIECES
    assert peak > 1e6
    assert off < 1e-9
