"""Zero and drift of a sensor, and the scale of a model."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from cosim.series.description import Description
from cosim.series.series import Series
from cosim.series.told import Told


def without_zero(series: Series, description: Description, told: Told) -> Series:
    """The mean of one unloaded part taken off as zero; the line fitted through several as zero and drift.

    Least squares over all values of these parts; times of the record itself. Nothing is taken off unasked.
    """
    parts = description.unloaded
    if not parts:
        return series
    chosen = np.zeros(len(series.t), dtype=bool)
    for begin, end in parts:
        inside = (series.t >= begin) & (series.t <= end)
        if np.count_nonzero(inside) < 2:
            raise told.wrong(
                f"sensor.unloaded: fewer than two values from {begin:g} s to {end:g} s; the series has "
                f"{series.t[0]:g} s to {series.t[-1]:g} s"
            )
        chosen |= inside
    loads = {}
    for name, y in series.loads.items():
        line = np.polynomial.Polynomial.fit(series.t[chosen], y[chosen], 0 if len(parts) == 1 else 1)
        zero = line(series.t)
        told.say(
            f"{name}: zero of {zero[0]:.4g} N" + (f" drifting to {zero[-1]:.4g} N" * (len(parts) > 1)) + " taken off"
        )
        loads[name] = y - zero
    return replace(series, loads=loads)


def factors(factor: float, density: float = 1.0) -> tuple[float, float]:
    """Times and forces of a prototype over those of its model, ``lambda^(1/2)`` and ``lambda^3 rho_p / rho_m``.

    Froude's law at equal gravity (van Vliet 2018, Table A4-1). That the ice's elasticity scales as well (Cauchy-Froude:
    E and strengths by lambda) is a demand on the model's ice and changes neither.
    """
    return math.sqrt(factor), factor**3 * density


def at_run_scale(series: Series, description: Description, told: Told) -> Series:
    """The series at the scale of the run."""
    scale = description.scale
    if scale.factor == 1.0 and scale.density == 1.0:
        return series
    time, force = factors(scale.factor, scale.density)
    told.say(f"scale: {scale.law} 1:{scale.factor:g}, times by {time:.6g}, forces by {force:.6g}")
    return replace(series.timed(time), loads={name: y * force for name, y in series.loads.items()})
