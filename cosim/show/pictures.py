"""Recorded pictures as meshes: what a 3-D viewer draws of every recorded frame. Knows neither file nor viewer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cosim.recording import shapes
from cosim.recording.pictures import Picture
from cosim.show.ice.scene import Scene
from coupling.interface import Array, IntArray, Phase, SheetView

TOWER_RGB, WATER_RGBA = (240, 240, 236), (70, 130, 170, 90)
SHALLOW = 0.3  #: damage as which a cell is coloured that has begun to crack
DRAWN = (Phase.ROTATING, Phase.SLIDING)  #: phases of blocks


@dataclass(frozen=True)
class Mesh:
    """Triangles with normals; one colour or one per vertex."""

    name: str  #: structure, sheet, rubble/rotating, rubble/sliding
    t_ns: int
    vertices: Array  #: (v, 3) [m]
    faces: IntArray  #: (f, 3)
    normals: Array  #: (v, 3)
    rgb: Array  #: (3,) or (v, 3), 0-255; (4,) lets see through


def meshes(picture: Picture, thickness: float) -> Iterator[Mesh]:
    """The sheet, then the blocks by phase."""
    yield sheet_mesh(picture, thickness)
    points, faces, owner = shapes.prisms(picture.blocks)
    for phase in DRAWN:
        used, compact = np.unique(faces[picture.blocks.phase[owner] == phase], return_inverse=True)
        name = f"rubble/{phase.name.lower()}"
        yield flat_mesh(name, picture.t_ns, points[used], compact.reshape(-1, 3), shapes.PHASE_RGB[phase])


def still_meshes(structure: tuple[Array, IntArray], scene: Scene) -> Iterator[Mesh]:
    """The structure, closed, with a tower that is drawn and not modelled, and the surface of the water."""
    points, faces = structure
    yield flat_mesh("structure", 0, points, faces, shapes.STRUCTURE_RGB)
    if (tower := scene.tower()) is not None:
        radius, low, high = tower
        top = points[points[:, 2] > low - 1e-6 * max(1.0, abs(low))]
        around = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
        if len(top):
            lid = float(np.hypot(top[:, 0], top[:, 1]).max())
            yield _disc("structure/lid", lid, low, shapes.STRUCTURE_RGB)
        ring = radius * np.column_stack((np.cos(around), np.sin(around), np.zeros(48)))
        body = np.concatenate([ring + np.array((0.0, 0.0, z)) for z in (low, high)])
        k, following = np.arange(48), (np.arange(48) + 1) % 48
        side = np.concatenate(
            (np.column_stack((k, following, following + 48)), np.column_stack((k, following + 48, k + 48)))
        )
        yield flat_mesh("structure/tower", 0, body, side, TOWER_RGB)
        yield _disc("structure/tower_top", radius, high, TOWER_RGB)
    far = 1.5 * scene.width
    corners = np.array([(-far, -far, 0.0), (far, -far, 0.0), (far, far, 0.0), (-far, far, 0.0)])
    up = np.tile([0.0, 0.0, 1.0], (4, 1))
    yield Mesh("water", 0, corners, np.array([(0, 1, 2), (0, 2, 3)]), up, np.array(WATER_RGBA, float))


def _disc(name: str, radius: float, z: float, rgb: tuple[int, int, int]) -> Mesh:
    """A round lid that faces up."""
    around = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rim = np.column_stack((radius * np.cos(around), radius * np.sin(around), np.full(48, z)))
    k = np.arange(48)
    faces = np.column_stack((k, (k + 1) % 48, np.full(48, 48)))
    return flat_mesh(name, 0, np.concatenate((rim, [(0.0, 0.0, z)])), faces, rgb)


def quads_of(sheet: SheetView) -> IntArray:
    """(k, 4) nodes of the intact cells, seen from above counter-clockwise."""
    return shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)


def sheet_mesh(picture: Picture, thickness: float) -> Mesh:
    """The intact cells as a solid."""
    sheet = picture.sheet
    n = len(sheet.position)
    vertices, faces, node = shapes.solid_sheet(sheet.position, quads_of(sheet), thickness)
    rgb = shapes.ice_colour(cracked_at_nodes(picture), sheet.utilisation)[node]
    return Mesh("sheet", picture.t_ns, vertices, faces, _sheet_normals(vertices, n), _shade(rgb, n))


def cracked_at_nodes(picture: Picture) -> Array:
    """Damage of the nodes (n,), not below `SHALLOW` of the share of their cells that have begun to crack."""
    sheet = picture.sheet
    begun, cells = np.zeros(len(sheet.position)), np.zeros(len(sheet.position))
    every = shapes.cell_quads(np.ones(len(sheet.intact), bool), sheet.cell_shape)
    np.add.at(cells, every, 1.0)
    np.add.at(begun, every, picture.begun[:, None].astype(float))
    return np.asarray(np.maximum(sheet.damage, SHALLOW * begun / np.maximum(cells, 1.0)))


def flat_mesh(name: str, t_ns: int, points: Array, faces: IntArray, rgb: tuple[int, int, int]) -> Mesh:
    """Triangles each with the normal of its own."""
    vertices, normals = shapes.flat_shaded(points, faces)
    return Mesh(name, t_ns, vertices, np.arange(len(vertices)).reshape(-1, 3), normals, np.array(rgb, float))


def _sheet_normals(vertices: Array, n: int) -> Array:
    """Up on the top, down on the underside, level on the side faces (four vertices each)."""
    normals = np.zeros_like(vertices)
    normals[:n, 2], normals[n : 2 * n, 2] = 1, -1
    corner = vertices[2 * n :].reshape(-1, 4, 3)
    along = corner[:, 1] - corner[:, 0]
    level = np.stack([along[:, 1], -along[:, 0], np.zeros(len(along))], axis=1)
    level /= np.maximum(np.linalg.norm(level, axis=1, keepdims=True), 1e-12)
    normals[2 * n :] = np.repeat(level, 4, axis=0)
    return normals


def _shade(rgb: Array, n: int) -> Array:
    """Side faces a little darker, so that cracks and the edge are seen."""
    out = rgb.copy()
    out[2 * n :] *= 0.7
    return out
