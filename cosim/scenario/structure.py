"""[structure] and [contact]: the slope, and how the sheet meets it."""

from __future__ import annotations

import math
from typing import Literal, Self

from pydantic import model_validator

from cosim.scenario.names import ContactModel
from cosim.scenario.section import Coefficient, Section, fault
from cosim.scenario.units import (
    Angle,
    Length,
    Stress,
)


class Structure(Section):
    """[structure] A cone that narrows the way it breaks the ice, or an inclined plane."""

    kind: Literal["cone", "plane"]  #: shape of the surface; a plane is infinitely wide
    breaking: Literal["downward", "upward"] = "downward"  #: which way the face bends the ice
    slope: Angle  #: from the horizontal [rad]
    waterline_radius: Length = None  #: of a cone [m]
    neck_radius: Length = None  #: the cone narrows to this radius, beyond it stands a cylinder [m]
    toe_depth: Length = None  #: depth of the structure's lower end, below it nothing is touched [m]
    top: Length = 5.0  #: height of the structure above water; over a lower one ice may ride [m]

    @model_validator(mode="after")
    def _has_a_shape(self) -> Self:
        if self.slope >= math.pi / 2:
            raise fault("slope", "a slope lies between 0 and 90 deg")
        if self.kind == "plane":
            for key in ("waterline_radius", "neck_radius"):
                if getattr(self, key) is not None:
                    raise fault(key, 'a plane has no radius: remove the key or set kind = "cone"')
        elif self.waterline_radius is None:
            raise fault("waterline_radius", 'missing; a cone needs one, for example waterline_radius = "15 m"')
        elif self.neck_radius is not None and self.neck_radius >= self.waterline_radius:
            raise fault("neck_radius", f"must be below the waterline radius of {self.waterline_radius:g} m")
        elif self.breaking == "upward" and self.toe_depth is None:
            raise fault(
                "toe_depth",
                "missing; an upward-breaking cone widens downwards to its rim: add its depth, "
                'for example toe_depth = "4 m"',
            )
        return self


class Contact(Section):
    """[contact] Sheet against structure."""

    model: ContactModel = "overlap"  #: the thesis's contact of 6.2, or ice that crushes
    strength: Stress  #: overlap: "purely artificial" parameter of the thesis; crushing: strength of the ice [Pa]
    friction: Coefficient  #: sheet against structure
