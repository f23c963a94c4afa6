"""[ice], [water], [sheet], [drift] and [fracture]: the floe, what it floats on and how it breaks."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from cosim.scenario.names import CriterionName, StiffnessSet
from cosim.scenario.section import Coefficient, Section, fault
from cosim.scenario.units import (
    Acceleration,
    Density,
    EnergyPerAreaOrZero,
    Force,
    Length,
    LengthOrZero,
    PlanVelocity,
    Stress,
    Time,
    TimeOrZero,
    Toughness,
    Velocity,
)


def _two_counts(value: object) -> object:
    numbers = tuple(value) if isinstance(value, list | tuple) else ()
    if len(numbers) != 2 or not all(type(n) is int for n in numbers):
        raise PydanticCustomError("quantity", "two whole numbers: nodes along x and y, for example [60, 60]")
    return numbers


def _some_names(value: object) -> object:
    if not isinstance(value, list | tuple) or not value:
        raise PydanticCustomError("quantity", 'at least one name in brackets, for example ["combined-tension"]')
    return tuple(value)


Criteria = Annotated[tuple[CriterionName, ...], BeforeValidator(_some_names)]
NodeCounts = Annotated[tuple[int, int], BeforeValidator(_two_counts)]


class BeamTest(Section):
    """[ice.beam_test] cantilever that sets the limit near discontinuities (thesis 4.2.2)."""

    length: Length  #: L_b of (4.27), from root to load [m]
    width: Length  #: w; the limit ends where d reaches twice this [m]
    failure_load: Force  #: F_c of (4.27) [N]
    factor: float = Field(0.75, gt=0, le=1)  #: f of (4.30) and (4.31), found by simulating the beam; for open cracks
    #: by which the stress at the root exceeded that of beam theory, where ice is taken as brittle; for closing cracks
    concentration: float = Field(1.0, ge=1)


#: strengths of [ice]: the field of `lattice.ice.Ice`, and its sign there
STRENGTHS: dict[str, tuple[str, float]] = {
    "tensile_strength": ("sigma_t", 1.0),
    "flexural_strength": ("sigma_f", 1.0),
    "compressive_strength": ("sigma_c", 1.0),
    "shear_strength": ("sigma_shear", 1.0),
    "spalling_strength": ("sigma_spall", -1.0),
    "upward_flexural_strength": ("sigma_f_upward", 1.0),
    "downward_flexural_strength": ("sigma_f_downward", 1.0),
    "fracture_toughness": ("K_IC", 1.0),
}


class Ice(Section):
    """[ice] The sheet's material; blocks have the same."""

    thickness: Length  #: h, the same everywhere [m]
    density: Density  #: rho_i, below that of the water [kg/m3]
    youngs_modulus: Stress  #: E, effective, of the whole thickness [Pa]
    poisson_ratio: float  #: nu, 0 to 1/3; below 1/3 a sheet that turns is strained
    tensile_strength: Stress = None  #: sigma_t, in-plane; for open cracks [Pa]
    flexural_strength: Stress = None  #: sigma_f; without a beam test also the limit beside a crack tip [Pa]
    compressive_strength: Stress  #: sigma_c, uniaxial; of closed cracks, and shapes the envelope (4.6) [Pa]
    shear_strength: Stress = None  #: sigma_s, out of plane (thesis 5.3) [Pa]
    spalling_strength: Stress = None  #: magnitude of the sum of principal stresses at which ice spalls (4.9) [Pa]
    upward_flexural_strength: Stress = None  #: sigma_f with the bottom in tension (4.15) [Pa]
    downward_flexural_strength: Stress = None  #: sigma_f with the top in tension (4.16) [Pa]
    fracture_toughness: Toughness = None  #: K_IC (4.23) [Pa m^0.5]
    material_damping: TimeOrZero = 0.0  #: alpha of 2.3.3, proportional to stiffness [s]
    beam_test: BeamTest | None = None

    @model_validator(mode="after")
    def _stiffness_is_positive(self) -> Self:
        if self.poisson_ratio > 1 / 3 + 1e-12:
            raise fault("poisson_ratio", "negative stiffness: use a value in [0, 1/3]")
        if not self.poisson_ratio >= 0:
            raise fault("poisson_ratio", "not a lattice value: use a value in [0, 1/3]")
        return self


