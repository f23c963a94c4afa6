"""What a recording holds: the topics, their schemas, and how a `Frame` becomes messages.

Stock viewers open the recording without a converter: rerun draws the point clouds and the log, Foxglove draws the
scenes as well and plots `cosim.Load`. Every message is in the frame ``world``; stamps are simulated time.

| topic | schema | when |
|---|---|---|
| /structure/scene, /structure/points, /tf | SceneUpdate, PointCloud, FrameTransforms | once |
| /load/structure, /load/budget, /ledger | cosim.Load, cosim.Ledger, cosim.Ledger | every window |
| /events, /log | cosim.Event, foxglove.Log | when it happens |
| /ice/nodes, /rubble/scene, /rubble/outline | PointCloud, SceneUpdate, PointCloud | every recorded frame |
| /ice/sheet | SceneUpdate | recorded frames in which a cell has failed, and every few others |
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from cosim.recording import messages, scenes, shapes
from coupling.interface import Array, BlockTable, Event, Frame, IntArray, Phase, SheetView

SCHEMAS: dict[str, Any] = {
    "/structure/scene": SceneUpdate,
    "/structure/points": PointCloud,
    "/tf": FrameTransforms,
    "/load/structure": messages.Load,
    "/ledger": messages.Ledger,
    "/events": messages.Event,
    "/log": Log,
    "/ice/nodes": PointCloud,
    "/ice/sheet": SceneUpdate,
    "/rubble/scene": SceneUpdate,
    "/rubble/outline": PointCloud,
    "/load/budget": messages.Ledger,
}
Packed = tuple[str, bytes]  #: topic and serialised message


def structure(points: Array, faces: IntArray, spacing: float) -> Iterator[Packed]:
    """The structure and its place in the world, once."""
    colour = np.array(shapes.STRUCTURE_RGB, float)
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    sampled = shapes.along_edges(points, edges, spacing)[0]
    yield "/tf", scenes.transform(0, "structure")
    yield "/structure/scene", scenes.scene(0, "structure", [scenes.triangle_list(points, faces, colour)])
    yield "/structure/points", scenes.points(0, sampled, np.tile(colour, (len(sampled), 1)))


def load(t_ns: int, by_phase: Array) -> Packed:
    """`cosim.Load`: totals and the three phases [N]."""
    values = np.concatenate([by_phase.sum(axis=0), by_phase.ravel()])
    message = messages.Load(**dict(zip(messages.LOAD_FIELDS, values.tolist(), strict=True)))
    messages.stamp(message.stamp, t_ns)
    return "/load/structure", scenes.as_bytes(message)


def ledger(t_ns: int, terms: dict[str, float], topic: str = "/ledger") -> Packed:
    """`cosim.Ledger`: named balances, or on ``/load/budget`` what carries the load [N]."""
    message = messages.Ledger(name=list(terms), value=[float(v) for v in terms.values()])
    messages.stamp(message.stamp, t_ns)
    return topic, scenes.as_bytes(message)


def event(item: Event) -> Iterator[Packed]:
    """An event as data and as a line of the log."""
    numbers = dict(zip(("fx", "fy", "fz", "x", "y", "z"), (*item.force, *item.position), strict=True))
    numbers |= {"length": item.length, "area": item.area}
    message = messages.Event(
        kind=item.kind, cells=int(item.cells), text=item.text, **{name: float(value) for name, value in numbers.items()}
    )
    messages.stamp(message.stamp, item.t_ns)
    yield "/events", scenes.as_bytes(message)
    yield log(item.t_ns, f"{item.kind}: {item.text}", item.kind)


def log(t_ns: int, text: str, name: str = "cosim") -> Packed:
    """One line for people."""
    message = Log(level=Log.INFO, message=text, name=name)
    messages.stamp(message.timestamp, t_ns)
    return "/log", scenes.as_bytes(message)


def frame(item: Frame, thickness: float, with_sheet: bool) -> Iterator[Packed]:
    """The pictures of a frame: nodes and blocks, and the sheet's mesh if asked for."""
    yield "/ice/nodes", nodes(item.t_ns, item.sheet)
    if with_sheet:
        yield "/ice/sheet", sheet_scene(item.t_ns, item.sheet, thickness)
    yield "/rubble/scene", rubble_scene(item.t_ns, item.blocks)
    yield "/rubble/outline", rubble_outline(item.t_ns, item.blocks, thickness / 5)


def nodes(t_ns: int, sheet: SheetView) -> bytes:
    """Nodes that are still part of the lattice; ``node`` is their number."""
    kept = np.flatnonzero(sheet.present)
    data = np.empty(len(kept), scenes.NODE)
    scenes.fill(data, sheet.position[kept], shapes.ice_colour(sheet.damage[kept], sheet.utilisation[kept]))
    data["damage"], data["utilisation"] = sheet.damage[kept], sheet.utilisation[kept]
    data["present"], data["node"] = 1, kept
    return scenes.cloud(t_ns, data)


def sheet_scene(t_ns: int, sheet: SheetView, thickness: float) -> bytes:
    """Intact cells as a solid."""
    quads = shapes.upward(shapes.cell_quads(sheet.intact, sheet.cell_shape), sheet.position)
    vertices, faces, node = shapes.solid_sheet(sheet.position, quads, thickness)
    rgb = shapes.ice_colour(sheet.damage, sheet.utilisation)[node]
    return scenes.scene(t_ns, "sheet", [scenes.triangle_list(vertices, faces, rgb)])


def rubble_scene(t_ns: int, blocks: BlockTable) -> bytes:
    """Blocks as prisms, one list of triangles for each phase."""
    points, faces, owner = shapes.prisms(blocks)
    lists = []
    for phase in (Phase.ROTATING, Phase.SLIDING):
        used, compact = np.unique(faces[blocks.phase[owner] == phase], return_inverse=True)
        colour = np.array(shapes.PHASE_RGB[phase], float)
        lists.append(scenes.triangle_list(points[used], compact.reshape(-1, 3), colour))
    return scenes.scene(t_ns, "rubble", lists)


def rubble_outline(t_ns: int, blocks: BlockTable, spacing: float) -> bytes:
    """Points along the edges of the blocks, dense enough to be seen as blocks by a viewer that draws points only."""
    edges, block = shapes.prism_edges(blocks)
    points, edge = shapes.along_edges(shapes.prisms(blocks)[0], edges, spacing)
    colour = np.array([shapes.PHASE_RGB[p] for p in Phase], float)
    return scenes.points(t_ns, points, colour[blocks.phase[block[edge]]])
