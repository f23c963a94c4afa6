"""Equations (6.2)-(6.5) and Figure 6-15: a broken wedge, hinged at its curved side, is turned down by the slope.

The block of the rubble layer is turned by a slope that it is pushed against; the load is read from its contact. The
thesis's wedge is a plane: its weight acts on the line through the hinge, water presses on its two faces only, and the
hinge lies at the draft. That is a thin plate with the wedge's mass at this depth. Backfill (6.3) begins where the
plate lies ``rho_i h / rho_w`` below its hinge, so the water on the plate stands two drafts below still water. With
``geometry = "block"`` the wedge has its thickness, wet sides, and a top that floods to still water.
"""

from __future__ import annotations

from math import ceil, cos, radians, sin, tan
from typing import Any

import numpy as np

from cosim.verify.case import CaseResult, Figure, Quantity, near, value
from coupling.structure import plane_slope
from rubble.arrays import Array
from rubble.cut import plane
from rubble.layer import RubbleLayer
from rubble.outline import convex_parts
from rubble.physics import RubblePhysics
from rubble.piece import Slab
from rubble.rig import Hinge

PARAMETERS: dict[str, Any] = {
    "L0": [10.0, 20.0],
    "h": 3.0,
    "slope": 45.0,
    "mu": 0.1,
    "rho_i": 846.0,
    "rho_w": 1006.0,
    "g": 9.81,
    "angle": 90.0,
    "degrees": [5.0, 10.0, 20.0, 30.0, 45.0],
    "speed": 0.1,
    "strips": 40,
    "geometry": "plate",
}
SOURCE = "van Vliet (2018), (6.2)-(6.5), Figure 6-15"
#: normal force [MN] at 5, 10, 20, 30, 45 degrees by independent integration of (6.2)-(6.5); (L0, backfill)
TABLE = {
    (10.0, "none"): [0.164, 0.307, 0.557, 0.780, 1.104],
    (10.0, "full"): [0.164, 0.307, 0.541, 0.654, 0.775],
    (20.0, "none"): [1.298, 2.408, 4.273, 5.868, 8.071],
    (20.0, "full"): [1.298, 2.324, 2.865, 2.991, 3.295],
}
TIP, WINDOW = 1e-3, 10  #: thickness of the plate over L0; sub-steps of a window


def formula(p: dict[str, Any], length: float, phi: float, backfill: str) -> float:
    """F_res of (6.2)-(6.5) from the moments about the hinge, by Gauss quadrature [N]; phi in rad."""
    node, weight = np.polynomial.legendre.leggauss(400)
    x, dx = length * (node + 1.0) / 2.0, weight * length / 2.0
    draft, width = p["rho_i"] / p["rho_w"] * p["h"], (length - x) * radians(p["angle"])
    up = p["rho_w"] * p["g"] * width * (draft + x * sin(phi))
    down = p["rho_i"] * p["g"] * p["h"] * width * cos(phi)
    if backfill == "full":
        down = down + p["rho_w"] * p["g"] * width * np.maximum(x * sin(phi) - draft, 0.0)
    a = radians(p["slope"])
    return float(((up - down) * x) @ dx / (length * (cos(a - phi) - p["mu"] * sin(a - phi))))


def turn(p: dict[str, Any], length: float, backfill: str) -> tuple[Array, Array]:
    """Rotation [rad] and force normal to the slope [N] while the slope turns the wedge."""
    layer, block, hinge, a = *_rig(p, length, backfill), radians(p["slope"])
    last = min(radians(max(p["degrees"])), a - radians(0.05))
    phi, force = [], []
    while True:
        layer.advance(WINDOW)
        now = layer.table()
        phi.append(-float(now.angle[block]))
        force.append(float(now.load[block] @ np.array([sin(a), 0.0, cos(a)])))
        if phi[-1] >= last or hinge.position[0] > 10.0 * length:
            return np.array(phi), np.array(force)


