"""The sheet as observers see it."""

from __future__ import annotations

import numpy as np

from coupling.compiled import compiled
from coupling.interface import Array, BoolArray, IntArray, SheetView
from coupling.sheet_port.motion import Motion
from lattice.floe import Floe


@compiled()
def _at_nodes(
    cell_nodes: IntArray, nodes: int, damage: Array, live: BoolArray, utilisation: Array
) -> tuple[Array, Array]:
    """Mean damage of the cells and largest utilisation of live ones around each node, (nodes,) both."""
    every, failed, worst = np.zeros(nodes), np.zeros(nodes), np.zeros(nodes)
    for c in range(cell_nodes.shape[0]):
        for n in cell_nodes[c]:
            every[n] += 1.0
            failed[n] += damage[c]
            if live[c] and utilisation[c] > worst[n]:
                worst[n] = utilisation[c]
    return failed / every, worst


def view(sheet: Floe, motion: Motion) -> SheetView:
    """Positions, damage and utilisation."""
    g, live = sheet.grid, sheet.live_cells
    damage, utilisation = _at_nodes(g.cell_nodes, g.nodes, sheet.damage, live, sheet.utilisation)
    return SheetView(
        position=motion.position(np.arange(g.nodes)),
        damage=damage,
        utilisation=utilisation,
        present=sheet.present.copy(),
        intact=sheet.joins & sheet.present[g.cell_nodes].all(axis=1),
        shape=(g.nx, g.ny),
        cell_shape=(g.nx - 1, g.ny - 1),
    )
