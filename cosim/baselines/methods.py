"""The design formulas by name, and what they give for a scenario."""

from __future__ import annotations

from typing import Any

from cosim.baselines.case import BaselineError, Method
from cosim.baselines.croasdale import croasdale
from cosim.baselines.inputs import Given, given
from cosim.baselines.nevel import nevel
from cosim.baselines.ralston import ralston_johansen, ralston_tresca
from cosim.scenario.model import ScenarioModel

_RUBBLE = ("rubble_height", "porosity", "rubble_slope", "friction_angle", "cohesion", "friction_ice_ice")
_RIDE = ("ride_up_thickness", "top_diameter")

METHODS = {
    m.name: m
    for m in (
        Method(
            "croasdale",
            "Croasdale",
            croasdale,
            "ISO 19906, Croasdale; terms as in IceFloe, type 6",
            "the vertical force and the buoyant weights of a downward-breaking slope are the standard form, unverified",
            False,
            (*_RUBBLE, "poisson_ratio"),
        ),
        Method(
            "ralston_tresca",
            "Ralston, Tresca",
            ralston_tresca,
            "ISO 19906 and IEC 61400-3, Ralston; as IceFloe, type 7",
            "on a downward-breaking cone with the 1/9 rule, unverified",
            True,
            _RIDE,
        ),
        Method(
            "ralston_johansen",
            "Ralston, Johansen",
            ralston_johansen,
            "Ralston (1977), A/B form; as the manual of IceDyn",
            "larger than the Tresca form by its yield criterion; downward-breaking with the 1/9 rule, unverified",
            True,
            _RIDE,
        ),
        Method(
            "nevel",
            "Nevel",
            nevel,
            "Nevel (1961, 1972), wedges on water, from memory",
            "unverified; breaking only: no ride-up, no rubble, no compression",
            True,
            ("wedges",),
        ),
    )
}


def design_loads(model: ScenarioModel) -> dict[str, dict[str, Any]]:
    """``{method: {terms, fx, fz, ...}}`` [N]; a method that cannot serve the case says why under ``refused``."""
    found = given(model)
    return {m.name: _one(m, found) for m in METHODS.values()}


def _one(method: Method, found: Given) -> dict[str, Any]:
    about = {
        "title": method.title,
        "source": method.source,
        "caveat": method.caveat,
        "assumed": {key: found.assumed[key] for key in method.uses if key in found.assumed},
    }
    if method.cone_only and found.case.wide:
        return {**about, "refused": "for cones only"}
    try:
        load = method.formula(found.case)
    except BaselineError as error:
        return {**about, "refused": str(error)}
    return {
        "terms": load.terms,
        "fx": load.fx,
        "fz": load.fz,
        "breaking_share": load.breaking / load.fx,
        "intermediate": load.between,
        **about,
    }
