"""Pictures as arrays: the sheet as a solid mesh, blocks as prisms, edges as points, colours. Pure functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from coupling.interface import Array, BoolArray, IntArray, Phase

#: one colour per phase, in pictures, curves, reports and the legend (Okabe and Ito 2008)
PHASE_RGB = {Phase.BREAKING: (0, 114, 178), Phase.ROTATING: (230, 159, 0), Phase.SLIDING: (0, 158, 115)}
STRUCTURE_RGB = (201, 178, 122)
CRACKED_RGB = (20, 32, 44)
#: of the utilisation from 0 to 1, at even distances
UTILISATION_RGB = ((238, 245, 250), (251, 217, 165), (240, 148, 60), (179, 32, 44), (77, 10, 28))


def ice_colour(damage: Array, utilisation: Array) -> Array:
    """RGB 0-255 of sheet nodes: pale ice, orange, dark red as utilisation goes to 1; cracked ice is near to black."""
    u, stops = np.clip(np.nan_to_num(utilisation), 0, 1), np.linspace(0.0, 1.0, len(UTILISATION_RGB))
    rgb = np.stack([np.interp(u, stops, colour) for colour in zip(*UTILISATION_RGB, strict=True)], axis=1)
    dark = np.clip(damage, 0, 1)[:, None]
    return rgb * (1 - dark) + np.array(CRACKED_RGB) * dark


def cell_quads(intact: BoolArray, cell_shape: tuple[int, int]) -> IntArray:
    """(k, 4) node numbers of the intact cells, counter-clockwise seen from above."""
    i, j = np.nonzero(intact.reshape(cell_shape))
    n = cell_shape[1] + 1
    a = i * n + j
    # rows count along x, columns along y; which of the two runs backwards is left to `upward`
    return np.stack([a, a + n, a + n + 1, a + 1], axis=1)


def upward(quads: IntArray, position: Array) -> IntArray:
    """The same quads, turned so that their normals point up."""
    if not len(quads):
        return quads
    p = position[quads[0], :2]
    area = np.sum(p[:, 0] * np.roll(p[:, 1], -1) - np.roll(p[:, 0], -1) * p[:, 1])
    return quads if area > 0 else quads[:, ::-1]


def triangles(quads: IntArray) -> IntArray:
    """(2 k, 3) triangles of quads: the first halves of all, then the second."""
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def rim(quads: IntArray) -> IntArray:
    """(e, 2) directed edges that belong to one intact cell only: the outline of the sheet and of its cracks."""
    edges = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    key = np.sort(edges, axis=1)
    _, first, count = np.unique(key, axis=0, return_index=True, return_counts=True)
    return np.asarray(edges[np.sort(first[count == 1])])


def solid_sheet(position: Array, quads: IntArray, thickness: float) -> tuple[Array, IntArray, IntArray]:
    """Vertices, triangles and the node of every vertex: top, underside and the side faces of a sheet."""
    n, half = len(position), np.array([0, 0, thickness / 2])
    edge = rim(quads)
    a, b = edge[:, 0], edge[:, 1]
    side_node = np.stack([a, b, b, a], axis=1).ravel()
    side = position[side_node] + np.tile([-half, -half, half, half], (len(edge), 1))
    vertices = np.concatenate([position + half, position - half, side])
    face = triangles(quads)
    wall = 2 * n + np.arange(4 * len(edge)).reshape(-1, 4)
    all_triangles = np.concatenate([face, face[:, ::-1] + n, triangles(wall)])
    return vertices, all_triangles, np.concatenate([np.arange(n), np.arange(n), side_node])


class Bodies(Protocol):
    """What of blocks makes their shape; see `coupling.interface.BlockTable`."""

    @property
    def count(self) -> int:
        """Number of blocks."""
        ...

    @property
    def width(self) -> Array:
        """Extents along y [m]."""
        ...

    @property
    def position(self) -> Array:
        """Centres (n, 3) [m]."""
        ...

    @property
    def outline(self) -> Array:
        """Corners (v, 2) in x and z [m]."""
        ...

    @property
    def offset(self) -> IntArray:
        """(n + 1,): where the corners of each begin."""
        ...


def prisms(blocks: Bodies) -> tuple[Array, IntArray, IntArray]:
    """Points, triangles and the block of every triangle: convex outlines in x-z, extruded by the block's width."""
    count = np.diff(blocks.offset)
    owner = np.repeat(np.arange(blocks.count), count)
    near = blocks.offset[:-1][owner] + np.arange(len(owner))  # a block's corners, first all on one side
    points = np.empty((2 * len(owner), 3))
    for place, side in ((near, -0.5), (near + count[owner], 0.5)):
        points[place] = np.column_stack(
            (blocks.outline[:, 0], (blocks.position[:, 1] + side * blocks.width)[owner], blocks.outline[:, 1])
        )
    faces, of = _repeated(blocks, prism_faces, 4 * count - 4)
    return points, faces, of


def _repeated(blocks: Bodies, shape: Callable[[int], IntArray], rows: IntArray) -> tuple[IntArray, IntArray]:
    """A pattern of point numbers for every block, ``shape`` (rows, m) of its corners, and the block of each row."""
    count, first = np.diff(blocks.offset), np.concatenate(([0], np.cumsum(rows)))
    owner = np.repeat(np.arange(blocks.count), rows)
    width = shape(3).shape[1]
    out = np.empty((len(owner), width), np.int64)
    for k in np.unique(count):
        of = np.flatnonzero(count == k)
        pattern = shape(int(k))
        place = first[of][:, None] + np.arange(len(pattern))
        out[place] = pattern + 2 * blocks.offset[of][:, None, None]
    return out, owner


def prism_faces(k: int) -> IntArray:
    """Triangles of a prism over a convex polygon of ``k`` corners, counter-clockwise in x-z: normals point out."""
    fan = np.stack([np.zeros(k - 2, int), np.arange(1, k - 1), np.arange(2, k)], axis=1)
    a = np.arange(k)
    b = (a + 1) % k
    wall = np.concatenate([np.stack([a, a + k, b], axis=1), np.stack([b, a + k, b + k], axis=1)])
    return np.concatenate([fan, fan[:, ::-1] + k, wall])


def flat_shaded(points: Array, faces: IntArray) -> tuple[Array, Array]:
    """Vertices (3 per triangle, not shared) and their face normals."""
    corner = points[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    return corner.reshape(-1, 3), np.repeat(normal, 3, axis=0)


def along_edges(points: Array, edges: IntArray, spacing: float) -> tuple[Array, IntArray]:
    """Points at most ``spacing`` apart along edges, and the edge of each."""
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    count = np.maximum(np.ceil(np.linalg.norm(b - a, axis=1) / spacing), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(edges)), count)
    step = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    along = (step / np.repeat(count, count))[:, None]
    return a[owner] * (1 - along) + b[owner] * along, owner


def prism_edges(blocks: Bodies) -> tuple[IntArray, IntArray]:
    """Edges of all prisms, as numbers of the points of `prisms`, and the block of each edge."""
    return _repeated(blocks, _edges, 3 * np.diff(blocks.offset))


def _edges(k: int) -> IntArray:
    """Edges of a prism over ``k`` corners: both rims, then from one to the other."""
    a = np.arange(k)
    ring = np.stack([a, (a + 1) % k], axis=1)
    return np.concatenate([ring, ring + k, np.stack([a, a + k], axis=1)])
