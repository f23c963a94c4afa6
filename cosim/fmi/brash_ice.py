"""The script inside an FMU of FMI 2.0, as pythonfmu runs it: variables and steps are those of `cosim.fmi.driven`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from pythonfmu.default_experiment import DefaultExperiment
from pythonfmu.enums import Fmi2Status

from cosim.analysis.run_data import MOTION
from cosim.fmi.driven import Driven
from cosim.fmi.lasting import lasting
from cosim.fmi.names import BY_PHASE, LOAD, UNITS, about, unit_of


@lasting
class BrashIce(Fmi2Slave):  # type: ignore[misc]
    """Ice against a structure whose motion is given; steps are whole time windows of the case."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self._driven = Driven(self.resources)
        self.description = self._driven.scenario.title
        self.default_experiment = DefaultExperiment(0.0, self._driven.end, self._driven.window)
        for name in MOTION:
            self._register(name, Fmi2Causality.input, partial(self._driven.values.__setitem__, name))
        for name in (*LOAD, *BY_PHASE):
            self._register(name, Fmi2Causality.output, None)

    def _register(self, name: str, causality: Any, setter: Callable[[float], None] | None) -> None:
        self.register_variable(
            Real(
                name,
                causality=causality,
                description=about(name),
                variability=Fmi2Variability.continuous,
                getter=lambda: self._driven.values[name],
                setter=setter,
            )
        )

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """As pythonfmu makes it, with units."""
        root: Element = super().to_xml(model_options or {})
        units = Element("UnitDefinitions")
        for name, base in UNITS.items():
            SubElement(SubElement(units, "Unit", name=name), "BaseUnit", {k: str(v) for k, v in base.items()})
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
        self._driven.start()

    def terminate(self) -> None:
        """No step comes after it."""
        self._driven.close()

    def do_step(self, current_time: float, step_size: float) -> bool:
        """One step; False, with a line in the log, if it cannot be done."""
        _, wrong = self._driven.step(current_time, step_size)
        if wrong:
            self.log(wrong, Fmi2Status.error)
        return not wrong

    def _get_fmu_state(self) -> dict[str, Any]:
        return self._driven.state()

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._driven.go_back(state)
