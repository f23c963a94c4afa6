"""The strength of the layers from a beam test: the beam is simulated, cracks and all, until it breaks as it did.

A section that softens is stronger in bending than in tension: when its face begins to crack the layers below still
pull. What a beam test measures is the load of the beam, so the strength of the layers is the one with which the
simulated beam, of cells as large as the sheet's, has that load; as section 4.2.2 of the thesis finds its factor f.

The beam is cut one cell wide from a clamped plate on water, its tip is pushed down at a steady speed, and the largest
force counts. A cell knows the moment at its middle, half a cell from the root, so the force is taken with that arm.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from lattice.cracks.engine import SLOW, CrackingEngine
from lattice.cracks.law import CrackLaw, law_of
from lattice.explicit.forces import NOTHING, indenter
from lattice.explicit.layout import W
from lattice.grid import BoolArray, Grid, IntArray
from lattice.ice import Ice
from lattice.properties import beam_strength
from lattice.state import State
from lattice.stiffness import hrennikoff

SPAN, WIDTH = 6.0, 2.0  #: length and width of a beam in thicknesses where no test is given: those of the basin's beam
FEWEST = 2  #: cells over the width of the beam, however large the sheet's are
#: simulations at most; difference of the load that counts as none, and the largest one that is taken, relative
TRIALS, CLOSE, ENOUGH = 12, 5e-3, 2e-2
FALL = 0.7  #: share of its largest load to which a broken beam has come down
#: time of a test and material damping of its ice in units of (h / g)^(1/2), so that a Froude copy of a beam has the
#: same test: 6 s and 0.1 ms for ice of 3 m, slow against the waves of the beam and the swing of the plate on water
SLOWLY, DAMPING = 10.85, 1.8e-4


@dataclass(frozen=True)
class Beam:
    """Cantilever that breaks at the load F, 6 F L / (w h^2) by beam theory."""

    length: float  #: L [m]
    width: float  #: w [m]
    load: float  #: F [N]

    def stress(self, h: float) -> float:
        """Nominal strength, (4.27) [Pa]."""
        return beam_strength(self.load, self.length, self.width, h)


def standard_beam(ice: Ice) -> Beam:
    """A beam of usual proportions that breaks at the flexural strength."""
    L, w = SPAN * ice.h, WIDTH * ice.h
    return Beam(L, w, ice.sigma_f * w * ice.h**2 / (6.0 * L))


@dataclass(frozen=True)
class CutBeam:
    """The beam on its lattice: a clamped square plate with a cut around the beam."""

    grid: Grid
    whole: BoolArray  #: (cells,) not cut
    tip: IntArray  #: nodes at the end
    arm: float  #: from the middle of the first row of cells inside the beam to the tip [m]


def cells_across(width: float, d: float) -> int:
    """Of about d [m] over the width of a beam [m]."""
    return max(FEWEST, round(width / d))


def cut_beam(beam: Beam, d: float) -> CutBeam:
    """Cells of about d [m]; a margin of half the length around the beam."""
    across = cells_across(beam.width, d)
    size = beam.width / across
    along = max(2, round(beam.length / size))
    n = along + 2 * max(2, round(0.5 * along)) + 1
    n += (n - across) % 2
    first, root = (n - across) // 2, (n - along) // 2
    grid, whole = Grid(n + 1, n + 1, size), np.ones((n, n), bool)
    whole[root : root + along, [first - 1, first + across]] = False
    whole[root + along, first - 1 : first + across + 1] = False
    tip = (root + along) * grid.ny + first + np.arange(across + 1)
    return CutBeam(grid, whole.ravel(), tip, (along - 0.5) * size)


class BeamTest:
    """A beam test with cracks that soften, close and slip."""

    def __init__(self, ice: Ice, law: CrackLaw, cut: CutBeam, slowly: float = SLOWLY):
        """The tip goes down steadily, so that theory breaks the elastic beam after half of ``slowly`` (h / g)^(1/2)."""
        ice = replace(ice, added_mass=0.0)  # and leaves the water time to go aside
        g, self.ice, self.cut, unit = cut.grid, ice, cut, math.sqrt(ice.h / ice.g)
        seconds = slowly * unit
        edge = np.zeros(g.nodes, bool)
        for side in ("x-", "x+", "y-", "y+"):
            edge[g.edge_nodes(side)] = True
        damping = 0.1 * np.sqrt(ice.k_f * ice.rho_i * ice.h)
        springs = hrennikoff(ice)
        options = {"held_in_plane": edge, "damping": damping, "alpha": DAMPING * unit, "sub_steps": SLOW}
        self.engine = CrackingEngine(g, ice, springs, seconds, law=law, **options)
        for kick in self.engine.mesh.kick:
            kick[edge.reshape(g.nx, g.ny).nonzero()] = 0.0  # clamped: no deflection, no rotation
        sag = ice.sigma_t * cut.arm**2 / (1.5 * ice.E * ice.h)  # F L^3 / 3 E I at F = sigma w h^2 / 6 L
        self.speed = 2.0 * sag / seconds
        self.live = cut.whole.copy()

    def strength(self) -> float:
        """Nominal strength at the largest force, 6 F a / (w h^2) with the arm a of `CutBeam` [Pa]."""
        e, tip, block = self.engine, self.cut.tip, 8
        everything = np.ones(self.cut.grid.nodes, bool)
        e.set_cells(self.live, np.full(len(self.live), self.ice.sigma_t), everything)
        e.start(State.rest(self.cut.grid.nodes), everything, ())
        spring = 0.1 * float(e.inertia_q[3 * tip].min()) / e.dt**2  # soft for the sub-step, stiff against the beam
        touch, largest, mean, t = indenter(tip, self.cut.grid.ny, spring), 0.0, 0.0, 0.0
        while t < 8.0 * e.window:
            touch.at[:, W] = -self.speed * (t + 0.5 * block * e.dt)
            made = e.march(block, NOTHING, touch, lively=False)
            t += made.steps * e.dt
            if made.failed:
                e.crack(self.live)
            mean += 0.05 * (-float(made.contact[:, W].sum()) - mean)  # over the tremor of the tip
            largest = max(largest, mean)
            if mean < FALL * largest and t > 0.1 * e.window:
                width = (len(tip) - 1) * self.cut.grid.d
                return 6.0 * largest * self.cut.arm / (width * self.ice.h**2)
        raise ValueError(
            f"the simulated beam did not break after {t:.0f} s: a fracture energy of this size lets it bend"
        )


@lru_cache(maxsize=32)  # of the runs of a sweep in one process only the first simulates its beam
def layer_strength(ice: Ice, mu: float, fracture_energy: float, beam: Beam, d: float) -> float:
    """Strength of the layers with which the simulated beam breaks at its load [Pa]; cells of about ``d`` [m]."""
    wanted, sigma, cut = beam.stress(ice.h), beam.stress(ice.h) / 1.3, cut_beam(beam, d)
    best, error = sigma, np.inf
    for _ in range(TRIALS):
        trial = replace(ice, sigma_t=sigma, sigma_f=sigma, beam_test=None)
        found = BeamTest(trial, law_of(trial, fracture_energy, mu, cut.grid.d), cut).strength()
        if abs(found / wanted - 1.0) < error:
            best, error = sigma, abs(found / wanted - 1.0)
        if error <= CLOSE:
            break
        sigma *= (wanted / found) ** 0.8  # less than in proportion: brittle beams break in jerks
    if error > ENOUGH:
        raise ValueError(
            f"no strength of the layers found: after {TRIALS} simulated beams the nearest breaks {error:.1%} off "
            f"{wanted:.4g} Pa; give fracture.layer_strength"
        )
    return best
