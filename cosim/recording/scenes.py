"""Arrays as ``foxglove.PointCloud`` and ``foxglove.SceneUpdate`` bytes, all in the frame ``world``.

Nested messages are always set, also when they are all zero: rerun turns an unset one into a null.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.TriangleListPrimitive_pb2 import TriangleListPrimitive

from cosim.recording import wire
from cosim.recording.messages import stamp
from coupling.interface import Array, IntArray

WORLD = "world"
POINT = np.dtype(
    [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("red", "u1"), ("green", "u1"), ("blue", "u1"), ("alpha", "u1")]
)
NODE = np.dtype([*POINT.descr, ("damage", "<f4"), ("utilisation", "<f4"), ("node", "<u4")])
_KINDS = {"f4": PackedElementField.FLOAT32, "u1": PackedElementField.UINT8, "u4": PackedElementField.UINT32}


def as_bytes(message: Any) -> bytes:
    """Serialised, the same bytes for the same content."""
    data: bytes = message.SerializeToString(deterministic=True)
    return data


def fill(records: Any, xyz: Array, rgb: Array) -> Any:
    """Write positions and opaque colours into structured records."""
    for k, name in enumerate(("x", "y", "z")):
        records[name] = xyz[:, k]
    for k, name in enumerate(("red", "green", "blue")):
        records[name] = np.rint(rgb[:, k])
    records["alpha"] = 255
    return records


def points(t_ns: int, xyz: Array, rgb: Array) -> bytes:
    """Coloured points."""
    return cloud(t_ns, fill(np.empty(len(xyz), POINT), xyz, rgb))


def cloud(t_ns: int, records: Any) -> bytes:
    """A point cloud whose fields are those of the structured array."""
    message = PointCloud(frame_id=WORLD, point_stride=records.dtype.itemsize, data=records.tobytes())
    stamp(message.timestamp, t_ns)
    _identity(message.pose)
    for name in records.dtype.names:
        kind, offset = records.dtype.fields[name][:2]
        message.fields.add(name=name, offset=offset, type=_KINDS[kind.str[1:]])
    return as_bytes(message)


def triangle_list(xyz: Array, faces: IntArray, rgb: Array) -> bytes:
    """A ``TriangleListPrimitive``; ``rgb`` (0-255) is one colour or one per point."""
    message = TriangleListPrimitive()
    _identity(message.pose)
    message.color.SetInParent()
    rgba = np.ones((len(rgb) if rgb.ndim == 2 else 1, 4))
    rgba[:, :3] = rgb / 255
    for name, value in zip("rgba", rgba[0] if len(rgba) else (0, 0, 0, 1), strict=True):
        setattr(message.color, name, float(value))
    colors = wire.colors(4, rgba) if rgb.ndim == 2 else b""
    return as_bytes(message) + wire.points(2, xyz) + colors + wire.fixed32(5, faces.ravel())


def scene(t_ns: int, name: str, triangle_lists: list[bytes]) -> bytes:
    """A ``SceneUpdate`` with one entity, which replaces the last one of that name."""
    entity = SceneEntity(frame_id=WORLD, id=name)
    stamp(entity.timestamp, t_ns)
    entity.lifetime.SetInParent()
    body = as_bytes(entity) + b"".join(wire.nested(12, item) for item in triangle_lists)
    return wire.nested(2, body)


def triangles_of(data: bytes) -> tuple[Array, IntArray]:
    """Points and triangles of the first list of a scene."""
    item = SceneUpdate.FromString(data).entities[0].triangles[0]
    return (
        np.array([(p.x, p.y, p.z) for p in item.points]).reshape(-1, 3),
        np.array(item.indices, np.int64).reshape(-1, 3),
    )


def transform(t_ns: int, child: str) -> bytes:
    """World -> child, at rest at the origin. Foxglove shows nothing without a transform that names ``world``."""
    message = FrameTransforms()
    item = message.transforms.add(parent_frame_id=WORLD, child_frame_id=child)
    stamp(item.timestamp, t_ns)
    item.translation.SetInParent()
    item.rotation.w = 1.0
    return as_bytes(message)


def _identity(pose: Any) -> None:
    pose.position.SetInParent()
    pose.orientation.w = 1.0
