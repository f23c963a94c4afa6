"""Recorded pictures as meshes: what a 3-D viewer draws of every recorded frame. Knows neither file nor viewer."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from cosim.recording import scenes, shapes
from cosim.recording.decoding import Stored
from coupling.interface import Array, IntArray, Phase

TOPICS = ("/structure/scene", "/ice/nodes", "/ice/sheet", "/rubble/scene")


@dataclass(frozen=True)
class Mesh:
    """Triangles with normals; one colour or one per vertex."""

    name: str  #: structure, sheet, rubble/rotating, rubble/sliding
    t_ns: int
    vertices: Array  #: (v, 3) [m]
    faces: IntArray  #: (f, 3)
    normals: Array  #: (v, 3)
    rgb: Array  #: (3,) or (v, 3), 0-255


def meshes(stored: Iterable[Stored], thickness: float) -> Iterator[Mesh]:
    """The meshes of a recording, in the order of time."""
    quads = np.empty((0, 4), np.int64)
    nodes = np.empty(0, scenes.NODE)
    for topic, t_ns, data in stored:
        if topic == "/ice/nodes":
            nodes = node_records(data)
        elif topic == "/ice/sheet":
            quads = sheet_quads(data)
        elif topic == "/structure/scene":
            points, faces = triangle_lists(data)[0]
            yield _flat("structure", t_ns, points, faces, shapes.STRUCTURE_RGB)
        elif topic == "/rubble/scene":  # the last picture of a frame
            yield _sheet(t_ns, nodes, quads, thickness)
            for phase, item in zip((Phase.ROTATING, Phase.SLIDING), triangle_lists(data), strict=True):
                yield _flat(f"rubble/{phase.name.lower()}", t_ns, *item, shapes.PHASE_RGB[phase])


def node_records(data: bytes) -> Any:
    """Records of `cosim.recording.scenes.NODE` in a message of ``/ice/nodes``."""
    return np.frombuffer(PointCloud.FromString(data).data, scenes.NODE)


def triangle_lists(data: bytes) -> list[tuple[Array, IntArray]]:
    """Points and triangles of every list of a scene."""
    entity = SceneUpdate.FromString(data).entities[0]
    return [
        (
            np.array([(p.x, p.y, p.z) for p in item.points]).reshape(-1, 3),
            np.array(item.indices, np.int64).reshape(-1, 3),
        )
        for item in entity.triangles
    ]


def sheet_quads(data: bytes) -> IntArray:
    """The intact cells of a sheet's mesh: its first triangles are the top faces, (a, b, c) of all, then (a, c, d)."""
    faces = np.array(SceneUpdate.FromString(data).entities[0].triangles[0].indices, np.int64).reshape(-1, 3)
    k = _count_of_cells(faces)
    return np.concatenate([faces[:k], faces[k : 2 * k, 2:]], axis=1)


def _count_of_cells(faces: IntArray) -> int:
    """Number of top faces of the first half: the second half repeats their first corners."""
    if not len(faces):
        return 0
    again = np.flatnonzero(faces[1:, 0] == faces[0, 0]) + 1
    return int(again[0])


def _sheet(t_ns: int, nodes: Any, quads: IntArray, thickness: float) -> Mesh:
    """The sheet where its nodes are now, with their colours; nodes that have left the lattice stay unused."""
    n = int(max(quads.max(initial=0), nodes["node"].max(initial=0))) + 1
    position, rgb = np.zeros((n, 3)), np.zeros((n, 3))
    position[nodes["node"]] = np.stack([nodes["x"], nodes["y"], nodes["z"]], axis=1)
    rgb[nodes["node"]] = np.stack([nodes["red"], nodes["green"], nodes["blue"]], axis=1)
    vertices, faces, node = shapes.solid_sheet(position, quads, thickness)
    return Mesh("sheet", t_ns, vertices, faces, _sheet_normals(vertices, n), _shade(rgb[node], n))


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


def _flat(name: str, t_ns: int, points: Array, faces: IntArray, rgb: tuple[int, int, int]) -> Mesh:
    vertices, normals = shapes.flat_shaded(points, faces)
    return Mesh(name, t_ns, vertices, np.arange(len(vertices)).reshape(-1, 3), normals, np.array(rgb, float))
