"""[ice], [water], [sheet], [drift] and [fracture]: the floe, what it floats on and how it breaks."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from cosim.scenario.limits import Limits
from cosim.scenario.names import CriterionName, StiffnessSet
from cosim.scenario.section import Coefficient, Friction, Section
from cosim.scenario.units import (
    Acceleration,
    AnyVelocity,
    Density,
    EnergyPerAreaOrZero,
    Force,
    Length,
    LengthOrZero,
    Stress,
    Time,
    TimeOrZero,
    Toughness,
    Unit,
    VelocityOrZero,
    list_of,
)
from cosim.scenario.variation import FieldSection


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
_Component = Annotated[AnyVelocity, Limits("-10 m/s", "10 m/s", "0.1 m/s")]
PlanVelocity: Any = list_of(Unit("m/s", "0.1 m/s", '["0.1 m/s", "0 m/s"]'), _Component, _Component)
NodeCounts = Annotated[tuple[int, int], BeforeValidator(_two_counts)]


class BeamTest(Section):
    """[ice.beam_test] cantilever that sets the limit near discontinuities (thesis 4.2.2)."""

    length: Annotated[Length, Limits("1 cm", "1 km", "18 m")]  #: L_b of (4.27), from root to load [m]
    width: Annotated[Length, Limits("1 mm", "500 m", "6 m")]  #: w; the limit ends where d reaches twice this [m]
    failure_load: Annotated[Force, Limits("1 mN", "10 GN", "375 kN")]  #: F_c of (4.27) [N]
    factor: float = Field(0.75, gt=0, le=1)  #: f of (4.30) and (4.31), found by simulating the beam; for open cracks
    #: by which the stress at the root exceeded that of beam theory, where ice is taken as brittle; for closing cracks
    concentration: float = Field(1.0, ge=1, le=10)


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

    thickness: Annotated[Length, Limits("1 mm", "30 m", "0.8 m")]  #: h, the same everywhere [m]
    #: rho_i, below that of the water [kg/m3]
    density: Annotated[Density, Limits("300 kg/m^3", "1200 kg/m^3", "900 kg/m^3")]
    #: E, effective, of the whole thickness [Pa]
    youngs_modulus: Annotated[Stress, Limits("100 kPa", "50 GPa", "5 GPa")]
    #: nu, 0 to 1/3; below 1/3 a sheet that turns is strained
    poisson_ratio: float = Field(examples=[0.3333333333333333])
    #: sigma_t, in-plane; for open cracks [Pa]
    tensile_strength: Annotated[Stress, Limits("1 kPa", "100 MPa", "500 kPa")] = None
    #: sigma_f; without a beam test also the limit beside a crack tip [Pa]
    flexural_strength: Annotated[Stress, Limits("1 kPa", "100 MPa", "500 kPa")] = None
    #: sigma_c, uniaxial; of closed cracks, and shapes the envelope (4.6) [Pa]
    compressive_strength: Annotated[Stress, Limits("1 kPa", "1 GPa", "2.5 MPa")]
    #: sigma_s, out of plane (thesis 5.3) [Pa]
    shear_strength: Annotated[Stress, Limits("1 kPa", "100 MPa", "600 kPa")] = None
    #: magnitude of the sum of principal stresses at which ice spalls (4.9) [Pa]
    spalling_strength: Annotated[Stress, Limits("1 kPa", "1 GPa", "5 MPa")] = None
    #: sigma_f with the bottom in tension (4.15) [Pa]
    upward_flexural_strength: Annotated[Stress, Limits("1 kPa", "100 MPa", "500 kPa")] = None
    #: sigma_f with the top in tension (4.16) [Pa]
    downward_flexural_strength: Annotated[Stress, Limits("1 kPa", "100 MPa", "500 kPa")] = None
    #: K_IC (4.23) [Pa m^0.5]
    fracture_toughness: Annotated[Toughness, Limits("100 Pa*m^0.5", "10 MPa*m^0.5", "110 kPa*m^0.5")] = None
    #: alpha of 2.3.3, proportional to stiffness [s]
    material_damping: Annotated[TimeOrZero, Limits("0 s", "1 s", "1 ms")] = 0.0
    beam_test: BeamTest | None = None
    strength_field: FieldSection | None = None  # of every kind of strength
    thickness_field: FieldSection | None = None  # of stiffness and of bending, not of mass
    modulus_field: FieldSection | None = None  # of Young's modulus


class Water(Section):
    """[water] A foundation to the sheet; the blocks float, are dragged and drift in it."""

    density: Annotated[Density, Limits("900 kg/m^3", "1300 kg/m^3", "1025 kg/m^3")]  #: rho_w [kg/m3]
    gravity: Annotated[Acceleration, Limits("0.1 m/s^2", "100 m/s^2", "9.81 m/s^2")] = 9.81  #: g [m/s2]
    #: of the water over a level sea bed, on which rubble grounds; default: so deep that nothing reaches it. The sheet
    #: does not meet the bed, and neither added mass nor drag grow in shallow water [m]
    depth: Annotated[Length, Limits("1 mm", "12 km", "10 m")] = None
    #: share of the displaced mass of water that moves with the sheet where it deflects: density over density of the ice
    #: over k h in waves of number k; pieces are about a quarter of a wave, k = pi / 2 over their length. None in the
    #: thesis
    added_mass: Coefficient = 0.0
    damping: Coefficient = 0.1  #: hydrodynamic, as share of sqrt(k_f rho_i h) (thesis 4.2.1)
    #: flood: a top of the sheet that is pressed under water fills as those of blocks do (`rubble.backfill`), and where
    #: the sheet has left the water only its weight pulls it down; dry: a Kelvin foundation, linear without end (thesis)
    tops: Literal["flood", "dry"] = "flood"
    #: velocity of the water along x and y in the frame of the structure; given, it also drags on the sheet's underside
    #: with rubble.skin_drag, also if it is zero; left out, the water is still and does not drag on the sheet [m/s]
    current: PlanVelocity = None


class Sheet(Section):
    """[sheet] The floe: a rectangle of nodes, x along the drift, y across."""

    length: Annotated[Length, Limits("1 cm", "100 km", "80 m")]  #: along x [m]
    width: Annotated[Length, Limits("1 cm", "100 km", "60 m")]  #: along y [m]
    nodes: NodeCounts = Field(examples=[[61, 46]])  #: along x and y
    #: of the springs between nodes: hrennikoff (3.18)-(3.26) or equations-matching (3.8)-(3.11), the same at nu = 1/3
    stiffness: StiffnessSet = "hrennikoff"
    #: structure's axis from the side edge y_min [m]; default half the width
    axis_from_side: Annotated[LengthOrZero, Limits("0 m", "100 km", "30 m")] = None
    #: in plane; a roller holds the ice along the drift, not across
    back: Literal["held", "roller", "free"] = Field(examples=["held"])
    sides: Literal["held", "roller", "free"] = "free"  #: in plane; a roller holds the ice across the drift, not along
    #: cracks and lost ice that are there when the run begins: a table with columns x, y [m] from the rear corner y_min,
    #: what (crack or gone) and angle [deg] of the crack's normal, as `cosim run --ice` writes it; or a recording of a
    #: run with the same sheet
    broken: str = Field("", max_length=500, examples=["ice.csv"])
    #: from the place where its front would just touch the structure to where it begins: over it the floe drifts alone,
    #: into what lies there (`rubble.pieces`) [m]
    gap: Annotated[LengthOrZero, Limits("0 m", "100 km", "20 m")] = 0.0
    #: each on a core of its own, to the same bits: two share a sheet with closing cracks, or solve the plane and the
    #: bending of one with open cracks side by side; with true inertia (`fracture.propagation`) open cracks use one
    threads: Annotated[int, Field(ge=1, le=2)] = 1

    @property
    def spacing(self) -> float:
        """Distance d of the nodes [m]."""
        return float(self.length) / (self.nodes[0] - 1)

    @property
    def axis(self) -> float:
        """Distance of the structure's axis from the side edge y_min [m]."""
        return self.width / 2 if self.axis_from_side is None else float(self.axis_from_side)


