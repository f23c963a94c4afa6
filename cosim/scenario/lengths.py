"""Lengths that a case is made of: how far ice bends, how long its pieces are. SI."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

from lattice.cracks.beam import WIDTH, cells_across


def characteristic_length(model: Any) -> float:
    """(D / rho_w g)^(1/4) of the floating plate [m]."""
    i = model.ice
    D = i.youngs_modulus * i.thickness**3 / (12.0 * (1.0 - i.poisson_ratio**2))
    return float((D / (model.water.density * model.water.gravity)) ** 0.25)


def breaking_length(model: Any) -> float:
    """Distance of the largest moment from the edge of a half-infinite beam on water that is pressed down there [m].

    pi / 4 (4 E I / k)^(1/4), Hetenyi (1946), beams on elastic foundation.
    """
    i = model.ice
    beam = (i.youngs_modulus * i.thickness**3 / (3.0 * model.water.density * model.water.gravity)) ** 0.25
    return float(math.pi / 4.0 * beam)


def beam_cell(model: Any) -> float | None:
    """Size of the cells in which the beam test is simulated that gives the strength of the layers [m].

    None where no beam is: open cracks, or a strength that is given.
    """
    if model.fracture.cracks == "open" or model.fracture.layer_strength is not None:
        return None
    test = model.ice.beam_test
    width = float(WIDTH * model.ice.thickness if test is None else test.width)
    return width / cells_across(width, model.sheet.spacing)


def told_lengths(model: Any) -> dict[str, str]:
    """Lengths by which a run is judged, as a recording keeps them [m]; without that of a beam where none is."""
    tested = beam_cell(model)
    told = {"characteristic_length_m": repr(characteristic_length(model))}
    return told if tested is None else {**told, "beam_cell_m": repr(tested)}


def width_at_waterline(model: Any) -> float | None:
    """Of the structure [m]; None for a plane, and for a profile that has no waterline."""
    s = model.structure
    if s.waterline_radius is not None:
        return 2.0 * float(s.waterline_radius)
    around = _around_the_waterline(s.profile)
    if around is None:
        return None
    (low, inner), (high, outer) = around
    return 2.0 * (inner + (outer - inner) * -low / (high - low))


def slope_at_waterline(model: Any) -> float | None:
    """Of the structure, from the horizontal [rad]; None for a profile that has no waterline, or is upright there."""
    s = model.structure
    if s.slope is not None:
        return float(s.slope)
    around = _around_the_waterline(s.profile)
    if around is None or around[0][1] == around[1][1]:
        return None
    (low, inner), (high, outer) = around
    return math.atan((high - low) / abs(outer - inner))


def _around_the_waterline(profile: Any) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """The points [height, radius] of a profile below and above water."""
    for below, above in pairwise(profile or ()):
        if below[0] <= 0.0 < above[0]:
            return below, above
    return None


def drift_in_run(model: Any) -> float:
    """How far the ice drifts in the run, seen from a structure that moves steadily [m]."""
    return float(approach(model) * model.scenario.duration)


def approach(model: Any) -> float:
    """Speed at which ice and structure come together, 0 where they do not, or are moved by a series [m/s]."""
    motion = model.structure.motion
    steady = None if motion is None else motion.velocity
    return max(float(model.drift.velocity) - (float(steady[0]) if steady else 0.0), 0.0)