def _rig(p: dict[str, Any], length: float, backfill: str) -> tuple[RubbleLayer, int, Hinge]:
    draft, plate = p["rho_i"] / p["rho_w"] * p["h"], p["geometry"] == "plate"
    thick = TIP * length if plate else p["h"]
    physics = RubblePhysics(
        rho_i=p["rho_i"],
        rho_w=p["rho_w"],
        g=p["g"],
        mu_structure=p["mu"],
        form_drag=0.0,
        skin_drag=0.0,
        thickness=min(thick, 0.1),
        backfill="none" if backfill == "none" else "full",
        backfill_level=-2.0 * draft if plate else 0.0,
    )
    slope = plane_slope(radians(p["slope"]), top=5.0, toe_depth=2.0 * length)
    layer = RubbleLayer(
        physics,
        pitch=2.0 * length,
        solids=lambda y: plane(convex_parts(slope.section(y, slope.bottom, slope.top, 0.01)[0], back=500.0)),
    )
    cot = 1.0 / tan(radians(p["slope"]))
    tip = cot * (draft - thick) - 0.01  # its upper corner just ahead of the slope
    x = np.linspace(tip - length, tip, int(p["strips"]) + 1)
    widths = (tip - (x[1:] + x[:-1]) / 2.0) * radians(p["angle"])
    z = -draft
    outline = np.array([(x[0], z), (tip, z), (tip, z + thick), (x[0], z + thick)])
    block = layer.add_block(0, Slab(outline, x, widths, p["rho_i"] * p["h"] / thick), (p["speed"], 0.0))
    return layer, block, Hinge(layer, block, (x[0], 0.0, z), (p["speed"], 0.0, 0.0))


def at_angles(p: dict[str, Any], phi: Array, force: Array) -> tuple[list[float], list[float]]:
    """Degrees that lie below the slope and the force there [N]: mean over the windows within half a degree."""
    degrees, out = [d for d in p["degrees"] if d <= p["slope"]], []
    for d in degrees:
        near_by = (np.abs(np.degrees(phi) - d) < 0.5) & (np.degrees(phi) < p["slope"] - 0.05)
        out.append(float(np.polyval(np.polyfit(np.degrees(phi[near_by]) - d, force[near_by], 1), 0.0)))
    return degrees, out


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Loads over the way of the wedge against (6.2)-(6.5); ``quick``: twice as fast, half the strips."""
    if p["geometry"] not in ("plate", "block"):
        raise ValueError(f'wedge: geometry = {p["geometry"]!r} must be "plate" (as the thesis) or "block"')
    if not 0.0 < p["slope"] < 90.0 or min(p["degrees"]) <= 0.0 or not p["speed"] > 0.0:
        raise ValueError("wedge: slope must lie between 0 and 90 degrees, degrees and speed above 0")
    p = {**p, "speed": 2.0 * p["speed"], "strips": ceil(p["strips"] / 2)} if quick else p
    quantities: list[Quantity] = []
    curves = {}
    for length in p["L0"]:
        for backfill in ("none", "full"):
            curves[length, backfill] = turn(p, length, backfill)
            degrees, force = at_angles(p, *curves[length, backfill])
            quantities += _compare(p, length, backfill, degrees, np.array(force) / 1e6)
    return CaseResult(
        "wedge",
        p,
        quantities,
        [
            Figure(
                "figure_6-15", "Figure 6-15: resulting force on the structure", lambda figure: _draw(figure, p, curves)
            )
        ],
    )


def _compare(p: dict[str, Any], length: float, backfill: str, degrees: list[float], force: Array) -> list[Quantity]:
    name = f"L0 = {length:g} m, {'with' if backfill == 'full' else 'without'} backfill: force at {degrees} degrees"
    if p["geometry"] == "block":
        return [value(name, force, "MN", "thickness, wet sides and freeboard of a real wedge")]
    exact = [formula(p, length, radians(d), backfill) / 1e6 for d in degrees]
    out = [near(name, force, "MN", exact, 0.02, SOURCE)]
    same = all(p[k] == PARAMETERS[k] for k in ("h", "slope", "mu", "rho_i", "rho_w", "g", "angle", "degrees"))
    if same and (length, backfill) in TABLE:
        out.append(near(f"{name}, table", force, "MN", TABLE[length, backfill], 0.02, "independent calculation"))
    return out


def _draw(figure: Any, p: dict[str, Any], curves: dict[tuple[float, str], tuple[Array, Array]]) -> None:
    axes = figure.add_subplot()
    for (length, backfill), (phi, force) in curves.items():
        text = f"{length:g} m, {'with' if backfill == 'full' else 'no'} backfill"
        line = axes.plot(np.degrees(phi), force / 1e6, linewidth=0.8, label=text)[0]
        grid = np.linspace(1e-3, max(phi), 60)
        exact = [formula(p, length, float(f), backfill) / 1e6 for f in grid]
        axes.plot(np.degrees(grid), exact, "--", color=line.get_color(), linewidth=2.0, alpha=0.5)
    axes.set(
        xlabel="rotation [deg]",
        ylabel="force normal to the structure [MN]",
        xlim=(0.0, None),
        ylim=(0.0, None),
        title="solid: section model, dashed: (6.2)-(6.5)",
    )
    axes.legend()
    axes.grid(alpha=0.3)
