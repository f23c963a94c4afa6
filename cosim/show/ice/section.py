"""A vertical section: sheet, blocks, structure, water, forces, in x and z at one y."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from cosim.recording.pictures import BlockShapes, Picture
from cosim.show.ice.frame import set_frame
from cosim.show.ice.palette import BLOCK, EDGE, FORCE, HATCH, ICE, STRUCTURE, WATER, WATERLINE
from cosim.show.ice.scene import Scene
from cosim.show.scale import scale_of
from coupling.interface import NS, Array, IntArray, Phase, SheetView

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AHEAD, BEHIND = 9.0, 5.0  #: thicknesses that are shown in front of the face and behind it
FAR = 1000.0  #: thicknesses down to which there is water
#: look of a plate of another section that reaches into this one: pale, and not before the structure, as its outline is
#: that at its middle
REACHES: dict[str, Any] = {"alpha": 0.45, "ec": EDGE, "ls": (0, (3, 2)), "lw": 0.6, "zorder": 2.0}
ARROW = 3.0  #: length of the largest force, in thicknesses


def draw_section(ax: Axes, scene: Scene, picture: Picture, y: float, fill: bool = False) -> None:
    """The section that holds ``y`` [m]; with ``fill`` as much of it as the axes have room for."""
    from matplotlib.patches import Polygon

    h, key = scene.thickness, scene.section_at(y)
    y = scene.centre(key)
    frame = extent(scene, y)
    ax.axhspan(-FAR * h, 0.0, color=WATER, lw=0, zorder=0)
    ax.axhline(0.0, color=WATERLINE, lw=0.8, zorder=1)
    if len(cut := scene.cut(y)):
        ax.add_patch(Polygon(cut, closed=True, fc=STRUCTURE, ec=EDGE, lw=0.8, zorder=3))
    for corners in sheet_parts(picture.sheet, y, h):
        ax.add_patch(Polygon(corners, closed=True, fc=ICE, ec=EDGE, lw=0.35, zorder=4))
    blocks = picture.blocks
    for k in cut_blocks(blocks, y):
        phase, mine = Phase(int(blocks.phase[k])), int(blocks.section[k]) == key
        corners = blocks.outline[blocks.offset[k] : blocks.offset[k + 1]]
        look = {"hatch": HATCH[phase], "ec": EDGE, "lw": 0.6, "zorder": 5.0} if mine else REACHES
        ax.add_patch(Polygon(corners, closed=True, fc=BLOCK[phase], **look))
    _draw_forces(ax, picture, scene, key)
    ax.set(xlabel="x [m]", ylabel="z [m]")
    set_frame(ax, frame, fill)
    ax.set_title(f"section y = {y:.3g} m at {picture.t_ns / NS:.2f} s", fontsize=9)


def extent(scene: Scene, y: float) -> tuple[float, float, float, float]:
    """What is shown: x and z from, to [m]."""
    h, cut = scene.thickness, scene.cut(y)
    face = scene.place[0] + float(np.nan_to_num(scene.structure.face_x(y - scene.place[1], 0.0)))
    depth = min(float(cut[:, 1].min()) if len(cut) else -4.0 * h, -4.0 * h)
    top = max(2.5 * h, min(scene.structure.top, 5.0 * h))
    return face - AHEAD * h, face + BEHIND * h, max(depth, -8.0 * h) - 0.5 * h, top


def cut_blocks(blocks: BlockShapes, y: float) -> IntArray:
    """Numbers of the blocks that a section cuts: a plate lies in all sections that it is wide enough to reach.

    What is recorded of it is the outline in the section of its middle.
    """
    return np.flatnonzero(np.abs(blocks.position[:, 1] - y) <= 0.5 * blocks.width)


def sheet_parts(sheet: SheetView, y: float, h: float) -> list[Array]:
    """Corners (4, 2) in x and z of the ice between two nodes, in the columns of cells that hold ``y``."""
    rows, columns = sheet.shape
    if not sheet.present.any():
        return []
    place = sheet.position.reshape(rows, columns, 3)
    here = np.where(sheet.present.reshape(rows, columns), place[..., 1], np.nan)
    middle = np.nanmedian(here, axis=0)
    j = int(np.nanargmin(np.abs(0.5 * (middle[1:] + middle[:-1]) - y)))
    intact = sheet.intact.reshape(sheet.cell_shape)[:, j]
    line = place[:, j : j + 2].mean(axis=1)[:, [0, 2]]
    half = np.array([0.0, 0.5 * h])
    return [
        np.array([line[i] - half, line[i + 1] - half, line[i + 1] + half, line[i] + half])
        for i in np.flatnonzero(intact)
    ]


def _draw_forces(ax: Axes, picture: Picture, scene: Scene, key: int) -> None:
    forces = picture.forces
    largest = float(np.linalg.norm(forces.force[:, [0, 2]], axis=1).max(initial=0.0))
    if largest == 0.0:
        return
    text = f"longest arrow of all sections {scale_of((largest,), 'N').labelled(largest)}"
    box = {"fc": "w", "ec": "none", "alpha": 0.9, "pad": 1.5}
    ax.text(0.02, 0.03, text, transform=ax.transAxes, fontsize=7, color=FORCE, zorder=9, bbox=box)
    near = np.abs(forces.position[:, 1] - scene.centre(key)) <= 0.5 * scene.pitch * (1 + 1e-6)
    for place, force in zip(forces.position[near], forces.force[near], strict=True):
        end = place[[0, 2]] + force[[0, 2]] / largest * ARROW * scene.thickness
        style = {"arrowstyle": "-|>", "color": FORCE, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", tuple(end), tuple(place[[0, 2]]), arrowprops=style, zorder=7)
