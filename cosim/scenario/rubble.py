"""[rubble]: broken ice."""

from __future__ import annotations

from math import radians
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from cosim.scenario.limits import Limits
from cosim.scenario.section import Coefficient, Count, Friction, Section, Share
from cosim.scenario.units import (
    Angle,
    Stress,
    Time,
    VolumeOrZero,
)


def _two_lengths(value: object) -> object:
    ends = tuple(value) if isinstance(value, list | tuple) else ()
    numbers = [float(n) for n in ends if isinstance(n, int | float) and not isinstance(n, bool)]
    if len(ends) != 2 or len(numbers) != 2 or not 0.2 <= numbers[0] <= numbers[1] <= 10.0:
        text = "least and greatest length in thicknesses, both from 0.2 to 10, for example [0.5, 1.5]"
        raise PydanticCustomError("quantity", text)
    return numbers[0], numbers[1]


LengthsOfBlocks = Annotated[tuple[float, float], BeforeValidator(_two_lengths)]
SlipFriction = Friction | Literal["rate-dependent"]  #: 0.7 - 0.15 log10(v / 1e-6 m/s) (Lishman and Polojarvi 2015)


class Rubble(Section):
    """[rubble] Broken ice as rigid blocks in vertical sections."""

    enabled: bool = True  #: false: pieces are taken away when they break off and counted as cleared
    #: constant step of the sections. Default 5 ms (h / 1 m)^0.5, at most that, and a quarter of the default window [s]
    substep: Annotated[Time, Limits("1 us", "1 s", "5 ms")] = None
    iterations: Count = 30  #: of the impulse solver; at least the depth of a chain of blocks
    #: each on a core of its own, to the same bits: two share the contacts of a pile that has 1000 points of contact or
    #: more
    threads: Annotated[int, Field(ge=1, le=2)] = 1
    columns_per_section: Count = 1  #: node columns in one section
    friction_ice_ice: SlipFriction = 0.1  #: block on block and block on sheet; by rate of slip: 0.1 to 0.7
    friction_structure: Friction = 0.1  #: block on structure
    #: block on the sea bed at water.depth; kinetic, of blocks of 10 t of sea ice on gravel (Shapiro and Metzner 1987,
    #: J. Offshore Mech. Arct. Eng. 109, 388; static 0.50)
    friction_sea_bed: Friction = 0.39
    restitution: Share = 0.1  #: of every pair of bodies
    form_drag: Coefficient = 1.0  #: C_d on what moves into the water
    skin_drag: Coefficient = 0.002  #: C_f along wetted faces
    added_mass: Coefficient = 0.2  #: share of the displaced mass of water that moves with a block
    backfill: Literal["full", "none", "filling"] = "filling"  #: how the top of a new block that is pushed down floods
    #: a weir, q = 1.7 H^1.5 m2/s with H = 1 m, fills the head on 10-15 m of ice in 3-7 s
    filling_time: Annotated[Time, Limits("1 us", "1e6 s", "5 s")] = 5.0
    #: pressure at which a contact of a block crushes; default compressive_strength
    contact_strength: Annotated[Stress, Limits("100 Pa", "10 GPa", "2.5 MPa")] = None
    breaks_again: bool = True  #: pieces part where bending passes the strength of the ice
    #: bending stress at which a piece parts in two; default ice.flexural_strength, else ice.tensile_strength
    flexural_strength: Annotated[Stress, Limits("1 kPa", "100 MPa", "500 kPa")] = None
    #: over which the loads that bend a piece are averaged; default 0.5 (h / g)^0.5
    breaking_time: Annotated[Time, Limits("1 us", "100 s", "0.2 s")] = None
    #: ice that has settled in front of the structure before the run: under the sheet, or on top of it where the
    #: structure lifts it [m^3]
    initial_volume: Annotated[VolumeOrZero, Limits("0 m^3", "1e9 m^3", "200 m^3")] = 0.0
    #: least and greatest length of its blocks, evenly spread between, in thicknesses; they are as thick as the sheet
    initial_lengths: LengthsOfBlocks = Field((0.5, 1.5), examples=[[0.5, 1.5]])
    #: of the heap as which it is spread round the structure; assumption, the test of IceFloe has 40 deg [rad]
    initial_slope: Annotated[Angle, Limits("10 deg", "45 deg", "35 deg")] = radians(35.0)
    initial_porosity: float = Field(0.3, ge=0.12, le=0.6, examples=[0.3])  #: pore share of that rubble
    #: pieces of earlier ice where and as they were at the end of another run, as `cosim run --pieces` writes them, in
    #: place of initial_volume
    pieces: str = Field("", max_length=500, examples=["pieces.json"])
