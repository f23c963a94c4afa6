"""Appendix 4: the same run at model scale and at full scale gives the same dimensionless result.

A cantilever is loaded to failure in time, once as in Table 4-4 and once scaled by Table A4-1: lengths by lambda, time
by sqrt(lambda), force by lambda^3, modulus and strength by lambda; the densities, g and Poisson's ratio stay.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, at_most, near, value
from lattice.continuum import hydrodynamic_damping
from lattice.criteria.laws import bending_top
from lattice.grid import Array
from lattice.ice import Ice
from lattice.motion import MovingPiece
from lattice.specimens import cantilever

PARAMETERS: dict[str, Any] = {
    "lambda": 36.0,
    "L_b": 4.04,
    "w": 0.67,
    "h": 0.44,
    "E": 2.3e9,
    "nu": 1.0 / 3.0,
    "rate": 2714.0,
    "sigma_f": 0.355e6,
    "cells": 4,
    "time": 0.8,
    "steps": 10000,
}
LOOKS = 80
SOURCE = "van Vliet (2018), Appendix 4, Table A4-1"


def simulate(p: dict[str, Any], scale: float) -> tuple[Array, Array, Array]:
    """w/scale, phi (times, nodes, 3), utilisation at the root (times, cells) and cell failures at t / sqrt(scale)."""
    s = scale
    ice = Ice(
        E=p["E"] * s,
        nu=p["nu"],
        h=p["h"] * s,
        rho_i=920.0,
        rho_w=1025.0,
        sigma_f=p["sigma_f"] * s,
        sigma_t=p["sigma_f"] * s,
        sigma_c=5.0 * p["sigma_f"] * s,
    )
    piece = cantilever(ice, p["L_b"] * s, p["w"] * s, int(p["cells"]))
    dt = p["time"] / p["steps"] * np.sqrt(s)
    moving = MovingPiece(piece, c=hydrodynamic_damping(ice, 0.1), dt=float(dt))
    root = piece.root[0] * (piece.grid.ny - 1) + piece.root[1] + np.arange(piece.root[2])
    shape, strain, broken = [], [], []
    for look in range(LOOKS):
        moving.run(int(p["steps"]) // LOOKS, p["rate"] * s**3 / np.sqrt(s))
        load = bending_top(moving.state(root), ice)
        failed = root[(load >= 1.0) & moving.intact[root]]
        if len(failed):
            moving.remove(failed)
            broken += [(look, int(cell)) for cell in failed]
        shape.append(moving.q / [s, 1.0, 1.0])
        strain.append(load)
    return np.array(shape), np.array(strain), np.array(broken, dtype=float)


def run(p: dict[str, Any], _quick: bool) -> CaseResult:
    """Both scales run, and the largest difference of their dimensionless results."""
    if not p["lambda"] > 0.0:
        raise ValueError(f"scale lambda = {p['lambda']:g} must be greater than 0")
    small, large = simulate(p, 1.0 / p["lambda"]), simulate(p, 1.0)
    parts = [float(np.abs(a - b).max() / np.abs(b).max()) for a, b in zip(small[:2], large[:2], strict=True)]
    known = p == PARAMETERS
    same = len(small[2]) == len(large[2]) and np.array_equal(small[2], large[2])
    quantities = [
        at_most("deflection and rotation, model against full scale: largest difference", parts[0], "-", 1e-8, SOURCE),
        at_most("utilisation at the root, model against full scale: largest difference", parts[1], "-", 1e-8, SOURCE),
        near("same cells fail at the same dimensionless time (1 = yes)", float(same), "-", 1.0, 0.0, SOURCE),
        near("cells that fail", len(large[2]), "-", p["cells"] if known else None, 0.0, "the whole root of the beam"),
        value("tip deflection over time, full scale", -large[0][:, :, 0].min(axis=1), "m"),
    ]
    return CaseResult("froude", p, quantities)
