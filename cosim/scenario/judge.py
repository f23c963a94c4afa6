"""How plausible a scenario is that can run: what an engineer would ask about its numbers.

Nothing here stops a run. Bounds are those of sea ice and of its models at scale: where a value is absolute, it is of
sea ice (Timco and Weeks 2010, Cold Regions Science and Technology 60), else a ratio that Froude's law keeps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from cosim.scenario.lengths import (
    approach,
    beam_cell,
    breaking_length,
    characteristic_length,
    drift_in_run,
    width_at_waterline,
)
from lattice.floe import LOOSE

NODES_PER_LENGTH = 5.0  #: least number of cells in the characteristic length
CELLS_PER_PIECE = 3.0  #: in the breaking length
CELLS_ACROSS = 4.0  #: across the structure
PIECES = 0.2  #: least drift in breaking lengths
THICKNESSES = 1.0 / 3.0  #: least size of a cell
FLOATS_ON = LOOSE  #: share of the floe from which a piece is no block


@dataclass(frozen=True)
class Doubt:
    """What looks unlikely: the key, why, and what is usual."""

    key: str
    text: str


Doubts = Iterator[Doubt]


def strengths(m: Any) -> Doubts:
    """Of sea ice; ice of a basin is weaker by the scale."""
    f, c = m.ice.flexural_strength, m.ice.compressive_strength
    if f is not None and not 1e5 <= f <= 1.5e6:
        yield Doubt("ice.flexural_strength", f"{f / 1e3:.4g} kPa; sea ice has 100 to 1500 kPa, model ice less")
    if f is not None and not 1.5 <= c / f <= 20.0:
        yield Doubt("ice.compressive_strength", f"{c / f:.3g} times the flexural strength; usual are 2 to 12 times")
    if m.contact.model == "crushing" and not 0.2 <= m.contact.strength / c <= 5.0:
        yield Doubt("contact.strength", f"{m.contact.strength / c:.3g} times the compressive strength of this ice")


def stiffness(m: Any) -> Doubts:
    """E of sea ice, and E over strength, which a model keeps."""
    E, f = m.ice.youngs_modulus, m.ice.flexural_strength
    if not 5e8 <= E <= 1.1e10:
        yield Doubt("ice.youngs_modulus", f"{E / 1e9:.3g} GPa; sea ice has 1 to 10 GPa, model ice less")
    if f is not None and not 300.0 <= E / f <= 30_000.0:
        yield Doubt("ice.youngs_modulus", f"{E / f:.3g} times the flexural strength; usual are 1000 to 15000 times")


def densities(m: Any) -> Doubts:
    """Of sea ice and of sea water."""
    if not 800.0 <= m.ice.density <= 940.0:
        yield Doubt("ice.density", f"{m.ice.density:g} kg/m^3; sea ice has 840 to 930 kg/m^3")
    if not 995.0 <= m.water.density <= 1035.0:
        yield Doubt("water.density", f"{m.water.density:g} kg/m^3; fresh water to sea water is 1000 to 1030 kg/m^3")


def drift(m: Any) -> Doubts:
    """Slow ice creeps, which the model leaves out; fast ice throws water."""
    speed = approach(m)
    froude = speed / (m.water.gravity * m.ice.thickness) ** 0.5
    if froude < 1e-3 and not (m.structure.motion is not None and m.structure.motion.file):
        yield Doubt("drift.velocity", f"{speed:g} m/s; ice that slow creeps, which this model leaves out")
    elif froude > 1.0:
        yield Doubt("drift.velocity", f"{speed:g} m/s; usual is up to 1 m/s, and waves are left out")


def mesh(m: Any) -> Doubts:
    """Cells against the lengths that they have to show."""
    d, length, piece = m.sheet.spacing, characteristic_length(m), breaking_length(m)
    least = NODES_PER_LENGTH
    if length / d < least:
        yield Doubt(
            "sheet.nodes", f"{length / d:.2g} cells in the characteristic length of {length:.3g} m; use {least:g}"
        )
    if piece / d < CELLS_PER_PIECE:
        yield Doubt(
            "sheet.nodes", f"{piece / d:.2g} cells in the breaking length of {piece:.3g} m; use {CELLS_PER_PIECE:g}"
        )
    width = width_at_waterline(m)
    if width is not None and width / d < CELLS_ACROSS:
        yield Doubt("sheet.nodes", f"{width / d:.2g} cells across the structure of {width:.3g} m; use {CELLS_ACROSS:g}")
    if d < THICKNESSES * m.ice.thickness:
        yield Doubt("sheet.nodes", f"cells of {d:.3g} m are below a third of the thickness, where plate theory ends")


def floe(m: Any) -> Doubts:
    """Far edges against the lengths over which ice bends."""
    s, length = m.sheet, characteristic_length(m)
    if s.length < 3.0 * length:
        yield Doubt(
            "sheet.length",
            f"{s.length:g} m is {s.length / length:.2g} characteristic lengths; its back is felt below 3",
        )
    width, piece = width_at_waterline(m), breaking_length(m)
    if width is None and piece > FLOATS_ON * s.length:
        least = piece / FLOATS_ON
        yield Doubt(
            "sheet.length",
            f"a strip that breaks off is {piece / s.length:.0%} of the floe, and above {FLOATS_ON:.0%} it floats on "
            f"as a floe of its own; use more than {least:.3g} m",
        )
    if width is not None and s.sides != "free" and s.width < width + 3.0 * length:
        least = width + 3.0 * length
        yield Doubt(
            "sheet.width",
            f"{s.width:g} m; held sides are felt below {least:.3g} m: structure and 3 characteristic lengths",
        )


def duration(m: Any) -> Doubts:
    """The way that the ice drifts against pieces and floe."""
    way, piece = max(drift_in_run(m) - m.sheet.gap, 0.0), breaking_length(m)
    if way < PIECES * piece:
        behind = f" behind sheet.gap of {m.sheet.gap:g} m" if m.sheet.gap else ""
        few = (
            f"the ice drifts {way:.3g} m{behind} of a breaking length of {piece:.3g} m: at most the first break is seen"
        )
        yield Doubt("scenario.duration", few)
    if way > 0.8 * m.sheet.length:
        yield Doubt("scenario.duration", f"the ice drifts {way:.3g} m, and the floe is {m.sheet.length:g} m long")


def lattice(m: Any) -> Doubts:
    """What the springs can take without strain."""
    nu = m.ice.poisson_ratio
    if nu < 1 / 3 - 1e-9:
        yield Doubt(
            "ice.poisson_ratio",
            f"{nu:g} is below 1/3: in-plane shear springs resist rigid rotation, "
            "so that a turning floe is strained; use 1/3 unless this is what you study",
        )


JUDGES: tuple[Callable[[Any], Doubts], ...] = (
    strengths,
    stiffness,
    densities,
    drift,
    lattice,
    mesh,
    floe,
    duration,
)


def doubts_of(model: Any) -> list[Doubt]:
    """All of them."""
    return [doubt for judge in JUDGES for doubt in judge(model)]


def facts_of(model: Any, averaging: float) -> dict[str, float]:
    """Numbers that follow from a scenario, in SI; the same in `cosim check --json` and at the start of a run."""
    d, length, tested = model.sheet.spacing, characteristic_length(model), beam_cell(model)
    return {
        "characteristic_length_m": length,
        "breaking_length_m": breaking_length(model),
        "cell_m": d,
        "nodes_per_characteristic_length": length / d,
        "drift_in_run_m": drift_in_run(model),
        "averaging_s": averaging,
        "window_s": float(model.coupling.window),
        "substep_s": float(model.rubble.substep),
    } | ({} if tested is None else {"beam_cell_m": tested})
