"""Case `crack-spacing`: how near to a crack a face of the ice is stressed as if there were none.

A strip of thickness h is cut to the depth a and bent; or it is cut through and pressed together by a thrust N at the
distance e of its middle, and opens as far as nothing pulls: a hinge. What the crack takes from the beam's stress has
neither force nor moment, and fades like exp(-4.212 x / h) (principle of Saint-Venant; smallest root of
sin(2 s) + 2 s = 0: Fadle 1940, Johnson and Little 1965). A thickness away 1.5 % are left at most: nothing elastic keeps
the next crack further away than that. Bilinear finite elements in plane stress, no lattice.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from cosim.verify.case import CaseResult, Figure, at_most, near, value
from lattice.edge_crack import stiffness
from lattice.grid import Array, BoolArray, Grid

PARAMETERS: dict[str, Any] = {
    "elements": 48,
    "length": 5.0,
    "depths": [0.1, 0.3, 0.5, 0.7],
    "eccentricities": [0.25, 0.3, 0.35, 0.4, 0.45],
    "distances": [0.25, 0.5, 0.75, 1.0, 1.5, 2.0],
}
ROOT = 4.212  #: real part of the smallest root, times two
SOURCE = f"beam theory; exp(-{ROOT} x / h) is {np.exp(-ROOT):.3f} at x = h"
PURE = 1e6  #: eccentricity of a thrust that does nothing but bend, in thicknesses
TURNS = 100  #: times that the hinge is looked at, node by node


class Strip(NamedTuple):
    """Half of a strip of thickness 1, from the crack at x = 0 on; its face in tension is y = 0."""

    grid: Grid
    K: sp.csc_matrix  #: stiffness over E
    load: Array  #: of a thrust of 1 at its end, with the moment of its eccentricity
    tension: float  #: of the beam at the face

    @classmethod
    def of(cls, n: int, length: float, eccentricity: float) -> Strip:
        """``n`` elements over the thickness."""
        grid = Grid(round(length * n) + 1, n + 1, 1.0 / n)
        y = np.arange(n + 1) / n
        stress = 12.0 * eccentricity * (0.5 - y) - 1.0
        share = np.zeros(n + 1)  # consistent with a stress that is linear over an element
        share[:-1] += (2.0 * stress[:-1] + stress[1:]) / (6.0 * n)
        share[1:] += (stress[:-1] + 2.0 * stress[1:]) / (6.0 * n)
        load = np.zeros(2 * grid.nodes)
        load[2 * grid.edge_nodes("x+")] = share
        return cls(grid, stiffness(grid), load, float(stress[0]))

    def solve(self, closed: BoolArray) -> tuple[Array, Array]:
        """Displacements (dofs,) and the reactions along x of the nodes at x = 0, where those ``closed`` are held."""
        line = 2 * self.grid.edge_nodes("x-")
        middle = 2 * int(self.grid.edge_nodes("x+")[0]) + 1
        free = np.setdiff1d(np.arange(len(self.load)), np.append(line[closed], middle))
        u = np.zeros(len(self.load))
        u[free] = splu(self.K[free][:, free]).solve(self.load[free])
        return u, (self.K @ u - self.load)[line]

    def beside(self, u: Array) -> tuple[Array, Array]:
        """Distances from the crack, and there the stress at the face over that of the beam."""
        g = self.grid
        face = 2 * g.edge_nodes("y-")
        x = np.asarray((np.arange(g.nx - 1) + 0.5) * g.d, np.float64)
        return x, np.asarray(np.diff(u[face]) / g.d / self.tension, np.float64)


def cut(n: int, length: float, depth: float) -> tuple[Array, Array]:
    """As `Strip.beside`, of a strip that is bent and cut to a depth."""
    strip = Strip.of(n, length, PURE)
    closed = np.arange(n + 1) > round(depth * n)
    return strip.beside(strip.solve(closed)[0])


def hinge(n: int, length: float, eccentricity: float) -> tuple[Array, Array, float]:
    """The same of a strip that is cut through, and how deep it is open; RuntimeError if that is not found."""
    strip = Strip.of(n, length, eccentricity)
    line, closed = 2 * strip.grid.edge_nodes("x-"), np.arange(n + 1) > n // 2
    for _ in range(TURNS):
        u, reaction = strip.solve(closed)
        now = np.where(closed, reaction > 0.0, u[line] < 0.0)
        if (now == closed).all():
            return (*strip.beside(u), float(np.argmax(closed)) / n)
        closed = now
    raise RuntimeError(f"a hinge under a thrust at {eccentricity:g} h: which part of it is open was not found")


def run(p: dict[str, Any], quick: bool) -> CaseResult:
    """Stress beside cracks and hinges, at some distances and a thickness away."""
    n, at = int(p["elements"]) // (2 if quick else 1), np.array(p["distances"])
    curves, quantities = {}, [value("distance from the crack", at, "h")]
    for depth in p["depths"]:
        curves[f"bent, cut to {depth:g} h"] = cut(n, p["length"], depth)
    for e in p["eccentricities"]:
        x, stress, depth = hinge(n, p["length"], e)
        curves[f"hinge, thrust at {e:g} h, open to {depth:.2f} h"] = x, stress
    for name, (x, stress) in curves.items():
        quantities.append(value(f"stress at the face over the beam's: {name}", np.interp(at, x, stress), "-"))
    away = [float(np.interp(1.0, x, stress)) for x, stress in curves.values()]
    close = [float(np.interp(0.25, x, stress)) for x, stress in curves.values()]
    quantities.append(near("the same a thickness away, all of them", away, "-", np.ones(len(away)), 0.02, SOURCE))
    quantities.append(at_most("the same a quarter of a thickness away, all of them", max(close), "-", 0.8, SOURCE))
    return CaseResult("crack-spacing", p, quantities, [_figure(curves)])


def _figure(curves: dict[str, tuple[Array, Array]]) -> Figure:
    def draw(figure: Any) -> None:
        axes = figure.subplots()
        for name, (x, stress) in curves.items():
            axes.plot(x, stress, "--" if name.startswith("hinge") else "-", label=name)
        x = np.linspace(0.2, 2.0, 100)
        for sign, label in ((-1.0, f"1 -+ exp(-{ROOT} x / h)"), (1.0, None)):
            axes.plot(x, 1.0 + sign * np.exp(-ROOT * x), "k:", lw=1, label=label)
        axes.set(xlabel="distance from the crack x / h", ylabel="stress at the face over that of the beam", xlim=(0, 2))
        axes.legend(fontsize=7)

    return Figure("beside", "The face of the ice beside a crack", draw)
