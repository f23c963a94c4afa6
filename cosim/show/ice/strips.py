"""Section and plan as closed lines with a colour each, for a viewer that draws lines. Up is up: x, then -z or -y."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cosim.recording import shapes
from cosim.recording.pictures import BlockShapes, Picture
from cosim.show.ice.plan import cracked_cells
from cosim.show.ice.scene import Scene
from cosim.show.ice.section import cut_blocks, sheet_parts
from coupling.interface import Array, Phase

ICE_RGB, EDGE_RGB, CRACK_RGB, FORCE_RGB = (226, 238, 247), (200, 214, 226), (226, 75, 60), (255, 90, 150)
DOWN = np.array([1.0, -1.0])  #: pictures of viewers have their second axis downwards


@dataclass(frozen=True)
class Strips:
    """Lines of one picture, of one kind."""

    name: str
    lines: list[Array]  #: each (k, 2) [m]
    rgb: list[tuple[int, int, int]]  #: of each
    width: float  #: on the screen


def closed(corners: Array) -> Array:
    """A line that comes back to where it began, as viewers draw it."""
    return np.asarray(np.concatenate((corners, corners[:1])) * DOWN)


def still_strips(scene: Scene, section: int) -> list[Strips]:
    """The structure in plan and section, and the water line."""
    cut, y = scene.cut(scene.centre(section)), scene.width
    far = 0.6 * y
    found = [
        Strips("plan/structure", [closed(scene.waterline())], [shapes.STRUCTURE_RGB], 2.0),
        Strips("section/water", [np.array([[-far, 0.0], [far, 0.0]])], [(90, 150, 190)], 1.0),
    ]
    return [*found, Strips("section/structure", [closed(cut)], [shapes.STRUCTURE_RGB], 2.5)] if len(cut) else found


def moving_strips(scene: Scene, picture: Picture, section: int) -> list[Strips]:
    """Sheet, blocks and forces in the section; outlines of the pieces, cracks and blocks in the plan."""
    return [*_section(scene, picture, section), *_plan(picture)]


def _section(scene: Scene, picture: Picture, section: int) -> list[Strips]:
    b, forces = picture.blocks, picture.forces
    ice = [closed(corners) for corners in sheet_parts(picture.sheet, scene.centre(section), scene.thickness)]
    mine = cut_blocks(b, scene.centre(section))
    blocks = [closed(b.outline[b.offset[k] : b.offset[k + 1]]) for k in mine]
    near = np.abs(forces.position[:, 1] - scene.centre(section)) <= 0.5 * scene.pitch * (1 + 1e-6)
    largest = max(float(np.linalg.norm(forces.force[:, [0, 2]], axis=1).max(initial=0.0)), 1e-30)
    ends = forces.position[:, [0, 2]] + forces.force[:, [0, 2]] / largest * 3.0 * scene.thickness
    arrows = [np.array([forces.position[k, [0, 2]], ends[k]]) * DOWN for k in np.flatnonzero(near)]
    return [
        Strips("section/sheet", ice, [ICE_RGB] * len(ice), 1.5),
        Strips("section/rubble", blocks, [_block_rgb(b, k, section) for k in mine], 2.0),
        Strips("section/forces", arrows, [FORCE_RGB] * len(arrows), 2.5),
    ]


def _block_rgb(blocks: BlockShapes, k: int, section: int) -> tuple[int, int, int]:
    """By phase; half as bright for a plate of another section that reaches into this one."""
    rgb = shapes.PHASE_RGB[Phase(int(blocks.phase[k]))]
    return rgb if blocks.section[k] == section else (rgb[0] // 2, rgb[1] // 2, rgb[2] // 2)


def _plan(picture: Picture) -> list[Strips]:
    sheet, b = picture.sheet, picture.blocks
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    rim = list(sheet.position[shapes.rim(quads), :2] * DOWN) if len(quads) else []
    cracks, depth = cracked_cells(picture)
    dark = [closed(sheet.position[cell, :2]) for cell in cracks[depth > 0.5]]
    corners = []
    for k in range(b.count):
        x, half = b.outline[b.offset[k] : b.offset[k + 1], 0], b.width[k] / 2
        left, right = b.position[k, 1] - half, b.position[k, 1] + half
        low, high = x.min(), x.max()
        corners.append(closed(np.array([(low, left), (high, left), (high, right), (low, right)])))
    return [
        Strips("plan/edges", rim, [EDGE_RGB] * len(rim), 1.2),
        Strips("plan/cracks", dark, [CRACK_RGB] * len(dark), 1.0),
        Strips("plan/rubble", corners, [shapes.PHASE_RGB[Phase(int(p))] for p in b.phase], 1.0),
    ]
