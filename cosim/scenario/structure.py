"""[structure] and [contact]: the slope, and how the sheet meets it."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from cosim.scenario.names import ContactModel, StructureKind, kinds_of_structure
from cosim.scenario.section import Coefficient, Section, fault
from cosim.scenario.units import (
    Angle,
    AngleOrZero,
    Length,
    ProfilePoints,
    Stress,
)

#: what a missing key may look like
EXAMPLES = {
    "slope": '"45 deg"',
    "waterline_radius": '"15 m"',
    "neck_radius": '"9 m"',
    "sides": "6",
    "orientation": '"30 deg"',
    "profile": '[["-20 m", "9 m"], ["-6 m", "9 m"], ["5 m", "20 m"]]',
}


class Structure(Section):
    """[structure] A surface on which the ice breaks, and which of the measures describe it."""

    kind: StructureKind  #: shape of the surface; a plane is infinitely wide, a profile a body of several slopes
    breaking: Literal["downward", "upward"] = "downward"  #: which way the face bends the ice
    slope: Angle = None  #: from the horizontal; every kind but a profile needs it [rad]
    waterline_radius: Length = None  #: of a cone; of one with flat sides half the width across flats [m]
    neck_radius: Length = None  #: the cone narrows to this radius, beyond it stands a cylinder [m]
    sides: Annotated[int, Field(ge=3)] | None = None  #: of a multi-sided cone
    orientation: AngleOrZero = None  #: of its sides: 0 a flat side, 180 deg / sides a corner towards the ice [rad]
    #: of a body of revolution: heights and radii from its lowest point up to the height that top says [m]
    profile: ProfilePoints = None
    toe_depth: Length = None  #: depth of the structure's lower end, below it nothing is touched [m]
    top: Length = 5.0  #: height of the structure above water; over a lower one ice may ride [m]

    @model_validator(mode="after")
    def _has_a_shape(self) -> Self:
        if self.slope is not None and self.slope >= math.pi / 2:
            raise fault("slope", "a slope lies between 0 and 90 deg")
        kind = kinds_of_structure()[self.kind]
        for key, example in EXAMPLES.items():
            given = getattr(self, key) is not None
            if given and key not in kind.needs + kind.takes:
                raise fault(key, f"a {self.kind} has none: remove the key or change structure.kind")
            if not given and key in kind.needs:
                raise fault(key, f"missing; a {self.kind} needs it, for example {key} = {example}")
        return self

    @model_validator(mode="after")
    def _narrows_to_its_neck(self) -> Self:
        if self.waterline_radius is None:
            return self
        if self.neck_radius is not None and self.neck_radius >= self.waterline_radius:
            raise fault("neck_radius", f"must be below the waterline radius of {self.waterline_radius:g} m")
        if self.breaking == "upward" and self.toe_depth is None:
            raise fault(
                "toe_depth",
                "missing; an upward-breaking cone widens downwards to its rim: add its depth, "
                'for example toe_depth = "4 m"',
            )
        return self

    @model_validator(mode="after")
    def _profile_is_that_of_a_body(self) -> Self:
        if self.profile is None:
            return self
        z, r = zip(*self.profile, strict=True)
        if len(z) < 2 or any(b <= a for a, b in pairwise(z)):
            raise fault("profile", "needs two or more points [height, radius], each higher than the one before")
        if not z[0] < 0.0 < z[-1] or not max(r) > 0.0:
            raise fault("profile", "misses the waterline; give a lowest point below and a highest above height 0")
        if not math.isclose(z[-1], self.top):
            raise fault("profile", f'ends at {z[-1]:g} m, the structure at {self.top:g} m; set top = "{z[-1]:g} m"')
        if self.toe_depth is not None and not math.isclose(self.toe_depth, -z[0]):
            raise fault("toe_depth", f"the profile begins at {z[0]:g} m; remove the key")
        above = next(k for k, height in enumerate(z) if height > 0.0)
        if r[above] == r[above - 1] or (r[above] > r[above - 1]) != (self.breaking == "downward"):
            way = "widens" if self.breaking == "downward" else "narrows"
            raise fault(
                "profile", f"to break ice {self.breaking} a structure {way} upwards at the waterline; see breaking"
            )
        return self

    @property
    def toe(self) -> float | None:
        """Depth of the lower end [m]; None: on the sea bed, or at the tip of a cone."""
        return self.toe_depth if self.profile is None else -float(self.profile[0][0])


class Contact(Section):
    """[contact] Sheet against structure."""

    model: ContactModel = "overlap"  #: the thesis's contact of 6.2, or ice that crushes
    strength: Stress  #: overlap: "purely artificial" parameter of the thesis; crushing: strength of the ice [Pa]
    friction: Coefficient  #: sheet against structure
