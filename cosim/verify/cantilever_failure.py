"""Figure 4-18: the beam of Table 4-4 in motion, through its failure.

The force at the tip grows at 2714 N/s. A cell of the root fails at the limit (4.31) with the factor f of the same
mesh, taken from its own static beam test, so that the crack starts at the measured load; it leaves the stiffness at
once and the beam goes on from where it is. Hydrodynamic damping 0.1 sqrt(k_s rho h), section 4.2.1.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cosim.verify.case import Figure
from lattice.continuum import hydrodynamic_damping
from lattice.criteria.laws import crack_tip_bending
from lattice.grid import Array, IntArray
from lattice.ice import BeamTest, Ice
from lattice.motion import MovingPiece
from lattice.specimens import cantilever, factor_f

RATE = 2714.0  #: Table 4-4 [N/s]
POINTS = (3.8, 2.0, 0.1)  #: distance of w1, w2, w3 from the root [m]
LOOK = 20  #: steps between two looks at the criterion


def history(p: dict[str, Any], failure_load: float, quick: bool) -> tuple[Array, Array, float]:
    """Times [s], deflections w1, w2, w3 downwards (times, 3) [m] and the time of the first failure [s]."""
    sigma_f = 6.0 * failure_load * p["L_b"] / (p["w"] * p["h"] ** 2)
    bare = Ice(
        E=p["E"],
        nu=p["nu"],
        h=p["h"],
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        sigma_f=sigma_f,
        sigma_t=sigma_f,
        sigma_c=p["ratio"] * sigma_f,
    )
    f = factor_f(bare, p["L_b"], p["w"], int(p["cells"]), p["ratio"])
    ice = replace(bare, beam_test=BeamTest(p["L_b"], p["w"], failure_load, f))
    piece = cantilever(ice, p["L_b"], p["w"], int(p["cells"]))
    moving = MovingPiece(piece, c=hydrodynamic_damping(ice, 0.1), dt=p["dt"] or None)
    root = piece.root[0] * (piece.grid.ny - 1) + piece.root[1] + np.arange(piece.root[2])
    return _march(moving, root, ice, 0.8 if quick else 1.0)


def _march(moving: MovingPiece, root: IntArray, ice: Ice, end: float) -> tuple[Array, Array, float]:
    times, deflection, failed = [0.0], [np.zeros(3)], np.inf
    while moving.stepper.t < end:
        moving.run(LOOK, RATE)
        standing = root[moving.intact[root]]
        if len(standing):
            broken = standing[crack_tip_bending(moving.state(standing), ice) >= 1.0]
            if len(broken):
                failed = min(failed, moving.stepper.t)
                moving.remove(broken)
        times.append(moving.stepper.t)
        deflection.append(_centre_line(moving))
    return np.array(times), np.array(deflection), failed


def _centre_line(moving: MovingPiece) -> Array:
    piece = moving.piece
    column, first, count = piece.root
    line = -moving.q[:, 0].reshape(piece.grid.nx, piece.grid.ny)[column:, first + count // 2]
    return np.interp(POINTS, piece.grid.d * np.arange(len(line)), line)


def figure_18(times: Array, deflection: Array, failed: float) -> Figure:
    """Deflection of the tip over time [s], [m]; ``failed`` is the time of the first failure [s]."""

    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for i, point in enumerate(POINTS):
            axes.plot(times, 1e3 * deflection[:, i], label=f"w{i + 1}, {point:g} m from the root")
        axes.axvline(failed, color="k", linewidth=0.6)
        axes.set(xlabel="time [s]", ylabel="deflection downwards [mm]", ylim=(-2, 15))
        axes.legend()

    return Figure("figure_4-18", "Figure 4-18: three points of the beam through its failure", draw)
