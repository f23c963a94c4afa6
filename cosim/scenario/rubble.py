"""[rubble]: broken ice."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from cosim.scenario.section import Coefficient, Section, Share
from cosim.scenario.units import (
    Stress,
    Time,
    VolumeOrZero,
)

Friction = Coefficient | Literal["rate-dependent"]  #: 0.7 - 0.15 log10(v / 1e-6 m/s) (Lishman and Polojarvi 2015)


class Rubble(Section):
    """[rubble] Broken ice as rigid blocks in vertical sections."""

    enabled: bool = True  #: false: pieces are taken away when they break off and counted as cleared
    substep: Time = 0.005  #: constant step of the sections [s]
    iterations: int = Field(30, ge=1)  #: of the impulse solver; at least the depth of a chain of blocks
    columns_per_section: int = Field(1, ge=1)  #: node columns in one section
    friction_ice_ice: Friction = 0.1  #: block on block and block on sheet; by rate of slip: 0.1 to 0.7
    friction_structure: Friction = 0.1  #: block on structure
    restitution: Share = 0.1  #: of every pair of bodies
    form_drag: Coefficient = 1.0  #: C_d on what moves into the water
    skin_drag: Coefficient = 0.002  #: C_f along wetted faces
    added_mass: Coefficient = 0.2  #: share of the displaced mass of water that moves with a block
    backfill: Literal["full", "none", "filling"] = "filling"  #: how the top of a new block that is pushed down floods
    filling_time: Time = 5.0  #: a weir, q = 1.7 H^1.5 m2/s with H = 1 m, fills the head on 10-15 m of ice in 3-7 s
    contact_strength: Stress = None  #: pressure at which a contact of a block crushes; default compressive_strength
    initial_volume: VolumeOrZero = 0.0  #: ice that has settled in front of the structure before the run [m^3]
    threads: int = Field(1, ge=1)  #: over the sections; changes no bit of the result
