"""[baseline] of a scenario: what design formulas ask for and a simulation does not know."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from cosim.scenario.limits import Limits
from cosim.scenario.section import Friction, Section
from cosim.scenario.units import Angle, Length, LengthOrZero, StressOrZero


class Baseline(Section):
    """[baseline] Optional; a key that is missing is assumed, see `cosim.baselines.inputs`, and said to be so."""

    rubble_height: Annotated[LengthOrZero, Limits("0 m", "500 m", "2 m")] = None  #: of the rubble on the slope [m]
    porosity: Annotated[float, Field(ge=0, lt=1)] | None = Field(None, examples=[0.3])  #: of the rubble
    rubble_slope: Annotated[Angle, Limits("1 deg", "89 deg", "40 deg")] = None  #: from the horizontal [rad]
    friction_angle: Annotated[Angle, Limits("1 deg", "89 deg", "45 deg")] = None  #: of the rubble [rad]
    cohesion: Annotated[StressOrZero, Limits("0 Pa", "10 MPa", "0 kPa")] = None  #: of the rubble [Pa]
    friction_ice_ice: Friction | None = Field(None, examples=[0.1])  #: in the rubble
    #: where the lattice must have its own
    poisson_ratio: Annotated[float, Field(ge=0, lt=0.5)] | None = Field(None, examples=[0.3])
    ride_up_thickness: Annotated[Length, Limits("1 mm", "100 m", "0.8 m")] = None  #: of the ice on the structure [m]
    #: of the cone where the ice leaves it [m]
    top_diameter: Annotated[LengthOrZero, Limits("0 m", "4 km", "6 m")] = None
    wedges: Annotated[int, Field(ge=2, le=1000)] | None = Field(None, examples=[5])  #: between the radial cracks
