"""[ice.strength_field], [ice.thickness_field], [ice.modulus_field]: ice that varies from cell to cell."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from cosim.scenario.limits import Limits
from cosim.scenario.section import Section
from cosim.scenario.units import LengthOrZero

#: fields of [ice] that vary: column of a file. Their order makes their seeds
FIELDS = {"strength_field": "strength", "thickness_field": "thickness", "modulus_field": "youngs_modulus"}

Variation = Annotated[float, Field(ge=0, le=1)]


class FieldSection(Section):
    """From cell to cell about the value in [ice], the mean: drawn by the seed of the scenario, or from a file.

    strength_field: strengths of every kind. thickness_field: stiffness and faces, not mass. modulus_field: E.
    """

    #: standard deviation over mean. Strength: 0.14 for freshwater ice in bending (1.73 MPa, deviation 0.25 MPa: Timco
    #: and O'Brien 1994), more for sea ice; for thickness and E measure it, there is no default
    variation: Variation | None = Field(None, examples=[0.2])
    #: of values: lognormal and weibull are among those that fit 894 tests of level ice in compression best
    #: (Strub-Klein 2017); normal must stay above 0
    distribution: Literal["lognormal", "normal", "weibull"] = "lognormal"
    #: distance at which the correlation has fallen to 1/e (exponential) or to exp(-pi/4) (gaussian); 0: every cell is
    #: drawn on its own [m]
    correlation_length: Annotated[LengthOrZero, Limits("0 m", "100 km", "20 m")] = 0.0
    correlation: Literal["exponential", "gaussian"] = "exponential"  #: how it falls with the distance
    #: in place of all this: a .csv or .parquet beside the scenario with columns x, y [m] from the rear corner y_min of
    #: the sheet, and strength, thickness or youngs_modulus over the value in [ice]; linear in between
    file: str = Field("", max_length=500, examples=["ice.csv"])
