"""[structure.motion]: how the structure answers the ice, or moves by itself."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from cosim.scenario.limits import Limits
from cosim.scenario.section import Section
from cosim.scenario.units import (
    AnyVelocity,
    Inertia,
    Mass,
    RotationalDampingOrZero,
    RotationalStiffnessOrZero,
    TranslationalDampingOrZero,
    TranslationalStiffnessOrZero,
    Unit,
    list_of,
)

_Component = Annotated[AnyVelocity, Limits("-20 m/s", "20 m/s", "-0.1 m/s")]
Velocity: Any = list_of(Unit("m/s", "-0.1 m/s", '["-0.1 m/s", "0 m/s", "0 m/s"]'), _Component, _Component, _Component)


class Translation(Section):
    """[structure.motion.surge], sway and heave: along x, y, z, of the waterline point; held without the table."""

    mass: Annotated[Mass, Limits("1 mg", "1e12 kg", "1200 t")]  #: that moves, with the water that moves along [kg]
    #: 0: it floats freely [N/m]
    stiffness: Annotated[TranslationalStiffnessOrZero, Limits("0 N/m", "1e24 N/m", "6 MN/m")] = 0.0
    #: force per speed [N s/m]
    damping: Annotated[TranslationalDampingOrZero, Limits("0 N*s/m", "1e18 N*s/m", "50 kN*s/m")] = 0.0


class Rotation(Section):
    """[structure.motion.roll], pitch and yaw: about x, y, z through the waterline point; held without the table."""

    #: about the waterline point, with that of the water that moves along [kg m2]
    inertia: Annotated[Inertia, Limits("1e-9 kg*m^2", "1e18 kg*m^2", "4e9 kg*m^2")]
    #: moment per radian [N m]
    stiffness: Annotated[RotationalStiffnessOrZero, Limits("0 N*m", "1e27 N*m", "20 GN*m")] = 0.0
    #: moment per rate [N m s]
    damping: Annotated[RotationalDampingOrZero, Limits("0 N*m*s", "1e24 N*m*s", "100 MN*m*s")] = 0.0


class StructureMotion(Section):
    """[structure.motion] What moves the structure: nothing, springs, modes, or a course of its own."""

    #: rigid: it rests; spring: the degrees of freedom that have a table of their own, or matrices of a file; modal:
    #: modes of a file; prescribed: a steady velocity, or the series of a file; fmu: a model of others (extra fmi)
    kind: Literal["rigid", "spring", "modal", "prescribed", "fmu"] = "rigid"
    #: prescribed: of a ship, or of the carriage of a basin, along x, y, z [m/s]
    velocity: Velocity = None
    #: beside the scenario, SI. spring: .toml with freedoms, mass, damping, stiffness (matrices); modal: .csv or
    #: .parquet with columns frequency_Hz, damping_ratio, mass_kg, and surge to yaw of the mode at the waterline;
    #: prescribed: with columns time_s and any of surge_m, sway_m, heave_m, roll_rad, pitch_rad, yaw_rad; fmu: .fmu with
    #: inputs fx to mz and outputs surge to yaw, surge_rate to yaw_rate, any of them
    file: str = Field("", max_length=500, examples=["tower.csv"])
    #: of every window at most, with the way that its load gives: for power that closes over the interface
    repeats: int = Field(0, ge=0, le=20)
    surge: Translation | None = None
    sway: Translation | None = None
    heave: Translation | None = None
    roll: Rotation | None = None
    pitch: Rotation | None = None
    yaw: Rotation | None = None

    @property
    def moves(self) -> bool:
        """Whether there is any motion."""
        return self.kind != "rigid"
