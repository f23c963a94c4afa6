"""The script inside an FMU of FMI 3.0, as pythonfmu3 runs it: variables and steps are those of `cosim.fmi.driven`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any
from xml.etree.ElementTree import Element

from pythonfmu3 import Float64, Fmi3Causality, Fmi3Slave, Fmi3Variability, Unit
from pythonfmu3.default_experiment import DefaultExperiment
from pythonfmu3.enums import Fmi3Status
from pythonfmu3.fmi3slave import Fmi3StepResult

from cosim.analysis.run_data import MOTION
from cosim.fmi.driven import Driven
from cosim.fmi.lasting import lasting
from cosim.fmi.names import BY_PHASE, LOAD, TIME, UNITS, about, unit_of


@lasting
class BrashIce(Fmi3Slave):  # type: ignore[misc]
    """Ice against a structure whose motion is given; steps are whole time windows of the case."""

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self._driven = Driven(self.resources)
        self.description = self._driven.scenario.title
        self.default_experiment = DefaultExperiment(0.0, self._driven.end, self._driven.window)
        self.register_units([Unit(name, **base) for name, base in UNITS.items()])
        self._register(TIME, Fmi3Causality.independent, None)
        for name in MOTION:
            self._register(name, Fmi3Causality.input, partial(self._driven.values.__setitem__, name))
        for name in (*LOAD, *BY_PHASE):
            self._register(name, Fmi3Causality.output, None)

    def _register(self, name: str, causality: Any, setter: Callable[[float], None] | None) -> None:
        self.register_variable(
            Float64(
                name,
                causality=causality,
                description=about(name),
                variability=Fmi3Variability.continuous,
                unit=unit_of(name),
                getter=lambda: self._driven.values[name],
                setter=setter,
            )
        )

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """As pythonfmu3 makes it, with the time window, of which steps are multiples."""
        root: Element = super().to_xml(model_options or {})
        kind = root.find("CoSimulation")
        if kind is not None:
            kind.set("fixedInternalStepSize", f"{self._driven.window:.16g}")
        return root

    def exit_initialization_mode(self) -> None:
        """The case is built."""
        self._driven.start()

    def terminate(self) -> None:
        """No step comes after it."""
        self._driven.close()

    def do_step(self, current_time: float, step_size: float) -> Any:
        """One step. With a line in the log, it is discarded if it is refused, and an error if the run has stopped."""
        can_go_on, wrong = self._driven.step(current_time, step_size)
        if not wrong:
            return Fmi3StepResult()
        status = Fmi3Status.discard if can_go_on else Fmi3Status.error
        self.log(wrong, status)
        return Fmi3StepResult(status=status)

    def _get_fmu_state(self) -> dict[str, Any]:
        return self._driven.state()

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        self._driven.go_back(state)
