"""All sections of a scenario file and the rules that span them."""

from __future__ import annotations

from pydantic import ValidationError, ValidationInfo, model_validator

from cosim.scenario.baseline import Baseline
from cosim.scenario.case import Case, Recording
from cosim.scenario.chosen import filled
from cosim.scenario.coupling import Coupling
from cosim.scenario.ice import Drift, Fracture, Ice, Sheet, Water
from cosim.scenario.rubble import Rubble
from cosim.scenario.rules.table import RULES
from cosim.scenario.section import Section
from cosim.scenario.structure import Contact, Structure

WITHOUT_RULES = {"rules": False}  #: context of a validation that looks at each key alone


class ScenarioModel(Section):
    """All sections of a scenario and the rules that span them."""

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
    def _keeps_the_rules(self, info: ValidationInfo) -> ScenarioModel:
        model: ScenarioModel = filled(self)
        if info.context == WITHOUT_RULES:
            return model
        if broken := [fault for rule in RULES for fault in rule(model)]:
            raise ValidationError.from_exception_data(
                "scenario", [{"type": fault, "loc": (), "input": None} for fault in broken]
            )
        return model
