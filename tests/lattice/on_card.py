"""The same sheet on the explicit engine of the host and on that of the card, which is numba's simulator here.

Run by `test_cuda.py` in a process of its own, since numba looks for NUMBA_ENABLE_CUDASIM once; prints JSON.
"""

import json

import numpy as np

from lattice.cuda.engine import CardEngine
from lattice.explicit.engine import ExplicitEngine
from lattice.explicit_sheet import ExplicitSheet
from lattice.grid import Grid
from lattice.ice import BeamTest, Ice
from lattice.loads import NodeLoad
from lattice.stiffness import hrennikoff
from lattice.varied import Varied

GRID = Grid(7, 5, 3.0)
ICE = Ice(
    E=8.7e9,
    nu=1 / 3,
    h=3.0,
    rho_i=846.0,
    rho_w=1006.0,
    sigma_t=750e3,
    sigma_f=900e3,
    sigma_c=4e6,
    beam_test=BeamTest(length=18.0, width=6.0, failure_load=375e3, factor=0.75),
)
WINDOW, WINDOWS = 2e-3, 5


class Cushion:
    """Presses the front edge back and down, the more the further it has come."""

    nodes = GRID.edge_nodes("x+")
    height, lead = np.full(GRID.ny, 0.8), np.full(GRID.ny, 0.3)

    def evaluate(self, t, y):
        direction, k = np.array([-1.0, 0.2, -0.8]), 3e7
        tangent = np.zeros((len(y), 3, 3))
        tangent[:, :, 0] = tangent[:, :, 2] = k * direction
        return k * (0.2 * t + y[:, 0] + y[:, 2])[:, None] * direction, tangent


def varied():
    rng = np.random.default_rng(2)
    strength, thickness, E = (rng.uniform(0.9, 1.1, GRID.cells) for _ in range(3))
    return Varied(strength, thickness, E)


def run(kind, damping):
    """A sheet of varying ice, held at the back and on one side, pulled until cells fail and pressed at its front."""
    held = np.zeros((GRID.nodes, 2), bool)
    held[GRID.edge_nodes("x-")] = True
    held[GRID.edge_nodes("y-"), 1] = True
    e = kind(GRID, ICE, hrennikoff(ICE), WINDOW, held_in_plane=held, damping=damping, alpha=2e-5, varied=varied())
    sheet, left, series = ExplicitSheet(e, share=0.3), [], []
    F_u, F_q = np.zeros((GRID.nodes, 2)), np.zeros((GRID.nodes, 3))
    F_u[GRID.nodes // 2 :, 0], F_q[GRID.node(4, 2)] = 1.6e6, (-2e6, 1e6, -3e6)
    sheet.state.u_dot[:, 1] = 0.01 * np.sin(GRID.xy[:, 0])
    for k in range(WINDOWS):
        loads = [NodeLoad("pull", F_u, np.zeros((GRID.nodes, 3))), NodeLoad("bend", np.zeros((GRID.nodes, 2)), F_q)]
        out = sheet.advance(WINDOW * k, loads, Cushion(), lambda nodes: left.append(nodes.tolist()))
        series.append((out.contact_mean.sum(axis=0), out.reaction))
    return sheet, left, series


def numbers(sheet, series):
    """All that a run comes to: state, books, forces, times of failures."""
    e = sheet.energy
    books = [e.damping, e.hold, e.scheme, e.fracture, e.contact, e.received, e.pieces.energy, e.stored]
    forces = [(*mean, *r.foundation, *r.drag, *r.inertia, *r.held, *r.applied["pull"]) for mean, r in series]
    return {
        **sheet.state._asdict(),
        "books": np.array(books),
        "forces": np.array(forces),
        "times": np.array(sheet.failure_times),
        "utilisation": sheet.utilisation,
    }


def apart(one, two):
    """Largest difference over the largest value, for each of `numbers`."""
    return {name: float(np.abs(one[name] - two[name]).max() / np.abs(one[name]).max()) for name in one}


def main():
    (host, gone, series), (card, left, on_card) = run(ExplicitEngine, 2000.0), run(CardEngine, 2000.0)
    twin = run(ExplicitEngine, 2000.2)
    told = {
        "cells": [host.failed_cells, card.failed_cells],
        "left": [gone, left],
        "apart": apart(numbers(host, series), numbers(card, on_card)),
        "twin": apart(numbers(host, series), numbers(twin[0], twin[2])),
        "loose": float(abs(card.energy.residual) / card.energy.received),
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
