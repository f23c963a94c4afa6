"""A structure that is a model of others: an FMU for co-simulation, FMI 2.0 or 3.0, run by FMPy.

Its inputs take the load of a window, any of ``fx, fy, fz, mx, my, mz``, moments about the waterline point; its outputs
give where the structure is, any of ``surge`` to ``yaw``, and if it has them the rates. Where it is at the end of a
window is asked by a trial step that is taken back, if the FMU can do that; else it is expected on a straight line.
"""

from __future__ import annotations

import shutil
import tempfile
import weakref
from pathlib import Path
from typing import Any

import numpy as np

from cosim.analysis.run_data import MOTION
from cosim.errors import InputError
from cosim.fmi.names import LOAD
from coupling.interface import FREEDOMS, Array, Restore, SimulationError


class FmuMotion:
    """A `coupling.interface.Motion`."""

    def __init__(self, path: Path, repeats: int = 0) -> None:
        """InputError if the file is no such FMU, or cannot go back although windows are to be repeated."""
        try:
            import fmpy
        except ImportError:
            raise InputError(f"{path}: an FMU needs fmpy: pip install 'brash-ice[fmi]'") from None
        self.path, self._folder = path, tempfile.mkdtemp(prefix="brash_fmu_")
        weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        try:
            fmpy.extract(str(path), self._folder)
            about = fmpy.read_model_description(self._folder)
        except Exception as error:
            raise InputError(f"{path}: cannot be read as an FMU ({' '.join(str(error).split())[:200]})") from None
        if about.coSimulation is None:
            raise InputError(f"{path}: is no FMU for co-simulation; export it as one")
        self._goes_back = bool(about.coSimulation.canGetAndSetFMUstate)
        if repeats and not self._goes_back:
            raise InputError(f"{path}: cannot get and set its state; leave out structure.motion.repeats")
        self._find(about)
        self._start(about)
        self._read()

    def _find(self, about: Any) -> None:
        """Numbers of the variables by our names."""
        known = {v.name: v for v in about.modelVariables}
        self._inputs = {n: known[n].valueReference for n in LOAD if n in known and known[n].causality == "input"}
        self._outputs = {n: known[n].valueReference for n in MOTION if n in known and known[n].causality == "output"}
        if not self._inputs or not any(name in self._outputs for name in FREEDOMS):
            raise InputError(
                f"{self.path}: has none of the inputs {', '.join(LOAD)}, or none of the outputs "
                f"{', '.join(FREEDOMS)}; name its variables so"
            )

    def _start(self, about: Any) -> None:
        import fmpy

        try:
            self._fmu: Any = fmpy.instantiate_fmu(self._folder, about, "CoSimulation")
            if about.fmiVersion.startswith("2"):
                self._get, self._set = self._fmu.getReal, self._fmu.setReal
                self._fmu.setupExperiment(startTime=0.0)
                self._fmu.enterInitializationMode()
            else:
                self._get, self._set = self._fmu.getFloat64, self._fmu.setFloat64
                self._fmu.enterInitializationMode(startTime=0.0)
            self._fmu.exitInitializationMode()
        except Exception as error:
            raise InputError(f"{self.path}: cannot be started ({' '.join(str(error).split())[:200]})") from None

    def _read(self) -> None:
        values = dict(zip(self._outputs, self._get(list(self._outputs.values())), strict=True))
        found = np.array([values.get(name, 0.0) for name in MOTION])
        if not np.isfinite(found).all():
            raise SimulationError(f"{self.path}: gives a motion that is not finite")
        self.displacement, self.velocity = found[:6], found[6:]

    def _step(self, t: float, window: float, load: Array) -> None:
        before = self.displacement
        try:
            self._set(list(self._inputs.values()), [float(load[LOAD.index(name)]) for name in self._inputs])
            done = self._fmu.doStep(currentCommunicationPoint=t, communicationStepSize=window)
        except Exception as error:
            raise SimulationError(f"t = {t:.3f} s: {self.path} stops: {' '.join(str(error).split())[:200]}") from None
        if done is not None:  # FMI 3.0: nothing else says that a step was cut short
            _, ends, early, reached = done
            if ends or early:
                what = f"returns early, at {reached:.3f} s" if early else "wants to end"
                raise SimulationError(f"t = {t:.3f} s: {self.path} {what}; it has to take steps of {window:g} s")
        self._read()
        given = np.array([f"{name}_rate" in self._outputs for name in FREEDOMS])
        self.velocity = np.where(given, self.velocity, (self.displacement - before) / window)

    @property
    def energy(self) -> dict[str, float]:
        """As `Motion.energy`: an FMU keeps its own."""
        return {}

    def after(self, t: float, window: float, load: Array) -> Array:
        """As `Motion.after`."""
        if not self._goes_back:
            return np.asarray(self.displacement + window * self.velocity)
        back = _Kept(self)
        self._step(t, window, load)
        end = self.displacement
        back()
        return end

    def advance(self, t: float, window: float, load: Array) -> None:
        """As `Motion.advance`."""
        self._step(t, window, load)

    def save(self) -> Restore:
        """As `Motion.save`; SimulationError if the FMU cannot go back."""
        if not self._goes_back:
            raise SimulationError(f"{self.path}: cannot get and set its state")
        return _Kept(self)


class _Kept:
    """A state of an FMU: calling it sets the FMU back; it is freed when nobody holds it any more."""

    def __init__(self, motion: FmuMotion) -> None:
        self._motion, self._state = motion, motion._fmu.getFMUState()
        self._values = motion.displacement, motion.velocity

    def __call__(self) -> None:
        self._motion._fmu.setFMUState(self._state)
        self._motion.displacement, self._motion.velocity = self._values

    def __del__(self) -> None:
        self._motion._fmu.freeFMUState(self._state)
