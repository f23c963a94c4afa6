"""What a recording holds: one line for each channel, with its topic, its schema and what it takes from a run.

Stock viewers open the recording without a converter: rerun draws the point clouds and the log, Foxglove draws the
scenes as well and plots `cosim.Load`. Every message is in the frame ``world``; stamps are simulated time.

A channel from outside is one more line, before the run: ``CHANNELS["/mine"] = Channel(schema, When.WINDOW, take)``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from cosim.recording import messages, numbers, views


class When(Enum):
    """When a channel is asked for a message, and for what; channels that are due together write in their order."""

    WORLD = auto()  #: once, before all others: places that others name; ``take(info)``
    START = auto()  #: once; ``take(info)``
    WINDOW = auto()  #: every window; ``take(info, frame)``
    EVENT = auto()  #: every event; ``take(info, event)``
    PICTURE = auto()  #: every recorded frame; ``take(info, frame)``
    MESH = auto()  #: recorded frames in which a cell has failed, and every few others; ``take(info, frame)``


@dataclass(frozen=True)
class Channel:
    """One topic of a recording."""

    schema: Any  #: class of its messages (protobuf)
    when: When
    take: Callable[..., bytes | None]  #: gives the serialised message; None: nothing to say


#: by topic; numbers of channels in the file follow this order and never depend on the run
CHANNELS: dict[str, Channel] = {
    "/structure/scene": Channel(SceneUpdate, When.START, views.structure_scene),
    "/structure/points": Channel(PointCloud, When.START, views.structure_points),
    "/tf": Channel(FrameTransforms, When.WORLD, views.structure_place),
    "/load/structure": Channel(messages.Load, When.WINDOW, numbers.load),
    "/ledger": Channel(messages.Ledger, When.WINDOW, numbers.ledger),
    "/events": Channel(messages.Event, When.EVENT, numbers.event),
    "/log": Channel(Log, When.EVENT, numbers.event_line),
    "/ice/nodes": Channel(PointCloud, When.PICTURE, views.ice_nodes),
    "/ice/sheet": Channel(SceneUpdate, When.MESH, views.ice_sheet),
    "/rubble/scene": Channel(SceneUpdate, When.PICTURE, views.rubble_scene),
    "/rubble/outline": Channel(PointCloud, When.PICTURE, views.rubble_outline),
    "/load/contact": Channel(messages.Contact, When.PICTURE, numbers.contact),
    "/load/budget": Channel(messages.Ledger, When.WINDOW, numbers.budget),
}
