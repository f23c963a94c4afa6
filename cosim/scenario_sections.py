"""The sections of a scenario file, as frozen models: one class per TOML table, SI floats inside.

Angles are stored in radians. A field without default must stand in the file. Keys that are not listed are refused.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from cosim.units import (
    Acceleration,
    Angle,
    Density,
    Force,
    Length,
    LengthOrZero,
    Stress,
    Time,
    TimeOrZero,
    Velocity,
    VolumeOrZero,
)

Share = Annotated[float, Field(ge=0, le=1)]
Coefficient = Annotated[float, Field(ge=0)]
Friction = Coefficient | Literal["rate-dependent"]  #: 0.7 - 0.15 log10(v / 1e-6 m/s) (Lishman and Polojarvi 2015)


def fault(key: str, text: str) -> PydanticCustomError:
    """An error that a check over several keys raises; ``key`` is the one to change, relative to the section."""
    return PydanticCustomError("check", "{text}", {"text": text, "key": key})


def _two_counts(value: object) -> object:
    numbers = tuple(value) if isinstance(value, list | tuple) else ()
    if len(numbers) != 2 or not all(type(n) is int for n in numbers):
        raise PydanticCustomError("quantity", "two whole numbers: nodes along x and y, for example [60, 60]")
    return numbers


NodeCounts = Annotated[tuple[int, int], BeforeValidator(_two_counts)]


class Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


class Case(Section):
    """[scenario]"""

    title: str
    description: str = ""
    duration: Time  #: simulated time [s]
    seed: int = 0  #: of every random number of the run


class BeamTest(Section):
    """[ice.beam_test] cantilever that sets the limit near discontinuities (thesis 4.2.2)."""

    length: Length
    width: Length
    failure_load: Force
    factor: float = Field(0.75, gt=0, le=1)  #: f of (4.31)


class Ice(Section):
    """[ice]"""

    thickness: Length
    density: Density
    youngs_modulus: Stress
    poisson_ratio: float
    tensile_strength: Stress
    flexural_strength: Stress
    compressive_strength: Stress
    shear_strength: Stress
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
    """[water]"""

    density: Density
    gravity: Acceleration = 9.81
    damping: Coefficient = 0.1  #: hydrodynamic, as share of sqrt(k_f rho_i h) (thesis 4.2.1)


class Sheet(Section):
    """[sheet] The floe: a rectangle of nodes, x along the drift, y across."""

    length: Length  #: along x [m]
    width: Length  #: along y [m]
    nodes: NodeCounts  #: along x and y
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


class Structure(Section):
    """[structure] A cone that narrows the way it breaks the ice, or an inclined plane."""

    kind: Literal["cone", "plane"]
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

    model: Literal["overlap", "crushing"] = "overlap"  #: the thesis's contact of 6.2, or ice that crushes
    strength: Stress  #: overlap: "purely artificial" parameter of the thesis; crushing: strength of the ice [Pa]
    friction: Coefficient  #: sheet against structure


class Drift(Section):
    """[drift]"""

    velocity: Velocity


class Fracture(Section):
    """[fracture]"""

    #: quasi-static: implicit engine, cracks run between two windows; dynamic: explicit engine with waves and inertia
    propagation: Literal["quasi-static", "dynamic"] = "quasi-static"
    longest_step: Time = 0.2  #: longest step of the sheet while nothing fails and no rubble touches it [s]


class Rubble(Section):
    """[rubble] Broken ice as rigid blocks in vertical sections."""

    enabled: bool = True
    substep: Time = 0.005  #: constant step of the sections [s]
    iterations: int = Field(30, ge=1)  #: of the impulse solver; at least the depth of a chain of blocks
    columns_per_section: int = Field(1, ge=1)  #: node columns in one section
    friction_ice_ice: Friction = 0.1
    friction_structure: Friction = 0.1
    restitution: Share = 0.1
    form_drag: Coefficient = 1.0
    skin_drag: Coefficient = 0.002
    added_mass: Coefficient = 0.2  #: share of the displaced mass
    backfill: Literal["full", "none", "filling"] = "filling"  #: how the top of a new block that is pushed down floods
    filling_time: Time = 5.0  #: a weir, q = 1.7 H^1.5 m2/s with H = 1 m, fills the head on 10-15 m of ice in 3-7 s
    contact_strength: Stress = None  #: pressure at which a contact of a block crushes; default compressive_strength
    initial_volume: VolumeOrZero = 0.0  #: ice that has settled in front of the structure before the run [m^3]
    threads: int = Field(1, ge=1)


class Coupling(Section):
    """[coupling]"""

    window: Time = 0.05  #: time window (macro step) [s]; with steering the first one
    #: serial-explicit: the sheet under the last forces, then the rubble; parallel-explicit: both with the last data;
    #: serial-implicit: windows are repeated until forces and motion agree
    scheme: Literal["serial-explicit", "parallel-explicit", "serial-implicit"] = "serial-explicit"
    tolerance: float = Field(1e-3, gt=0, lt=1)  #: implicit: change of the forces, relative, that ends the iteration
    max_iterations: int = Field(30, ge=2)  #: implicit: of one window
    relaxation: float = Field(1.0, gt=0, le=1)  #: implicit: share of the change that is taken over before Aitken's own
    force_floor: Force = 1e4  #: implicit: smaller forces are set against this one [N]
    unconverged: Literal["stop", "count"] = "stop"  #: implicit: such a window ends the run, or is counted in the ledger
    #: fixed: all windows alike; power: by what the coupling makes or takes of the power that it exchanges
    steering: Literal["fixed", "power"] = "fixed"
    power_tolerance: float = Field(0.1, gt=0)  #: of the power residual, relative to the exchanged power
    shortest_window: Time = None  #: with steering; default the sub-step of the rubble [s]
    longest_window: Time = None  #: with steering; default four times the first window [s]

    def bounds(self, substep: float) -> tuple[float, float]:
        """Shortest and longest window with steering, defaults filled in [s]."""
        longest = 4.0 * self.window if self.longest_window is None else self.longest_window
        return substep if self.shortest_window is None else self.shortest_window, longest

    @model_validator(mode="after")
    def _bounds_enclose_the_window(self) -> Self:
        for key, value in (("shortest_window", self.shortest_window), ("longest_window", self.longest_window)):
            if value is not None and self.steering == "fixed":
                raise fault(key, 'has no meaning for windows that are all alike: remove it or set steering = "power"')
        if self.shortest_window is not None and self.shortest_window > self.window:
            raise fault("shortest_window", f"must be at most the first window of {self.window * 1e3:g} ms")
        if self.longest_window is not None and self.longest_window < self.window:
            raise fault("longest_window", f"must be at least the first window of {self.window * 1e3:g} ms")
        return self


class Recording(Section):
    """[recording]"""

    every: Time = 0.5  #: time between recorded frames; loads are recorded for every window [s]


def nearest_multiples(value: float, step: float) -> list[float]:
    """The whole multiples of ``step`` that enclose ``value``, without zero; empty if it is one already."""
    n_value, n_step = round(value * 1e9), round(step * 1e9)
    if n_step > 0 and n_value % n_step == 0 and n_value > 0:
        return []
    n_step = max(n_step, 1)
    below = n_value // n_step
    return [k * n_step / 1e9 for k in (below, below + 1) if k > 0]
