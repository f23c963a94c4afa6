"""Case `crack-arch`: two blocks between rigid walls, cracked through at both ends and at midspan, stand as an arch.

The thrust goes from the lower edge at the wall to the upper edge at midspan, an arm of h. As struts of
full section that shorten as they turn they carry, per unit width, with u = h - w for the deflection w of the middle,

    F = E h u (h^2 - u^2) / L^3,

L the half span, with snap-through at u = h / sqrt(3) (McDowell, McKee and Sevin 1956, arching of masonry between rigid
walls). Where the edges crush, F = 4 N z / (2 L) with z = h - w - N / sigma_c.

The blocks of the lattice bend and shear under the eccentric thrust, which halves the stiffness of the strut, and each
hinge is a section without tension, of the length of its cell. The reference is therefore the arch of beams with such
hinges and with von Karman's strains, of which struts are the limit; it snaps through at w = 0.38 h.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import fsolve

from cosim.verify.case import CaseResult, Figure, near, value
from lattice.cracks.engine import SLOW, CrackingEngine
from lattice.cracks.law import CrackLaw, N
from lattice.explicit.forces import NOTHING, indenter
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
    "w": [0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5],
}
SLOWLY = 140.0  #: time for a deflection of h [s]
WIDE, MU = 3, 1.0  #: cells across; friction that keeps the hinges from slipping while L > h
SOURCE = "three-hinge arch of beams, finite deflection"


class Arch(NamedTuple):
    """How an arch stands, per unit width."""

    w: Array  #: deflection of the middle [m]
    force: Array  #: on the middle [N/m]
    thrust: Array  #: [N/m]


def half_span(p: dict[str, Any]) -> float:
    """From the middle of the hinge at the wall to the load, which acts at the flank of that at midspan [m]."""
    return float((int(p["block"]) + 0.5) * p["d"])


def arch_of_beams(p: dict[str, Any], w: float) -> tuple[float, float]:
    """Force and thrust per width [N/m] at the deflection w [m] of the middle, by beam theory of finite deflection.

    Unknown are the thrust N = E h n and the depths of contact c at the wall and the middle, hinges without tension:
    curvature 2 n h / c^2, moment N (h / 2 - c / 3). Between them EI y'' + N y = m_wall - V x.
    """
    E, h, d, L = p["E"], p["h"], p["d"], half_span(p)
    EI, shear, length = E * h**3 / 12.0, 5.0 / 6.0 * 0.5 * E * h, L - 0.5 * d
    x = 0.5 * d + np.linspace(0.0, length, 401)  # from the middle of the hinge at the wall

    def arch(y: Array) -> tuple[tuple[float, float, float], float]:
        n, c_wall, c_mid = y[0] * w / L, y[1] * h, y[2] * h
        N, k_wall, k_mid = E * h * n, 2.0 * n * h / c_wall**2, 2.0 * n * h / c_mid**2
        m_wall, m_mid = N * (0.5 * h - c_wall / 3.0), N * (0.5 * h - c_mid / 3.0)
        V = (m_wall + m_mid - N * w) / L
        k, start, turn = np.sqrt(N / EI), 0.5 * k_wall * d**2, k_wall * d
        b, a = start - (m_wall - V * x[0]) / N, (turn + V / N) / k
        phase = k * (x - x[0])
        bent = a * np.sin(phase) + b * np.cos(phase) + (m_wall - V * x) / N
        slope = k * (a * np.cos(phase) - b * np.sin(phase)) - V / N
        gap = k_wall * (0.5 * h - c_wall) * d + 0.5 * k_mid * (0.5 * h - c_mid) * d - n * length
        gap -= 0.5 * float(np.trapezoid((slope + V / shear) ** 2, x)) + 0.5 * (0.5 * k_wall * d + V / shear) ** 2 * d
        ends = slope[-1] - 0.5 * k_mid * d, gap, bent[-1] + V * (L + 0.5 * d) / shear - w
        return (ends[0] * L / w, ends[1] * L / (w * h), ends[2] / w), V

    guess = np.array([0.05, 0.3, 0.3])
    found = fsolve(lambda y: arch(y)[0], guess, full_output=True)
    if found[2] != 1:
        raise ValueError(f"the arch at w = {w:g} m was not solved: {found[3]}")
    return 2.0 * arch(found[0])[1], E * h * float(found[0][0]) * w / L


def lattice_arch(p: dict[str, Any], sigma_c: float, depth: float, seconds: float) -> Arch:
    """The strip on the lattice, its middle pushed down to this depth [m] at a steady speed."""
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
    return _push(e, depth, seconds)


def _push(e: CrackingEngine, depth: float, seconds: float) -> Arch:
    """Down to this depth [m]; force and thrust are means over a hundredth of the way."""
    g, block = e.grid, 20
    middle = np.flatnonzero(np.abs(g.xy[:, 0] - g.xy[:, 0].mean()) < g.d)
    e.mesh.held[1:] = 0.0  # `Marched.hold` is what the wall on the left takes
    spring = 0.1 * float(e.inertia_q[3 * middle].min()) / e.dt**2
    touch = indenter(middle, g.ny, spring)
    rows, blocks, width = [], round(seconds / (block * e.dt)), WIDE * g.d
    for k in range(blocks):
        touch.at[:, W] = -depth * (k + 0.5) / blocks
        made = e.march(block, NOTHING, touch, lively=False)
        w = -float(e.displacement()[1][middle, 0].mean())
        rows.append((w, -float(made.contact[:, W].sum()) / width, made.hold / width))
    size = max(1, blocks // 100)
    w, force, thrust = np.array(rows)[: blocks // size * size].reshape(-1, size, 3).mean(axis=1).T
    return Arch(w, force, thrust)


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Elastic and crushing arch; ``quick``: two fifths of the way. Pushed down twice as fast hinges slip: 3 % less."""
    h, L, shares = p["h"], half_span(p), np.array(p["w"])
    shares = shares[shares <= 0.4 * shares.max()] if quick else shares
    seconds, w = SLOWLY * float(shares.max()), shares * h
    elastic, crushed = (lattice_arch(p, sigma_c, float(w.max()), seconds) for sigma_c in (np.inf, p["sigma_c"]))
    force, thrust = np.transpose([arch_of_beams(p, each) for each in w])
    F, T = (np.interp(w, crushed.w, y) for y in (crushed.force, crushed.thrust))
    # where the edges have crushed, and have not left so little of the arm that what 11 layers miss of a moment counts
    later = (shares >= 0.05) & (shares <= 0.4)
    found = np.interp(w, elastic.w, elastic.force)
    struts = p["E"] * h * (h - w) * (h**2 - (h - w) ** 2) / L**3
    return CaseResult(
        "crack-arch",
        p,
        [
            value("deflection of the middle", w, "m"),
            near("force of the elastic arch", found, "N/m", force, 0.03, SOURCE),
            near("thrust of the elastic arch", np.interp(w, elastic.w, elastic.thrust), "N/m", thrust, 0.03, SOURCE),
            near("largest force of the elastic arch, at snap-through where it gets so far", elastic.force.max(), "N/m",
                 max(arch_of_beams(p, each)[0] for each in np.linspace(0.1, 1.0, 50) * w.max()), 0.03, SOURCE),
            near("force of the crushing arch over 4 N z / 2 L, z = h - w - N / sigma_c",
                 (F * L / (2.0 * T * (h - w - T / p["sigma_c"])))[later], "-", np.ones(later.sum()), 0.03, SOURCE),
            value("thrust of the crushing arch", T, "N/m"),
            value("force of the crushing arch", F, "N/m"),
            value("force of the elastic arch over that of struts, E h u (h^2 - u^2) / L^3", found / struts, "-"),
        ],
        [_figure(p, elastic, crushed)],
    )  # fmt: skip


def _figure(p: dict[str, Any], elastic: Arch, crushed: Arch) -> Figure:
    def draw(figure: Any) -> None:
        axes, h = figure.subplots(), p["h"]
        s = np.linspace(0.02, 0.6, 60)
        beams = np.array([arch_of_beams(p, each * h)[0] for each in s])
        struts = p["E"] * h**4 * (1 - s) * (2 * s - s**2) / half_span(p) ** 3
        axes.plot(elastic.w / h, 1e-6 * elastic.force, label="lattice, elastic")
        axes.plot(crushed.w / h, 1e-6 * crushed.force, label="lattice, edges crush")
        axes.plot(s, 1e-6 * beams, "k--", label="beams with hinges, finite deflection")
        axes.plot(s, 1e-6 * struts, "k-", label="struts that turn")
        axes.plot(s, 1e-6 * beams[0] / s[0] * s, "k:", label="small rotations: the arm stays")
        axes.set(xlabel="w / h [-]", ylabel="force per width [MN/m]", xlim=(0, 0.6), ylim=(0, 2e-6 * beams.max()))
        axes.legend()

    return Figure("force", "Three-hinge arch: force over the deflection of its middle", draw)
