"""Case `crack-arch`: two blocks between rigid walls, cracked through at both ends and at midspan, stand as an arch.

The thrust goes from the lower edge at the wall to the upper edge at midspan, an arm of h. Blocks whose rotation
shortens them have the arm u = h - w for the deflection w of the middle and, as struts of full section, per unit width

    F = E h u (h^2 - u^2) / L^3,

L the half span, with snap-through at u = h / sqrt(3) (McDowell, McKee and Sevin 1956, arching of masonry between rigid
walls). Where the edges crush, F = 4 N z / (2 L) with z = h - w - N / sigma_c.

The lattice has small rotations: the middle plane of a block does not shorten as it turns, and the thrust keeps its arm.
So its arch is the *linear* one about the start: F grows with w and has no snap-through. Its reference is that arch by
beam theory: blocks bend and shear under the eccentric thrust (which halves the stiffness of the strut), and each hinge
is a section without tension, of the length of its cell. For the same blocks finite rotations give (1 - s) (1 - s / 2)
times that force, s = w / h; the excess of the lattice is 1 over it, 1.5 s at first.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import fsolve

from cosim.verify.case import CaseResult, Figure, near, value
from lattice.cracks.engine import SLOW, CrackingEngine
from lattice.cracks.law import CrackLaw, N
from lattice.explicit.forces import NOTHING, Touch
from lattice.explicit.layout import W
from lattice.grid import Array, Grid
from lattice.ice import Ice
from lattice.state import State
from lattice.stiffness import hrennikoff

PARAMETERS: dict[str, Any] = {
    "E": 8.7e9,
    "h": 3.0,
    "d": 2.0,
    "block": 14,
    "sigma_c": 4.0e6,
    "w": [0.02, 0.05, 0.1, 0.2],
}
WIDE, MU = 3, 1.0  #: cells across; friction that keeps the hinges from slipping while L > h
SOURCE = "three-hinge arch of small rotations, beam theory"


class Arch(NamedTuple):
    """How an arch stands, per unit width."""

    w: Array  #: deflection of the middle [m]
    force: Array  #: on the middle [N/m]
    thrust: Array  #: [N/m]


def half_span(p: dict[str, Any]) -> float:
    """From the middle of the hinge at the wall to the load, which acts at the flank of that at midspan [m]."""
    return float((int(p["block"]) + 0.5) * p["d"])


def linear_arch(p: dict[str, Any]) -> tuple[float, float]:
    """Force and thrust per deflection and width [N/m2] by beam theory; hinges without tension keep their shape."""
    E, h, d, L = p["E"], p["h"], p["d"], half_span(p)
    EI, shear, length = E * h**3 / 12.0, 5.0 / 6.0 * 0.5 * E * h, L - 0.5 * d

    def arch(y: Array) -> tuple[float, float, float, float]:
        c_wall, c_mid, turn = y * (h, h, 1.0)  # depths of contact; opening of the hinge at the wall, for N = E h
        k_wall, k_mid = 2.0 * h / c_wall**2, 2.0 * h / c_mid**2  # N = E k c^2 / 2
        m_wall, m_mid = E * h * (0.5 * h - c_wall / 3.0), E * h * (0.5 * h - c_mid / 3.0)
        V = (m_wall + m_mid) / L
        x = 0.5 * d + np.linspace(0.0, length, 401)  # from the middle of the hinge at the wall
        slope = k_wall * d - np.concatenate(([0.0], np.cumsum(0.5 * np.diff(x) * _pairs(V * x - m_wall)))) / EI
        gap = k_wall * (0.5 * h - c_wall) * d + 0.5 * k_mid * (0.5 * h - c_mid) * d - length
        bent = float(np.trapezoid(slope, x)) + 0.5 * k_wall * d**2
        return slope[-1] - 0.5 * k_mid * d, gap, turn - k_wall * d, bent + V * (L + 0.5 * d) / shear

    found = fsolve(lambda y: arch(y)[:3], np.array([0.3, 0.3, 1.0]), full_output=True)
    if found[2] != 1:
        raise ValueError(f"the linear arch was not solved: {found[3]}")
    c_wall, c_mid, _ = found[0]
    w = arch(found[0])[3]
    return 2.0 * E * h**2 * (1.0 - (c_wall + c_mid) / 3.0) / L / w, E * h / w


def _pairs(y: Array) -> Array:
    return y[1:] + y[:-1]


def lattice_arch(p: dict[str, Any], sigma_c: float, seconds: float) -> Arch:
    """The strip on the lattice, its middle pushed down at a steady speed."""
    d, h, half, block = p["d"], p["h"], 0.5 * WIDE * p["d"], int(p["block"])
    grid = Grid(2 * block + 4, WIDE + 1, d, 0.0, -half)
    ice = Ice(E=p["E"], nu=0.0, h=h, rho_i=846.0, rho_w=1e-3)  # no water to speak of
    walls = np.zeros(grid.nodes, bool)
    walls[np.concatenate((grid.edge_nodes("x-"), grid.edge_nodes("x+")))] = True
    law = CrackLaw(E=p["E"], nu=0.0, sigma_c=sigma_c, cohesion=0.0, mu=MU, e_0=1e-5, e_f=1e-5)
    damping = 0.5 * ice.rho_i * h  # a few percent of the critical one, and no load to speak of at this speed
    e = CrackingEngine(grid, ice, hrennikoff(ice), seconds, law=law, held_in_plane=walls, damping=damping, alpha=2e-4,
                       sub_steps=SLOW)  # fmt: skip
    for kick in e.mesh.kick:
        kick[walls.reshape(grid.nx, grid.ny).nonzero()] = 0.0
    live = np.ones((grid.nx - 1, grid.ny - 1), bool)
    live[[0, block + 1, 2 * block + 2]] = False
    on, none = np.ones(grid.nodes, bool), np.full(grid.cells, np.inf)
    e.set_cells(live.ravel(), none, on)
    e.start(State.rest(grid.nodes), on, ())
    for cell in np.flatnonzero(~live.ravel()):
        e.begin(int(cell), 0.0)
    e.layered.view().cells.damage[: e.layered.count, :, N] = 1.0
    return _push(e, max(p["w"]) * h, seconds)


def _push(e: CrackingEngine, depth: float, seconds: float) -> Arch:
    """Down to this depth [m]; force and thrust are means over a hundredth of the way."""
    g, block = e.grid, 20
    middle = np.flatnonzero(np.abs(g.xy[:, 0] - g.xy[:, 0].mean()) < g.d)
    left = np.zeros(g.nodes, bool)
    left[g.edge_nodes("x-")] = True
    spring, m = 0.1 * float(e.inertia_q[3 * middle].min()) / e.dt**2, len(middle)
    at, tangent, zero = np.zeros((m, 3)), np.zeros((m, 3, 3)), np.zeros(m)
    tangent[:, W, W] = -spring
    touch = Touch(*np.divmod(middle, g.ny), zero, zero, at, np.zeros((m, 3)), tangent)
    rows, blocks, width = [], round(seconds / (block * e.dt)), WIDE * g.d
    for k in range(blocks):
        at[:, W] = -depth * (k + 0.5) / blocks
        made = e.march(block, NOTHING, touch, lively=False)
        rows.append((-float(e.at(middle)[:, W].mean()), -float(made.contact[:, W].sum()) / width, e.pull(left) / width))
    size = max(1, blocks // 100)
    w, force, thrust = np.array(rows)[: blocks // size * size].reshape(-1, size, 3).mean(axis=1).T
    return Arch(w, force, thrust)


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Elastic and crushing arch; ``quick``: pushed down faster, at which the hinges slip more: 2 % of the force."""
    seconds, h, L = 18.0 if quick else 24.0, p["h"], half_span(p)
    shares = np.array(p["w"])
    elastic, crushed = (lattice_arch(p, sigma_c, seconds) for sigma_c in (np.inf, p["sigma_c"]))
    stiffness, thrust = linear_arch(p)
    force = np.interp(shares * h, elastic.w, elastic.force)
    finite = p["E"] * h * (h - shares * h) * (h**2 - (h - shares * h) ** 2) / L**3
    F, T = (np.interp(shares * h, crushed.w, y) for y in (crushed.force, crushed.thrust))
    finite_share = (1.0 - shares) * (1.0 - 0.5 * shares)
    arm = h - T / p["sigma_c"]
    later = shares >= 0.05  # where the edges have crushed
    return CaseResult(
        "crack-arch",
        p,
        [
            value("deflection of the middle", shares * h, "m"),
            near("force of the elastic arch", force, "N/m", stiffness * shares * h, 0.03, SOURCE),
            near("thrust of the elastic arch", np.interp(shares * h, elastic.w, elastic.thrust), "N/m",
                 thrust * shares * h, 0.03, SOURCE),
            near("force of the crushing arch over 4 N z / 2 L, z = h - N / sigma_c",
                 (F * L / (2.0 * T * arm))[later], "-", np.ones(later.sum()), 0.03, SOURCE),
            value("thrust of the crushing arch", T, "N/m"),
            value("force of the elastic arch over that of struts, E h u (h^2 - u^2) / L^3", force / finite, "-"),
            value("excess over finite rotations of the same blocks", 1.0 / finite_share - 1.0, "-"),
            value("excess over finite rotations of the crushing arch", arm / (arm - shares * h) - 1.0, "-"),
        ],
        [_figure(p, elastic, crushed, stiffness)],
    )  # fmt: skip


def _figure(p: dict[str, Any], elastic: Arch, crushed: Arch, stiffness: float) -> Figure:
    def draw(figure: Any) -> None:
        axes, h = figure.subplots(), p["h"]
        s = np.linspace(0.0, 1.0, 200)
        axes.plot(elastic.w / h, 1e-6 * elastic.force, label="lattice, elastic")
        axes.plot(crushed.w / h, 1e-6 * crushed.force, label="lattice, edges crush")
        axes.plot(s, 1e-6 * stiffness * s * h, "k:", label="linear arch of beams")
        axes.plot(s, 1e-6 * stiffness * s * h * (1 - s) * (1 - 0.5 * s), "k--", label="the same with finite rotations")
        axes.plot(
            s, 1e-6 * p["E"] * h**4 * (1 - s) * (2 * s - s**2) / half_span(p) ** 3, "k-", label="struts that turn"
        )
        axes.set(xlabel="w / h [-]", ylabel="force per width [MN/m]", ylim=(0, 1.6e-6 * stiffness * h * 0.4))
        axes.legend()

    return Figure("force", "Three-hinge arch: force over the deflection of its middle", draw)
