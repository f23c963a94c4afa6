"""All sections of a scenario file and the checks that span them."""

from __future__ import annotations

from typing import Self

from pydantic import model_validator

from cosim.scenario.baseline import Baseline
from cosim.scenario.case import Case, Recording
from cosim.scenario.coupling import Coupling, nearest_multiples
from cosim.scenario.ice import STRENGTHS, Drift, Fracture, Ice, Sheet, Water
from cosim.scenario.names import strengths_of
from cosim.scenario.rubble import Rubble
from cosim.scenario.section import Section, fault
from cosim.scenario.structure import Contact, Structure


class ScenarioModel(Section):
    """All sections of a scenario and the checks that span them."""

    scenario: Case
    ice: Ice
    water: Water
    sheet: Sheet
    structure: Structure
    contact: Contact
    drift: Drift
    fracture: Fracture = Fracture.model_validate({})
    rubble: Rubble = Rubble.model_validate({})
    coupling: Coupling = Coupling.model_validate({})
    recording: Recording = Recording.model_validate({})
    baseline: Baseline = Baseline.model_validate({})

    @model_validator(mode="after")
    def _times_are_whole_multiples(self) -> Self:
        window = self.coupling.window
        _whole("coupling.window", window, "rubble sub-step", self.rubble.substep)
        for bound in ("shortest_window", "longest_window"):
            if (value := getattr(self.coupling, bound)) is not None:
                _whole(f"coupling.{bound}", value, "rubble sub-step", self.rubble.substep)
        _whole("scenario.duration", self.scenario.duration, "time window", window)
        _whole("recording.every", self.recording.every, "time window", window)
        return self

    @model_validator(mode="after")
    def _upward_breaking_can_run(self) -> Self:
        draft, toe = self.ice.thickness * self.ice.density / self.water.density, self.structure.toe
        if self.structure.breaking == "downward":
            return self
        if toe is not None and toe <= draft:
            raise fault("structure.toe_depth", f"the ice passes under the slope; use more than its draft {draft:g} m")
        if self.rubble.initial_volume > 0.0:
            raise fault(
                "rubble.initial_volume",
                "initial rubble settles under the sheet, before a downward-breaking "
                'structure; start an upward-breaking one without: "0 m^3"',
            )
        return self

    @model_validator(mode="after")
    def _criteria_have_their_strengths(self) -> Self:
        needed = strengths_of(self.fracture.judged)
        if self.fracture.cracks == "closing":  # tension is judged with the strength of the layers, from a beam test
            needed.pop("sigma_t", None)
            if self.fracture.layer_strength is not None or self.ice.beam_test is not None:
                needed.pop("sigma_f", None)
        for key, (field, _) in STRENGTHS.items():
            if field in needed and getattr(self.ice, key) is None:
                raise fault(
                    f"ice.{key}",
                    f"missing; the failure criterion {needed[field]} needs it: "
                    "add it, or leave the criterion out of fracture.criteria",
                )
        return self

    @model_validator(mode="after")
    def _ice_floats(self) -> Self:
        if self.ice.density >= self.water.density:
            raise fault("ice.density", f"this ice sinks; use less than the water's {self.water.density:g} kg/m^3")
        return self


def _whole(key: str, value: float, name: str, step: float) -> None:
    nearest = nearest_multiples(value, step)
    if nearest:
        shown = " or ".join(f"{t * 1e3:g} ms" if t < 1 else f"{t:g} s" for t in nearest)
        raise fault(key, f"not a whole multiple of the {name} {step * 1e3:g} ms; nearest: {shown}")
