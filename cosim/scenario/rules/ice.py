"""Rules of [ice] and [fracture]: what the lattice can take, and which strengths belong together."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic_core import PydanticCustomError

from cosim.scenario.ice import STRENGTHS
from cosim.scenario.names import strengths_of
from cosim.scenario.section import fault
from cosim.scenario.variation import FIELDS

Faults = Iterator[PydanticCustomError]


def stiffness_is_positive(m: Any) -> Faults:
    """Springs of the lattice: (3.21)."""
    if m.ice.poisson_ratio > 1 / 3 + 1e-12:
        yield fault("ice.poisson_ratio", "negative stiffness: use a value in [0, 1/3]")
    elif not m.ice.poisson_ratio >= 0:
        yield fault("ice.poisson_ratio", "not a lattice value: use a value in [0, 1/3]")


def ice_floats(m: Any) -> Faults:
    """Lighter than the water."""
    if m.ice.density >= m.water.density:
        yield fault("ice.density", f"this ice sinks; use less than the water's {m.water.density:g} kg/m^3")


def ice_floats_over_the_bed(m: Any) -> Faults:
    """Deeper than its draft."""
    draft = m.ice.thickness * m.ice.density / m.water.density
    if m.water.depth is not None and m.water.depth <= draft:
        yield fault("water.depth", f"the floe stands on the sea bed; use more than its draft {draft:.4g} m")


def compression_is_strongest(m: Any) -> Faults:
    """The envelope (4.6) has its corner in compression; ice bears several times more there than in tension."""
    for key in ("tensile_strength", "flexural_strength", "upward_flexural_strength", "downward_flexural_strength"):
        tension = getattr(m.ice, key)
        if tension is not None and tension > m.ice.compressive_strength:
            yield fault(
                "ice.compressive_strength",
                f"{m.ice.compressive_strength / 1e3:g} kPa is below the {key.replace('_', ' ')} of "
                f"{tension / 1e3:g} kPa; ice bears two to ten times as much in compression",
            )


def criteria_have_their_strengths(m: Any) -> Faults:
    """Each criterion that is judged."""
    needed = strengths_of(m.fracture.judged)
    if m.fracture.cracks == "closing":  # tension is judged with the strength of the layers, from a beam test
        needed.pop("sigma_t", None)
        if m.fracture.layer_strength is not None or m.ice.beam_test is not None:
            needed.pop("sigma_f", None)
    for key, (field, _) in STRENGTHS.items():
        if field in needed and getattr(m.ice, key) is None:
            yield fault(
                f"ice.{key}",
                f"missing; the failure criterion {needed[field]} needs it: "
                "add it, or leave the criterion out of fracture.criteria",
            )


def fields_are_drawn_or_read(m: Any) -> Faults:
    """Each field of varying ice has either a variation or a file, and is not so wide that its distribution is none."""
    for name in FIELDS:
        field = getattr(m.ice, name)
        if field is not None and (field.variation is None) == (not field.file):
            yield fault(f"ice.{name}.variation", "give either a variation or a file, for example variation = 0.2")


def card_marches_open_cracks(m: Any) -> Faults:
    """The card has the springs of the lattice and no layers; the implicit engine solves, which it cannot."""
    f = m.fracture
    if f.device == "cuda" and (f.cracks == "closing" or f.propagation == "quasi-static"):
        change = "cracks = 'open'" if f.cracks == "closing" else "propagation = 'dynamic'"
        yield fault(
            "fracture.device",
            f"cuda runs open cracks with dynamic propagation only: set fracture.{change}, or device = 'cpu'",
        )


RULES = (
    card_marches_open_cracks,
    fields_are_drawn_or_read,
    stiffness_is_positive,
    ice_floats,
    ice_floats_over_the_bed,
    compression_is_strongest,
    criteria_have_their_strengths,
)