class Drift(Section):
    """[drift] Motion of the ice far away."""

    #: of the ice along +x, towards the structure; 0 for ice at rest that a moving structure meets [m/s]
    velocity: Annotated[VelocityOrZero, Limits("0 m/s", "20 m/s", "0.3 m/s")]


class Fracture(Section):
    """[fracture] How cells fail."""

    #: quasi-static: implicit engine, cracks run between two windows; dynamic: explicit engine with waves and inertia
    propagation: Literal["quasi-static", "dynamic"] = "quasi-static"
    #: closing: a cracked cell carries thrust with an arm, friction and shear; open: it carries nothing (the thesis)
    cracks: Literal["closing", "open"] = "closing"
    #: by which the sheet's cells fail, or begin to crack, the worst of them counts; by default combined-tension, what
    #: the thesis judges in chapter 6, for open cracks, and principal-stress for closing ones
    criteria: Criteria | None = Field(None, examples=[["combined-tension"]])
    #: G_f of ice that softens, 0 for brittle; for closing cracks. Default: sea ice, K_Q = 250 kPa m^0.5 at E = 4 GPa
    #: (Dempsey, Adamson and Mulmule 1999) [J/m2]
    fracture_energy: Annotated[EnergyPerAreaOrZero, Limits("0 J/m^2", "100 kJ/m^2", "15 J/m^2")] = 15.0
    crack_friction: Friction = 0.3  #: of the faces of a crack on each other; for closing cracks
    #: tensile strength of a layer where it is known [Pa]; by default found by simulating a beam test: `ice.beam_test`,
    #: or a beam of usual proportions that breaks at `ice.flexural_strength`; for closing cracks
    layer_strength: Annotated[Stress, Limits("100 Pa", "1 TPa", "400 kPa")] = None
    #: longest step of the sheet while nothing fails and no rubble touches it; for open cracks. Default four windows [s]
    longest_step: Annotated[Time, Limits("1 us", "100 s", "50 ms")] = None

    #: where the sub-steps of the explicit engine are made; cuda: on a graphics card of NVIDIA, with the extra gpu, for
    #: open cracks with dynamic propagation
    device: Literal["cpu", "cuda"] = "cpu"

    @property
    def marches(self) -> bool:
        """Whether the sheet is on the explicit engine."""
        return self.cracks == "closing" or self.propagation == "dynamic"

    @property
    def judged(self) -> tuple[str, ...]:
        """Names of the criteria that are judged."""
        if self.criteria is not None:
            return tuple(self.criteria)
        return ("combined-tension",) if self.cracks == "open" else ("principal-stress",)
