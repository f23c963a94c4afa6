"""Lengths that a case is made of: how far ice bends, how long its pieces are. SI."""

from __future__ import annotations

import math
from typing import Any


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


def width_at_waterline(model: Any) -> float | None:
    """Of the structure [m]; None for a plane, or where only the profile tells."""
    radius = model.structure.waterline_radius
    return None if radius is None else 2.0 * float(radius)


def drift_in_run(model: Any) -> float:
    """How far the ice drifts in the run [m]."""
    return float(model.drift.velocity * model.scenario.duration)
