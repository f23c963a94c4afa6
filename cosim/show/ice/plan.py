"""The ice from above: the sheet by utilisation, cracks with their depth, failed cells with their time, blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.recording import shapes
from cosim.recording.pictures import Picture
from cosim.show.ice.history import Look
from cosim.show.ice.palette import AGE, BLOCK, CRACK, EDGE, FORCE, STRUCTURE, WATER, colormap
from cosim.show.ice.scene import Scene
from cosim.show.scale import scale_of
from coupling.interface import NS, Array, IntArray, Phase, SheetView

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AHEAD, ASIDE, BEHIND = 2.6, 2.2, 1.3  #: half widths of the structure that are shown in front, beside and behind
LEAST = 14.0  #: thicknesses that are shown in front at least
FAINT = 0.06  #: cracks that are shallower than this share of the thickness are left out


def draw_plan(ax: Axes, scene: Scene, look: Look, whole: bool = False, bars: bool = True) -> None:
    """From above; around the structure, or the ``whole`` floe; with ``bars`` of the colours."""
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.patches import Polygon

    picture, failures = look.picture, look.failures
    frame = extent(scene, picture, whole)
    ax.set_facecolor(WATER)
    sheet = picture.sheet
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    use = sheet.utilisation[quads].max(axis=1) if len(quads) else np.empty(0)
    cells = PolyCollection(list(sheet.position[quads, :2]), array=use, cmap=colormap(), lw=0.3, zorder=2)
    cells.set_clim(0.0, 1.0)
    cells.set_edgecolor("face")
    ax.add_collection(cells)
    ax.add_collection(LineCollection(list(sheet.position[shapes.rim(quads), :2]), colors=EDGE, lw=0.7, zorder=4))
    _draw_cracks(ax, picture)
    lost = _draw_failed(ax, picture, failures)
    _draw_blocks(ax, picture)
    outline = scene.waterline()
    ax.add_patch(Polygon(outline, closed=len(outline) > 2, fc=STRUCTURE, ec=EDGE, lw=0.8, zorder=6))
    _draw_forces(ax, scene, picture)
    ax.axhline(scene.centre(scene.section_at(look.section)), color=EDGE, lw=0.8, ls=(0, (6, 4)), zorder=7)
    for shown, label in ((cells, "utilisation (fails at 1)"), (lost, "time of failure [s]")):
        if bars and shown is not None:
            ax.figure.colorbar(shown, ax=ax, shrink=0.6, pad=0.02).set_label(label, fontsize=8)
    ax.set(xlim=frame[:2], ylim=frame[2:], xlabel="x [m], the ice drifts to the right", ylabel="y [m]", aspect="equal")
    ax.set_title(f"from above at {picture.t_ns / NS:.2f} s", fontsize=9)


def extent(scene: Scene, picture: Picture, whole: bool) -> tuple[float, float, float, float]:
    """What is shown: x and y from, to [m]."""
    radius = scene.structure.half_width if np.isfinite(scene.structure.half_width) else 0.5 * scene.width
    if whole and picture.sheet.present.any():
        place = picture.sheet.position[picture.sheet.present]
        low, high = place.min(axis=0), place.max(axis=0)
        return low[0] - radius * 0.1, radius * BEHIND, min(low[1], -radius) * 1.03, max(high[1], radius) * 1.03
    front = float(np.nan_to_num(scene.structure.face_x(0.0, 0.0)))
    ahead, aside = max(AHEAD * radius, LEAST * scene.thickness), min(ASIDE * radius, 0.55 * scene.width)
    return front - ahead, max(radius * BEHIND, front + 4 * scene.thickness), -aside, aside


def cracked_cells(sheet: SheetView) -> tuple[IntArray, Array]:
    """Nodes (k, 4) of the cells that are cracked and hold, and the depth of their cracks (k,), part of the thickness.

    Damage is known at nodes, as the mean of their cells: a cell of a line of cracks has nodes two of whose four cells
    are cracked.
    """
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    depth = np.minimum(2.0 * sheet.damage[quads].min(axis=1), 1.0) if len(quads) else np.empty(0)
    deep = np.flatnonzero(depth > FAINT)
    return quads[deep], depth[deep]


def _draw_cracks(ax: Axes, picture: Picture) -> None:
    """Cells that are cracked and hold: darker as their cracks are deeper."""
    from matplotlib.collections import PolyCollection

    quads, depth = cracked_cells(picture.sheet)
    if len(quads):
        cracks = PolyCollection(list(picture.sheet.position[quads, :2]), fc=CRACK, lw=0, zorder=3)
        cracks.set_alpha(list(0.85 * depth))
        ax.add_collection(cracks)


def _draw_failed(ax: Axes, picture: Picture, failures: Array) -> Any:
    """Failed cells between nodes that are still there, by the time at which they failed."""
    from matplotlib.collections import PolyCollection

    sheet = picture.sheet
    all_cells = shapes.cell_quads(np.ones(len(sheet.intact), bool), sheet.cell_shape)
    open_cells = np.flatnonzero(~sheet.intact & sheet.present[all_cells].all(axis=1))
    if not len(open_cells):
        return None
    cells = PolyCollection(
        list(sheet.position[all_cells[open_cells], :2]), array=failures[open_cells], cmap=AGE, zorder=3
    )
    cells.set_edgecolor("face")
    ax.add_collection(cells)
    return cells


def _draw_blocks(ax: Axes, picture: Picture) -> None:
    """Blocks as rectangles: their extent along x, their width across."""
    from matplotlib.collections import PolyCollection

    b = picture.blocks
    if not b.count:
        return
    low, high = (take.reduceat(b.outline[:, 0], b.offset[:-1]) for take in (np.minimum, np.maximum))
    left, right = b.position[:, 1] - b.width / 2, b.position[:, 1] + b.width / 2
    corners = np.stack(
        [np.stack(pair, -1) for pair in ((low, left), (high, left), (high, right), (low, right))], axis=1
    )
    order = np.argsort(b.position[:, 2])
    colours = [BLOCK[Phase(int(p))] for p in b.phase[order]]
    ax.add_collection(PolyCollection(list(corners[order]), fc=colours, ec=EDGE, lw=0.3, alpha=0.9, zorder=1.5))


def _draw_forces(ax: Axes, scene: Scene, picture: Picture) -> None:
    forces = picture.forces
    largest = float(np.linalg.norm(forces.force[:, :2], axis=1).max(initial=0.0))
    if largest == 0.0:
        return
    style: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "width": 0.003, "color": FORCE, "zorder": 8}
    ax.quiver(*forces.position[:, :2].T, *forces.force[:, :2].T, scale=largest / (4.0 * scene.thickness), **style)
    text = f"longest arrow {scale_of((largest,), 'N').labelled(largest)}"
    ax.text(0.98, 0.02, text, transform=ax.transAxes, ha="right", fontsize=7, color=FORCE, zorder=9)
