"""The ice from above: the sheet by utilisation, cracks with their depth, failed cells with their time, blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.recording import shapes
from cosim.recording.pictures import Picture
from cosim.show.ice.frame import set_frame
from cosim.show.ice.history import Look
from cosim.show.ice.palette import AGE, BLOCK, CRACK, EDGE, FORCE, SHALLOW, STRUCTURE, WATER, colormap
from cosim.show.ice.scene import Scene
from cosim.show.scale import scale_of
from coupling.interface import NS, Array, IntArray, Phase

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AHEAD, ASIDE, BEHIND = 2.6, 2.2, 1.3  #: half widths of the structure that are shown in front, beside and behind
LEAST = 14.0  #: thicknesses that are shown in front at least
FAINT = 0.06  #: cracks that are shallower than this share of the thickness are left out


def draw_plan(ax: Axes, scene: Scene, look: Look, whole: bool = False, fill: bool = False) -> None:
    """From above; around the structure, or the ``whole`` floe; with ``fill`` as much as the axes have room for."""
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
    corners, colours = _draw_blocks(ax, picture)
    outline = scene.waterline()
    above = 6.0 if scene.structure.faces_down else 1.2  # ice rides up on a face that looks up
    if len(outline) == 2:  # a slope that does not end
        far = outline[::-1] + np.array([1e3 * scene.thickness, 0.0])
        outline = np.concatenate((outline, far)) * np.array([1.0, 10.0])
    structure = ax.add_patch(Polygon(outline, closed=True, fc=STRUCTURE, ec=EDGE, lw=0.8, zorder=above))
    if scene.structure.faces_down:
        _draw_hidden(ax, structure, corners, colours)
    _draw_forces(ax, scene, picture)
    ax.axhline(scene.centre(scene.section_at(look.section)), color=EDGE, lw=0.8, ls=(0, (6, 4)), zorder=7)
    for shown, label in ((cells, "utilisation (fails at 1)"), (lost, "time of failure [s]")):
        if shown is not None and not (fill and shown is cells):  # filled axes stand beside a picture with that bar
            _bar(ax, shown, label)
    ax.set(xlabel="x [m], the ice drifts to the right", ylabel="y [m]")
    set_frame(ax, frame, fill)
    grey = "; grey: cracked, darker as cracks are deeper" if fill and len(cracked_cells(picture)[0]) else ""
    ax.set_title(f"from above at {picture.t_ns / NS:.2f} s{grey}", fontsize=9)


def _draw_hidden(ax: Axes, structure: Any, corners: Array, colours: list[str]) -> None:
    """Outlines of the blocks below a ``structure`` that is drawn over them."""
    from matplotlib.collections import LineCollection

    hidden = LineCollection([np.concatenate((c, c[:1])) for c in corners], colors=colours, lw=0.9, ls=(0, (2, 1.5)))
    hidden.set_zorder(structure.get_zorder() + 0.05)
    hidden.set_clip_path(structure)
    hidden.set_in_layout(False)
    ax.add_collection(hidden, autolim=False)


def _bar(ax: Axes, shown: Any, label: str) -> None:
    """What its colours mean, with few numbers."""
    from matplotlib.ticker import MaxNLocator

    bar = ax.figure.colorbar(shown, ax=ax, shrink=0.7, pad=0.03, ticks=MaxNLocator(5, min_n_ticks=2))
    bar.set_label(label, fontsize=8)
    bar.ax.tick_params(labelsize=8)


def extent(scene: Scene, picture: Picture, whole: bool) -> tuple[float, float, float, float]:
    """What is shown: x and y from, to [m]."""
    radius = scene.structure.half_width if np.isfinite(scene.structure.half_width) else 0.5 * scene.width
    if whole and picture.sheet.present.any():
        place = picture.sheet.position[picture.sheet.present]
        low, high = place.min(axis=0), place.max(axis=0)
        return low[0] - radius * 0.1, radius * BEHIND, min(low[1], -radius) * 1.03, max(high[1], radius) * 1.03
    x, y = scene.place[:2]
    front = float(np.nan_to_num(scene.structure.face_x(0.0, 0.0)))
    ahead, aside = max(AHEAD * radius, LEAST * scene.thickness), min(ASIDE * radius, 0.55 * scene.width)
    return x + front - ahead, x + max(radius * BEHIND, front + 4 * scene.thickness), y - aside, y + aside


def cracked_cells(picture: Picture) -> tuple[IntArray, Array]:
    """Nodes (k, 4) of the cells that are cracked and hold, and the depth of their cracks (k,), part of the thickness.

    Those that have begun to crack, however shallow: they are judged no more, their utilisation is none. Where it is not
    known which they are, those with cracks deeper than `FAINT`.

    Damage is known at nodes, as the mean of their cells: a cell of a line of cracks has nodes two of whose four cells
    are cracked.
    """
    sheet, known = picture.sheet, picture.elastic is not None
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    depth = np.minimum(2.0 * sheet.damage[quads].min(axis=1), 1.0) if len(quads) else np.empty(0)
    deep = np.flatnonzero(picture.begun[sheet.intact] if known else depth > FAINT)
    return quads[deep], depth[deep]


def _draw_cracks(ax: Axes, picture: Picture) -> None:
    """Cells that are cracked and hold: grey, darker as their cracks are deeper."""
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import LinearSegmentedColormap

    quads, depth = cracked_cells(picture)
    if len(quads):
        ramp = LinearSegmentedColormap.from_list("depth", [SHALLOW, CRACK])
        cracks = PolyCollection(list(picture.sheet.position[quads, :2]), fc=ramp(depth), lw=0.3, zorder=3)
        cracks.set_edgecolor("face")
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


def _draw_blocks(ax: Axes, picture: Picture) -> tuple[Array, list[str]]:
    """Blocks as rectangles, their extent along x, their width across: corners (n, 4, 2) and colours."""
    from matplotlib.collections import PolyCollection

    b = picture.blocks
    if not b.count:
        return np.empty((0, 4, 2)), []
    low, high = (take.reduceat(b.outline[:, 0], b.offset[:-1]) for take in (np.minimum, np.maximum))
    left, right = b.position[:, 1] - b.width / 2, b.position[:, 1] + b.width / 2
    corners = np.stack(
        [np.stack(pair, -1) for pair in ((low, left), (high, left), (high, right), (low, right))], axis=1
    )
    order = np.argsort(b.position[:, 2])
    colours = [BLOCK[Phase(int(p))] for p in b.phase[order]]
    ax.add_collection(PolyCollection(list(corners[order]), fc=colours, ec=EDGE, lw=0.3, alpha=0.9, zorder=1.5))
    return corners[order], colours


def _draw_forces(ax: Axes, scene: Scene, picture: Picture) -> None:
    forces = picture.forces
    largest = float(np.linalg.norm(forces.force[:, :2], axis=1).max(initial=0.0))
    if largest == 0.0:
        return
    style: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "width": 0.003, "color": FORCE, "zorder": 8}
    ax.quiver(*forces.position[:, :2].T, *forces.force[:, :2].T, scale=largest / (4.0 * scene.thickness), **style)
    text = f"longest arrow {scale_of((largest,), 'N').labelled(largest)}"
    box = {"fc": "w", "ec": "none", "alpha": 0.9, "pad": 1.5}
    ax.text(0.98, 0.03, text, transform=ax.transAxes, ha="right", fontsize=7, color=FORCE, zorder=9, bbox=box)
