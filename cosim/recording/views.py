"""What stock viewers draw by themselves: structure, sheet and blocks as scenes (Foxglove) and points (rerun).

They are made now and then, from what the packed pictures hold in every recorded frame (`cosim.recording.pictures`).
Coordinates and colours are rounded so that they compress. Each function gives one serialised message.
"""

from __future__ import annotations

import numpy as np

from cosim.observer import RunInfo
from cosim.recording import scenes, shapes
from coupling.interface import Array, BlockTable, Frame, Phase, SheetView

POINTS_ON_STRUCTURE, POINTS_ON_BLOCK = 3, 3  #: along an edge, on one thickness of the ice
FINE = 256.0  #: coordinates are multiples of a power of two not above this part of the thickness
FINE_POINTS = 64.0  #: the same of points along edges, which are for the eye alone
SHADES = 32.0  #: steps of each colour
BAND = 4  #: rows of cells in one list of triangles


def structure_place(_info: RunInfo) -> bytes:
    """The structure's place in the world."""
    return scenes.transform(0, "structure")


def structure_scene(info: RunInfo) -> bytes:
    """The structure's surface."""
    points, faces = info.structure_mesh
    return scenes.scene(0, "structure", [scenes.triangle_list(points, faces, np.array(shapes.STRUCTURE_RGB, float))])


def structure_points(info: RunInfo) -> bytes:
    """Points along the edges of the structure's surface, for a viewer that draws points only."""
    points, faces = info.structure_mesh
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    sampled = shapes.along_edges(points, edges, info.thickness / POINTS_ON_STRUCTURE)[0]
    sampled = coarse(sampled, info.thickness, FINE_POINTS)
    return scenes.points(0, sampled, np.tile(np.array(shapes.STRUCTURE_RGB, float), (len(sampled), 1)))


def ice_nodes(info: RunInfo, frame: Frame) -> bytes:
    """Nodes that are still part of the lattice."""
    return nodes(frame.t_ns, frame.sheet, info.thickness)


def ice_sheet(info: RunInfo, frame: Frame) -> bytes:
    """Intact cells as a solid."""
    return sheet_solid(frame.t_ns, frame.sheet, info.thickness)


def rubble_scene(info: RunInfo, frame: Frame) -> bytes:
    """Blocks as prisms."""
    return prisms(frame.t_ns, frame.blocks, info.thickness)


def rubble_outline(info: RunInfo, frame: Frame) -> bytes:
    """Points along the edges of the blocks, dense enough to be seen as blocks by a viewer that draws points only."""
    return outline(frame.t_ns, frame.blocks, info.thickness)


def nodes(t_ns: int, sheet: SheetView, thickness: float) -> bytes:
    """Point cloud of the nodes that are still part of the lattice; ``node`` is their number."""
    kept = np.flatnonzero(sheet.present)
    data = np.empty(len(kept), scenes.NODE)
    rgb = shaded(shapes.ice_colour(sheet.damage[kept], sheet.utilisation[kept]))
    scenes.fill(data, coarse(sheet.position[kept], thickness), rgb)
    data["damage"], data["utilisation"] = (coarse(v[kept], 1.0) for v in (sheet.damage, sheet.utilisation))
    data["node"] = kept
    return scenes.cloud(t_ns, data)


def sheet_solid(t_ns: int, sheet: SheetView, thickness: float) -> bytes:
    """Scene of the intact cells as a solid of this thickness [m], in bands of rows.

    Each band numbers its own points, so that the triangles of all whole bands are the same bytes: in one list their
    numbers, none of which comes twice, were two thirds of what a picture of a large sheet takes.
    """
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    vertices, faces, node = shapes.solid_sheet(sheet.position, quads, thickness)
    vertices = coarse(vertices, thickness)
    rgb = shaded(shapes.ice_colour(sheet.damage, sheet.utilisation)[node])
    band = node[faces].min(axis=1, initial=len(sheet.damage)) // sheet.shape[1] // BAND
    lists = []
    for number in np.unique(band):
        used, compact = np.unique(faces[band == number], return_inverse=True)
        lists.append(scenes.triangle_list(vertices[used], compact.reshape(-1, 3), rgb[used]))
    return scenes.scene(t_ns, "sheet", lists)


def prisms(t_ns: int, blocks: BlockTable, thickness: float) -> bytes:
    """Scene of the blocks, one list of triangles for each phase."""
    points, faces, owner = shapes.prisms(blocks)
    lists = []
    for phase in (Phase.ROTATING, Phase.SLIDING):
        used, compact = np.unique(faces[blocks.phase[owner] == phase], return_inverse=True)
        colour = np.array(shapes.PHASE_RGB[phase], float)
        lists.append(scenes.triangle_list(coarse(points[used], thickness), compact.reshape(-1, 3), colour))
    return scenes.scene(t_ns, "rubble", lists)


def outline(t_ns: int, blocks: BlockTable, thickness: float) -> bytes:
    """Point cloud along the edges of the blocks."""
    edges, block = shapes.prism_edges(blocks)
    points, edge = shapes.along_edges(shapes.prisms(blocks)[0], edges, thickness / POINTS_ON_BLOCK)
    colour = np.array([shapes.PHASE_RGB[p] for p in Phase], float)
    return scenes.points(t_ns, coarse(points, thickness, FINE_POINTS), colour[blocks.phase[block[edge]]])


def shaded(rgb: Array) -> Array:
    """Colours 0-255 in `SHADES` steps, each a binary fraction of 1."""
    step = 256.0 / SHADES
    return np.asarray(step * np.rint(rgb / step) * (255.0 / 256.0))


def coarse(values: Array, size: float, fine: float = FINE) -> Array:
    """Multiples of the largest power of two that is not above ``size`` / ``fine``."""
    unit = 2.0 ** np.floor(np.log2(size / fine))
    return np.asarray(np.rint(values / unit) * unit)
