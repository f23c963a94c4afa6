"""Rules of [structure], [contact] and [rubble]: a body that the ice meets, and friction that it can slide on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.scenario.lengths import slope_at_waterline
from cosim.scenario.names import kinds_of_structure
from cosim.scenario.section import fault

Faults = Iterator[PydanticCustomError]
#: what a missing key may look like
EXAMPLES = {
    "slope": '"45 deg"',
    "waterline_radius": '"15 m"',
    "neck_radius": '"9 m"',
    "sides": "6",
    "orientation": '"30 deg"',
    "profile": '[["-20 m", "9 m"], ["-6 m", "9 m"], ["5 m", "20 m"]]',
}


def has_a_shape(m: Any) -> Faults:
    """The keys of its kind, and no others."""
    s = m.structure
    kind = kinds_of_structure()[s.kind]
    for key, example in EXAMPLES.items():
        given = getattr(s, key) is not None
        if given and key not in kind.needs + kind.takes:
            yield fault(f"structure.{key}", f"a {s.kind} has none: remove the key or change structure.kind")
        if not given and key in kind.needs:
            yield fault(f"structure.{key}", f"missing; a {s.kind} needs it, for example {key} = {example}")


def narrows_to_its_neck(m: Any) -> Faults:
    """A cone that breaks upward needs a rim."""
    s = m.structure
    if s.waterline_radius is None:
        return
    if s.neck_radius is not None and s.neck_radius >= s.waterline_radius:
        yield fault("structure.neck_radius", f"must be below the waterline radius of {s.waterline_radius:g} m")
    if s.breaking == "upward" and s.toe_depth is None:
        yield fault(
            "structure.toe_depth",
            "missing; an upward-breaking cone widens downwards to its rim: add its depth, "
            'for example toe_depth = "4 m"',
        )


def ends_at_its_tip(m: Any) -> Faults:
    """A cone that breaks downward and has no neck."""
    s = m.structure
    if None in (s.waterline_radius, s.toe_depth, s.slope) or s.neck_radius is not None or s.breaking == "upward":
        return
    tip = s.waterline_radius * math.tan(s.slope)
    if s.toe_depth > tip:
        yield fault(
            "structure.toe_depth",
            f"the cone ends at its tip, {tip:.4g} m deep: remove the key, or give structure.neck_radius",
        )


def profile_is_that_of_a_body(m: Any) -> Faults:
    """Points from the lowest to the highest."""
    s = m.structure
    if s.profile is None:
        return
    z, r = zip(*s.profile, strict=True) if s.profile else ((), ())
    if len(z) < 2 or any(b <= a for a, b in pairwise(z)):
        yield fault("structure.profile", "needs two or more points [height, radius], each higher than the one before")
        return
    if not z[0] < 0.0 < z[-1] or not max(r) > 0.0:
        yield fault("structure.profile", "misses the waterline; give a lowest point below and a highest above height 0")
        return
    if not math.isclose(z[-1], s.top):
        yield fault("structure.profile", f'ends at {z[-1]:g} m, the structure at {s.top:g} m; set top = "{z[-1]:g} m"')
    if s.toe_depth is not None and not math.isclose(s.toe_depth, -z[0]):
        yield fault("structure.toe_depth", f"the profile begins at {z[0]:g} m; remove the key")
    above = next(k for k, height in enumerate(z) if height > 0.0)
    if r[above] == r[above - 1] or (r[above] > r[above - 1]) != (s.breaking == "downward"):
        way = "widens" if s.breaking == "downward" else "narrows"
        yield fault(
            "structure.profile",
            f"to break ice {s.breaking} a structure {way} upwards at the waterline; see breaking",
        )


def ice_meets_the_slope(m: Any) -> Faults:
    """Ice floats from its draft below to its freeboard above water; outside of the structure nothing is touched."""
    s, h, share = m.structure, m.ice.thickness, m.ice.density / m.water.density
    freeboard, draft = h * (1.0 - share), h * share
    if s.top <= freeboard:
        yield fault(
            "structure.top", f"the ice passes over it; use more than its freeboard {freeboard:.4g} m, better {h:g} m"
        )
    if s.toe is not None and s.breaking == "upward" and s.toe <= draft:
        yield fault("structure.toe_depth", f"the ice passes under the slope; use more than its draft {draft:.4g} m")


def ice_can_slide(m: Any) -> Faults:
    """Fz / Fx = (1 - mu tan a) / (tan a + mu) of a face that is slid along turns its sign at mu = 1 / tan a."""
    slope = slope_at_waterline(m)
    if slope is None:
        return
    largest = 1.0 / math.tan(slope)
    for key, value in (
        ("contact.friction", m.contact.friction),
        ("rubble.friction_structure", m.rubble.friction_structure),
    ):
        if value >= largest:
            yield fault(
                key,
                f"ice does not slide on a slope of {math.degrees(slope):.3g} deg with this friction, and Fz turns its "
                f"sign; use less than 1 / tan(slope) = {largest:.3g}",
            )


def rubble_comes_from_one_place(m: Any) -> Faults:
    """Pieces of another run are there in place of a heap, and a heap lies under a floe that touches."""
    if m.rubble.pieces and m.rubble.initial_volume > 0.0:
        yield fault("rubble.pieces", "are there besides an initial_volume; give one of the two")
    elif m.sheet.gap > 0.0 and m.rubble.initial_volume > 0.0:
        yield fault("sheet.gap", "a rubble.initial_volume settles under a floe that touches; give one of the two")
    if m.rubble.pieces and not m.rubble.enabled:
        yield fault("rubble.pieces", "needs rubble.enabled = true; remove one of the two")


RULES = (
    has_a_shape,
    narrows_to_its_neck,
    ends_at_its_tip,
    profile_is_that_of_a_body,
    ice_meets_the_slope,
    ice_can_slide,
    rubble_comes_from_one_place,
)
