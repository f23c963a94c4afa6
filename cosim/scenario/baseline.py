"""[baseline] of a scenario: what design formulas ask for and a simulation does not know."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from cosim.scenario.section import Coefficient, Section
from cosim.scenario.units import Angle, Length, LengthOrZero, StressOrZero


class Baseline(Section):
    """[baseline] Optional; a key that is missing is assumed, see `cosim.baselines.inputs`, and said to be so."""

    rubble_height: LengthOrZero = None  #: of the rubble on the slope [m]
    porosity: Annotated[float, Field(ge=0, lt=1)] | None = None  #: of the rubble
    rubble_slope: Angle = None  #: from the horizontal [rad]
    friction_angle: Angle = None  #: of the rubble [rad]
    cohesion: StressOrZero = None  #: of the rubble [Pa]
    friction_ice_ice: Coefficient | None = None  #: in the rubble
    poisson_ratio: Annotated[float, Field(ge=0, lt=0.5)] | None = None  #: where the lattice must have its own
    ride_up_thickness: Length = None  #: of the ice on the structure [m]
    top_diameter: LengthOrZero = None  #: of the cone where the ice leaves it [m]
    wedges: Annotated[int, Field(ge=2)] | None = None  #: between the radial cracks
