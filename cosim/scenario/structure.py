"""[structure] and [contact]: the slope, and how the sheet meets it."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from cosim.scenario.limits import Limits
from cosim.scenario.moving import StructureMotion
from cosim.scenario.names import ContactModel, StructureKind
from cosim.scenario.section import Friction, Section
from cosim.scenario.units import (
    Angle,
    AngleOrZero,
    Height,
    Length,
    LengthOrZero,
    Stress,
    Unit,
    list_of,
)

_Point = list_of(
    Unit("m", "-6 m", '["-6 m", "9 m"]'),
    Annotated[Height, Limits("-990 m", "500 m", "-6 m")],
    Annotated[LengthOrZero, Limits("0 m", "2 km", "9 m")],
)
ProfilePoints: Any = list_of(Unit("m", "-6 m", '[["-6 m", "9 m"], ["5 m", "20 m"]]'), _Point, ...)


class Structure(Section):
    """[structure] A surface on which the ice breaks, and which of the measures describe it."""

    #: shape of the surface; a plane is infinitely wide, a profile a body of several slopes
    kind: StructureKind = Field(examples=["cone"])
    breaking: Literal["downward", "upward"] = "downward"  #: which way the face bends the ice
    #: from the horizontal; every kind but a profile needs it [rad]
    slope: Annotated[Angle, Limits("1 deg", "89 deg", "55 deg")] = None
    #: of a cone; of one with flat sides half the width across flats [m]
    waterline_radius: Annotated[Length, Limits("1 mm", "2 km", "5 m")] = None
    #: the cone narrows to this radius, beyond it stands a cylinder [m]
    neck_radius: Annotated[Length, Limits("1 mm", "2 km", "3 m")] = None
    sides: Annotated[int, Field(ge=3, le=360)] | None = Field(None, examples=[6])  #: of a multi-sided cone
    #: of its sides: 0 a flat side, 180 deg / sides a corner towards the ice [rad]
    orientation: Annotated[AngleOrZero, Limits("0 deg", "360 deg", "30 deg")] = None
    #: of a body of revolution: heights and radii from its lowest point up to the height that top says [m]
    profile: ProfilePoints = None
    #: depth of the structure's lower end, below it nothing is touched [m]
    toe_depth: Annotated[Length, Limits("1 mm", "990 m", "6 m")] = None
    #: height of the structure above water; over a lower one ice may ride [m]
    top: Annotated[Length, Limits("1 mm", "500 m", "4 m")] = 5.0
    motion: StructureMotion | None = None

    @property
    def toe(self) -> float | None:
        """Depth of the lower end [m]; None: on the sea bed, or at the tip of a cone."""
        return self.toe_depth if self.profile is None else -float(self.profile[0][0])


class Contact(Section):
    """[contact] Sheet against structure."""

    model: ContactModel = "overlap"  #: the thesis's contact of 6.2, or ice that crushes
    #: overlap: "purely artificial" parameter of the thesis; crushing: strength of the ice [Pa]
    strength: Annotated[Stress, Limits("100 Pa", "10 GPa", "2.5 MPa")]
    friction: Friction = Field(examples=[0.1])  #: sheet against structure
