"""From a scenario to the case of the design formulas. Nothing is assumed in silence: see `Given.assumed`."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, isinf, radians
from typing import Any

import numpy as np

from cosim.baselines.case import Case
from cosim.scenario.model import ScenarioModel
from cosim.structures import KINDS

RUBBLE_HEIGHT = 2.0  #: thicknesses
POROSITY = 0.3  #: IceFloe, test GLA
RUBBLE_SLOPE = 2.0 / 3.0  #: of the structure's slope; IceFloe: 40 deg on 60 deg
FRICTION_ANGLE = radians(45.0)  #: IceFloe, test GLA
SLIDING = 0.1  #: ice on ice above 1e-2 m/s (Lishman and Polojarvi 2015)
WEDGES = 5


@dataclass(frozen=True)
class Given:
    """A case, and which of its values no scenario says."""

    case: Case
    assumed: dict[str, str]  #: by key of [baseline]: the value and where it comes from


def given(model: ScenarioModel) -> Given:
    """The formulas' case; what [baseline] does not hold has the defaults of this file."""
    i, s, water = model.ice, model.structure, model.water
    slope, radius = _met_at_the_waterline(model)
    wide = isinf(radius)
    width = float(model.sheet.width) if wide else 2.0 * radius
    defaults = _defaults(model)
    stated = {key: getattr(model.baseline, key) for key in defaults}
    value: dict[str, Any] = {k: defaults[k][0] if v is None else v for k, v in stated.items()}
    case = Case(
        h=i.thickness,
        w=width,
        a=slope,
        mu=model.contact.friction,
        sigma_f=i.flexural_strength,
        E=i.youngs_modulus,
        nu=value["poisson_ratio"],
        rho_i=i.density,
        rho_w=water.density,
        g=water.gravity,
        h_r=value["rubble_height"],
        e=value["porosity"],
        th=value["rubble_slope"],
        ph=value["friction_angle"],
        c=value["cohesion"],
        mu_i=value["friction_ice_ice"],
        h_R=value["ride_up_thickness"],
        D_T=value["top_diameter"],
        breaking=s.breaking,
        wide=wide,
        wedges=value["wedges"],
    )
    return Given(case, {k: defaults[k][1] for k, v in stated.items() if v is None and defaults[k][1]})


def _met_at_the_waterline(model: ScenarioModel) -> tuple[float, float]:
    """Slope from the horizontal [rad] and half the width [m] of the structure; the width may be infinite."""
    s: Any = model.structure  # as `cosim.build` hands it on: which keys are there is checked by kind
    if s.slope is not None and s.waterline_radius is not None:
        return float(s.slope), float(s.waterline_radius)
    structure = KINDS[s.kind].build(s)
    steepness = acos(abs(float(structure.normal_z(np.zeros(1))[0])))
    return steepness if s.slope is None else float(s.slope), structure.half_width


def _defaults(model: ScenarioModel) -> dict[str, tuple[Any, str]]:
    """Value and wording by key; no wording where the scenario says it elsewhere."""
    i, s, friction = model.ice, model.structure, model.rubble.friction_ice_ice
    slope = RUBBLE_SLOPE * _met_at_the_waterline(model)[0]
    degrees = f"{slope / radians(1.0):g} deg"
    own = isinstance(friction, float)
    narrow_end = s.neck_radius or 0.0 if s.profile is None else min(r for _, r in s.profile)
    neck = 2.0 * narrow_end
    top = f"{neck:g} m, the cone's narrow end" if neck else "0 m, the cone's tip"
    return {
        "rubble_height": (RUBBLE_HEIGHT * i.thickness, f"{RUBBLE_HEIGHT * i.thickness:g} m, two thicknesses"),
        "porosity": (POROSITY, f"{POROSITY:g}, as IceFloe's test"),
        "rubble_slope": (slope, f"{degrees}, two thirds of the structure's slope"),
        "friction_angle": (FRICTION_ANGLE, "45 deg, as IceFloe's test"),
        "cohesion": (0.0, "0 Pa, as IceFloe's test"),
        "friction_ice_ice": (friction, "") if own else (SLIDING, f"{SLIDING:g}, the sliding end of rate dependence"),
        "poisson_ratio": (i.poisson_ratio, ""),
        "ride_up_thickness": (i.thickness, f"{i.thickness:g} m, one layer of the sheet"),
        "top_diameter": (neck, top),
        "wedges": (WEDGES, f"{WEDGES}"),
    }