class Water(Section):
    """[water] A foundation to the sheet; the blocks float, are dragged and drift in it."""

    density: Density  #: rho_w [kg/m3]
    gravity: Acceleration = 9.81  #: g [m/s2]
    damping: Coefficient = 0.1  #: hydrodynamic, as share of sqrt(k_f rho_i h) (thesis 4.2.1)
    #: flood: a top of the sheet that is pressed under water fills as those of blocks do (`rubble.backfill`), and where
    #: the sheet has left the water only its weight pulls it down; dry: a Kelvin foundation, linear without end (thesis)
    tops: Literal["flood", "dry"] = "flood"
    #: velocity of the water along x and y in the frame of the structure; given, it also drags on the sheet's underside
    #: with rubble.skin_drag, also if it is zero; left out, the water is still and does not drag on the sheet [m/s]
    current: PlanVelocity = None


class Sheet(Section):
    """[sheet] The floe: a rectangle of nodes, x along the drift, y across."""

    length: Length  #: along x [m]
    width: Length  #: along y [m]
    nodes: NodeCounts  #: along x and y
    #: of the springs between nodes: hrennikoff (3.18)-(3.26) or equations-matching (3.8)-(3.11), the same at nu = 1/3
    stiffness: StiffnessSet = "hrennikoff"
    axis_from_side: LengthOrZero = None  #: structure's axis from the side edge y_min [m]; default half the width
    back: Literal["held", "roller", "free"]  #: in plane; a roller holds the ice along the drift, not across
    sides: Literal["held", "roller", "free"] = "free"  #: in plane; a roller holds the ice across the drift, not along

    @property
    def spacing(self) -> float:
        """Distance d of the nodes [m]."""
        return float(self.length) / (self.nodes[0] - 1)

    @property
    def axis(self) -> float:
        """Distance of the structure's axis from the side edge y_min [m]."""
        return self.width / 2 if self.axis_from_side is None else float(self.axis_from_side)

    @model_validator(mode="after")
    def _is_a_square_lattice(self) -> Self:
        if min(self.nodes) < 3:
            raise fault("nodes", "a sheet needs at least 3 nodes along x and y")
        d, e = self.spacing, self.width / (self.nodes[1] - 1)
        if not math.isclose(d, e, rel_tol=1e-6):
            nearest = round(self.width / d) + 1
            raise fault(
                "nodes",
                f"cells must be square, these are {d:.4g} m x {e:.4g} m; "
                f'use [{self.nodes[0]}, {nearest}] or set width = "{d * (nearest - 1):.6g} m"',
            )
        if self.axis > self.width:
            raise fault("axis_from_side", f"the structure's axis misses the sheet; use 0 to {self.width:g} m")
        return self


class Drift(Section):
    """[drift] Motion of the ice far away."""

    velocity: Velocity  #: of the ice along +x, towards the structure [m/s]


class Fracture(Section):
    """[fracture] How cells fail."""

    #: quasi-static: implicit engine, cracks run between two windows; dynamic: explicit engine with waves and inertia
    propagation: Literal["quasi-static", "dynamic"] = "quasi-static"
    #: closing: a cracked cell carries thrust with an arm, friction and shear; open: it carries nothing (the thesis)
    cracks: Literal["closing", "open"] = "closing"
    #: by which the sheet's cells fail, or begin to crack, the worst of them counts; by default combined-tension, what
    #: the thesis judges in chapter 6, for open cracks, and principal-stress for closing ones
    criteria: Criteria | None = None
    #: G_f of ice that softens, 0 for brittle; for closing cracks. Default: sea ice, K_Q = 250 kPa m^0.5 at E = 4 GPa
    #: (Dempsey, Adamson and Mulmule 1999) [J/m2]
    fracture_energy: EnergyPerAreaOrZero = 15.0
    crack_friction: Coefficient = 0.3  #: of the faces of a crack on each other; for closing cracks
    #: tensile strength of a layer where it is known [Pa]; by default found by simulating a beam test: `ice.beam_test`,
    #: or a beam of usual proportions that breaks at `ice.flexural_strength`; for closing cracks
    layer_strength: Stress = None
    #: longest step of the sheet while nothing fails and no rubble touches it [s]; for open cracks
    longest_step: Time = 0.2

    @property
    def judged(self) -> tuple[str, ...]:
        """Names of the criteria that are judged."""
        if self.criteria is not None:
            return tuple(self.criteria)
        return ("combined-tension",) if self.cracks == "open" else ("principal-stress",)
