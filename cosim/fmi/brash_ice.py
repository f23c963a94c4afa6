"""The script inside an FMU of the ice, as pythonfmu runs it: names, values and steps handed on to `cosim.fmi.ice`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from pythonfmu.default_experiment import DefaultExperiment
from pythonfmu.enums import Fmi2Status

from cosim.analysis.run_data import MOTION
from cosim.fmi.ice import Ice
from cosim.fmi.names import BY_PHASE, LOAD, about, unit_of
from cosim.scenario.loading import load_scenario

#: of units in SI, for masters that convert: exponents of kg, m, s, rad
UNITS: dict[str, dict[str, str]] = {
    "N": {"kg": "1", "m": "1", "s": "-2"},
    "N.m": {"kg": "1", "m": "2", "s": "-2"},
    "m": {"m": "1"},
    "rad": {"rad": "1"},
    "m/s": {"m": "1", "s": "-1"},
    "rad/s": {"rad": "1", "s": "-1"},
}


class BrashIce(Fmi2Slave):  # type: ignore[misc]
    """Ice against a structure whose motion is given; steps are whole time windows of the case."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self._scenario = load_scenario(str(Path(self.resources) / "scenario.toml"))
        self.description = self._scenario.title
        window, end = self._scenario.window_ns / 1e9, self._scenario.duration_ns / 1e9
        self.default_experiment = DefaultExperiment(start_time=0.0, stop_time=end, step_size=window)
        self._ice: Ice | None = None
        self._values = dict.fromkeys((*MOTION, *LOAD, *BY_PHASE), 0.0)
        for name in MOTION:
            self._register(name, Fmi2Causality.input, partial(self._values.__setitem__, name))
        for name in (*LOAD, *BY_PHASE):
            self._register(name, Fmi2Causality.output, None)

    def _register(self, name: str, causality: Any, setter: Callable[[float], None] | None) -> None:
        self.register_variable(
            Real(
                name,
                causality=causality,
                description=about(name),
                variability=Fmi2Variability.continuous,
                getter=lambda: self._values[name],
                setter=setter,
            )
        )

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """As pythonfmu makes it, with units."""
        root: Element = super().to_xml(model_options or {})
        units = Element("UnitDefinitions")
        for name, base in UNITS.items():
            SubElement(SubElement(units, "Unit", name=name), "BaseUnit", base)
        root.insert([child.tag for child in root].index("CoSimulation") + 1, units)
        outputs = root.find("ModelStructure/Outputs")
        structure = root.find("ModelStructure")
        if outputs is not None and structure is not None:
            first = SubElement(structure, "InitialUnknowns")
            first.extend(Element("Unknown", unknown.attrib) for unknown in outputs)
        for variable in root.iter("ScalarVariable"):
            real = variable.find("Real")
            if real is not None:
                real.set("unit", unit_of(variable.get("name", "")))
        return root

    def setup_experiment(self, start_time: float, stop_time: float | None, tolerance: float | None) -> None:  # noqa: ARG002
        """A case begins at 0."""
        if start_time != 0.0:
            raise ValueError(f"the ice starts at 0 s, not at {start_time:g} s")

    def exit_initialization_mode(self) -> None:
        """The case is built."""
        self._ice = Ice(self._scenario)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """One step; False, with a line in the log, if it cannot be done."""
        try:
            assert self._ice is not None, "a step before the initialization has ended"
            moved = np.array([self._values[name] for name in MOTION])
            self._ice.step(current_time, step_size, moved[:6], moved[6:])
        except Exception as error:  # nothing may pass the border of the library
            self.log(f"{type(error).__name__}: {error}", Fmi2Status.error)
            return False
        self._values.update(self._ice.loads)
        return True

    def _get_fmu_state(self) -> dict[str, Any]:
        return {"ice": None if self._ice is None else self._ice.save(), "values": dict(self._values)}

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        if state["ice"] is not None:
            state["ice"]()
        self._values.update(state["values"])
